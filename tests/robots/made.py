"""Robots written by the tests."""

LIMIT = '<limit lower="-1.5" upper="2.5" effort="1" velocity="1"/>'
_WEIGHT = (
    '<inertial><origin xyz="0.1 0 0"/><mass value="{mass}"/>'
    '<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>'
)


def joint(name, kind, parent, child, xyz="0 0 0", axis="0 0 1", rpy="0 0 0", extra=LIMIT):
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/>{extra}</joint>'
    )


def robot(*joints, links, mass=0.0):
    # A mesh that does not exist must not be looked for.
    mesh = '<visual><geometry><mesh filename="package://nowhere/absent.stl"/></geometry></visual>'
    inside = mesh + (_WEIGHT.format(mass=mass) if mass else "")
    body = "".join(f'<link name="{name}">{inside}</link>' for name in links.split())
    return f'<?xml version="1.0"?><robot name="made">{body}{"".join(joints)}</robot>'


def mimic(leader, multiplier=None, offset=None):
    parts = {"multiplier": multiplier, "offset": offset}
    given = "".join(f' {key}="{value}"' for key, value in parts.items() if value is not None)
    return f'{LIMIT}<mimic joint="{leader}"{given}/>'


FOUR = robot(
    joint("lift", "prismatic", "base", "l1", axis="0 0 1", xyz="0.1 0 0"),
    joint("spin", "continuous", "l1", "l2", axis="0 0 1", xyz="0 0 0.2", extra=""),
    joint("mount", "fixed", "l2", "l3", xyz="0.3 0 0"),
    joint("bend", "revolute", "l3", "l4", axis="0 1 0"),
    joint("hand", "fixed", "l4", "tip", xyz="0.4 0 0"),
    links="base l1 l2 l3 l4 tip",
)


def _arm(side, y):
    """Five joints, the middle one slides, and a hand."""
    return (
        joint(f"{side}_1", "revolute", "torso", f"{side}_a", f"0.05 {y} 0.3", rpy="0.1 0 0"),
        joint(f"{side}_2", "revolute", f"{side}_a", f"{side}_b", "0.1 0 0", "0 1 0"),
        joint(f"{side}_3", "prismatic", f"{side}_b", f"{side}_c", "0.3 0 0.02", "1 0 0"),
        joint(f"{side}_4", "continuous", f"{side}_c", f"{side}_d", "0.2 0 0", "0 -1 0", extra=""),
        joint(f"{side}_5", "revolute", f"{side}_d", f"{side}_e", "0.15 0 0", "0.6 0 0.8"),
        joint(f"{side}_grip", "fixed", f"{side}_e", f"{side}_hand", "0.1 0.02 0"),
    )


# A torso that lifts, with two arms and a head that pans and tilts.
TORSO = robot(
    joint("lift", "prismatic", "base", "torso", "0 0 0.4"),
    joint("pan", "revolute", "torso", "neck", "0.02 0 0.6"),
    joint("tilt", "revolute", "neck", "head", "0 0.03 0.1", "0 1 0", rpy="0 0 0.2"),
    joint("lens", "fixed", "head", "camera", "0.05 0.03 0.02", rpy="-1.57 0 -1.57"),
    *_arm("left", 0.25),
    *_arm("right", -0.25),
    links="base torso neck head camera left_a left_b left_c left_d left_e left_hand "
    "right_a right_b right_c right_d right_e right_hand",
    mass=1.5,
)


def palletiser(*, plain=False):
    """The hand stays level: two wrist joints follow, the second one follows the first."""
    first = {} if plain else {"extra": mimic("shoulder", -1.0, 0.3)}
    second = {} if plain else {"extra": mimic("level", 0.5)}
    return robot(
        joint("turn", "revolute", "base", "l1"),
        joint("shoulder", "revolute", "l1", "l2", "0 0 0.3", "0 1 0"),
        joint("level", "revolute", "l2", "l3", "0.4 0 0", "0 1 0", **first),
        joint("out", "prismatic", "l3", "l4", "0.1 0 0", "1 0 0", **second),
        links="base l1 l2 l3 l4",
        mass=2.0,
    )


def redundant(*, behind=""):
    """Eight joints, the first one slides; `behind` is more XML, such as a gripper."""
    axes = ("1 0 0", "0 0 1", "0 1 0", "0 0 1", "0 -1 0", "0 0 1", "0 1 0", "1 0 0")
    joints = [
        joint(f"j{i}", "revolute" if i else "prismatic", f"l{i}", f"l{i + 1}", "0 0.02 0.2", axis)
        for i, axis in enumerate(axes)
    ]
    text = robot(*joints, links=" ".join(f"l{i}" for i in range(9)))
    return text.replace("</robot>", behind + "</robot>")
