"""Robots that no test knows: written as URDF, with errors of any size, seen by any sensor."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from handeye.arrays import Array
from handeye.calibration.arm.chain import arm_chain
from handeye.calibration.arm.description import describe, target_rows
from handeye.calibration.arm.kernels import SerialArm, pose
from handeye.calibration.arm.sheet import ArmSheet, CurveTerms
from handeye.calibration.placement import Placement
from handeye.geometry import make_pose, wxyz_from_matrix
from handeye.observations import PointObservation, PointTarget
from handeye.robots.shipped import shipped_robots
from handeye.robots.urdf import UrdfArm

# What the truth may have: curves of few harmonics, gears once to twelve times a turn.
SHEET = ArmSheet(curves=CurveTerms(12, 1))
TURN_NOISE = 1e-3

Part = tuple[str, str, str, str, float, float]
"""Name, kind, place in the frame before, axis, lower and upper limit of a joint."""

_R = "revolute"
_SIX: list[Part] = [
    ("a1", _R, "0 0 0.4", "0 0 1", -2.9, 2.9),
    ("a2", _R, "0.05 0.1 0.1", "0 1 0", -2.0, 1.2),
    ("a3", _R, "0 0 0.55", "0 1 0", -1.0, 2.4),
    ("a4", _R, "0.25 0 0.03", "1 0 0", -2.9, 2.9),
    ("a5", _R, "0.3 0 0", "0 1 0", -2.0, 2.0),
    ("a6", _R, "0.08 0 0", "1 0 0", -2.9, 2.9),
]
_PARTS: dict[str, list[Part]] = {
    "six": _SIX,
    "seven": [
        ("j1", _R, "0 0 0.33", "0 0 1", -2.8, 2.8),
        ("j2", _R, "0 0 0", "0 1 0", -1.7, 1.7),
        ("j3", _R, "0 0 0.316", "0 0 1", -2.8, 2.8),
        ("j4", _R, "0.08 0 0", "0 -1 0", -3.0, -0.1),
        ("j5", _R, "-0.08 0 0.384", "0 0 1", -2.8, 2.8),
        ("j6", _R, "0 0 0", "0 -1 0", -0.1, 3.7),
        ("j7", _R, "0.088 0 0", "0 0 -1", -2.8, 2.8),
    ],
    "scara": [
        ("s1", _R, "0 0 0.3", "0 0 1", -2.2, 2.2),
        ("s2", _R, "0.35 0 0.05", "0 0 1", -2.4, 2.4),
        ("s3", "prismatic", "0.3 0 0", "0 0 -1", 0.0, 0.25),
        ("s4", _R, "0 0 -0.1", "0 0 -1", -3.0, 3.0),
    ],
    "gantry": [
        ("x", "prismatic", "0 0 1.2", "1 0 0", -0.8, 0.8),
        ("y", "prismatic", "0 0 0.1", "0 1 0", -0.5, 0.5),
        ("z", "prismatic", "0.1 0 0", "0 0 -1", 0.0, 0.6),
        ("w1", _R, "0 0 -0.3", "0 0 1", -2.9, 2.9),
        ("w2", _R, "0 0 -0.1", "0 1 0", -1.9, 1.9),
        ("w3", _R, "0 0 -0.1", "0 0 1", -2.9, 2.9),
    ],
    "rail": [("rail", "prismatic", "0 0 0.2", "0 1 0", -1.5, 1.5), *_SIX],
}
ROBOTS = (*_PARTS, "gripper", "ur5", "panda")


def urdf_of(robot: str, *, extra: bool = False) -> str:
    """The text of a robot; with `extra`, fixed links between, a gripper's mimic joints behind."""
    if robot in {"ur5", "panda"}:
        return shipped_robots()[robot].read_text(encoding="utf-8")
    fingers = robot == "gripper"
    parts = _PARTS["six" if fingers else robot]
    links, joints, last = ["base"], list[str](), "base"
    for name, kind, xyz, axis, low, high in parts:
        if extra:
            joints.append(_joint(f"{name}_mount", "fixed", last, f"{name}_plate", "0 0 0", ""))
            links.append(f"{name}_plate")
            last = f"{name}_plate"
        more = f'<axis xyz="{axis}"/><limit lower="{low}" upper="{high}" effort="1" velocity="1"/>'
        joints.append(_joint(name, kind, last, f"{name}_link", xyz, more))
        links.append(f"{name}_link")
        last = f"{name}_link"
    joints.append(_joint("flange_mount", "fixed", last, "tool0", "0.05 0 0", ""))
    links.append("tool0")
    if fingers:
        limit = '<limit lower="0" upper="0.04" effort="1" velocity="1"/>'
        for side, way, more in (
            ("left", "0 1 0", ""),
            ("right", "0 -1 0", "<mimic joint='left'/>"),
        ):
            joints.append(
                _joint(side, "prismatic", "tool0", f"{side}_finger", "0.1 0 0",
                       f'<axis xyz="{way}"/>{limit}{more}')
            )  # fmt: skip
            links.append(f"{side}_finger")
    body = "".join(_link(name) for name in links)
    return f'<?xml version="1.0"?><robot name="{robot}">{body}{"".join(joints)}</robot>'


def _joint(name: str, kind: str, parent: str, child: str, xyz: str, more: str) -> str:
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{xyz}"/>{more}</joint>'
    )


def _link(name: str) -> str:
    inertia = '<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/>'
    return f'<link name="{name}"><inertial><mass value="2"/>{inertia}</inertial></link>'


@dataclass(frozen=True, eq=False)
class Truth:
    """An arm as it really is, between a sensor and a marker.

    x (n,) its errors, nominally 0; `names` of the groups of them that belong together.
    """

    arm: UrdfArm
    kernel: SerialArm
    x: Array

    @classmethod
    def of(cls, arm: UrdfArm, size: float, rng: np.random.Generator) -> "Truth":
        """Errors of `size` times what `ArmSheet` expects; frames anywhere."""
        far = rng.uniform(0.8, 1.6) * arm.reach
        base = make_pose(Rotation.random(rng=rng).as_matrix(), rng.uniform(-1.0, 1.0, 3) * far)
        marker = make_pose(Rotation.random(rng=rng).as_matrix(), rng.uniform(-0.1, 0.1, 3))
        kernel = describe(
            arm, Placement(base, marker), SHEET.curves.table(arm.stages().slides),
            turn_std=TURN_NOISE, compliant=SHEET.compliance > 0.0,
        )  # fmt: skip
        x = size * rng.normal(size=len(SHEET.tolerances(kernel))) * SHEET.tolerances(kernel)
        x[:12] = 0.0
        return cls(arm, kernel, x)

    def places(self, part: str) -> tuple[int, ...]:
        """The unknowns of a part, by its words."""
        chain = arm_chain(self.kernel, self.arm.stage_names, SHEET)
        return next(group.places for group in chain.groups if group.words == part)

    def moved(self, part: str, by: Sequence[float]) -> "Truth":
        """The same arm with a part elsewhere."""
        x = self.x.copy()
        x[list(self.places(part))] += np.asarray(by)
        return replace(self, x=x)

    def seen(self, joints: Array) -> tuple[Array, Array]:
        """Positions (N, 3) and orientations (N, 4) of the marker at joints (N, n)."""
        rows = target_rows(self.kernel, self.arm, PointTarget(np.zeros((len(joints), 3)), joints))
        T = np.empty((len(joints), 3, 4))
        for row, out in zip(rows, T, strict=True):
            pose(self.kernel, self.x, row, out)
        return T[:, :, 3].copy(), wxyz_from_matrix(T[:, :, :3])


def joints_for(arm: UrdfArm, n: int, way: str, rng: np.random.Generator) -> Array:
    """Readings (n, m): at random, or of joints that swing, each in its own rhythm."""
    low, high = np.maximum(arm.lower, -2.5), np.minimum(arm.upper, 2.5)
    middle, half = 0.5 * (low + high), 0.4 * (high - low)
    if way == "random":
        return middle + half * rng.uniform(-1.0, 1.0, (n, len(low)))
    rates = rng.uniform(0.05, 0.3, len(low))
    phases = rng.uniform(0.0, 2.0 * np.pi, len(low))
    return middle + half * np.sin(np.outer(np.arange(n), rates) + phases)


def observed(
    truths: Sequence[Truth], joints: Array, noise: float, rng: np.random.Generator
) -> PointObservation:
    """Sightings, row i of truths[i], noise [m] in each component."""
    n = len(joints)
    position, wxyz = np.empty((n, 3)), np.empty((n, 4))
    numbers = np.array([id(truth) for truth in truths])
    for number, truth in {id(truth): truth for truth in truths}.items():
        which = numbers == number
        position[which], wxyz[which] = truth.seen(joints[which])
    turns = Rotation.from_rotvec(rng.normal(scale=TURN_NOISE, size=(n, 3)))
    wxyz = (turns * Rotation.from_quat(wxyz, scalar_first=True)).as_quat(scalar_first=True)
    return PointObservation(
        np.arange(float(n)), joints, position + rng.normal(scale=noise, size=(n, 3)), wxyz
    )
