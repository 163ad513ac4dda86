"""Which link the joints of a log bring to the marker."""

import pytest

from handeye.errors import InvalidInput
from handeye.robots.tip_of_joints import tip_of_joints


def urdf(*joints: tuple[str, str, str, str], mimic: str = "") -> str:
    links = dict.fromkeys(link for _, _, *ends in joints for link in ends)
    text = "".join(f'<link name="{link}"/>' for link in links)
    for name, kind, parent, child in joints:
        follows = '<mimic joint="a"/>' if name == mimic else ""
        text += (
            f'<joint name="{name}" type="{kind}"><parent link="{parent}"/>'
            f'<child link="{child}"/>{follows}</joint>'
        )
    return f'<robot name="r">{text}</robot>'


ARM = (("a", "revolute", "base", "one"), ("b", "continuous", "one", "two"))
TOOL = ("fixed", "fixed", "two", "hand")
FINGERS = (("left", "prismatic", "hand", "tip1"), ("right", "prismatic", "hand", "tip2"))


@pytest.mark.parametrize(
    ("joints", "tip"),
    [
        (["a", "b"], "two"),  # no finger was read: the arm ends before the fingers
        (["b", "a", "elsewhere"], "two"),
        (["a"], "one"),
        (["a", "b", "left"], "tip1"),
        (["a", "b", "left", "right"], "two"),  # fingers part here: the marker is on neither
        (["b"], None),  # nothing is moved by b alone
        ([], None),
    ],
)
def test_the_arm_ends_where_the_joints_of_the_log_do(joints, tip):
    assert tip_of_joints(urdf(*ARM, TOOL, *FINGERS), joints) == tip


def test_of_two_arms_neither_is_chosen():
    other = (("c", "revolute", "base", "three"), ("d", "revolute", "three", "four"))
    both = urdf(*ARM, *other)
    assert tip_of_joints(both, ["a", "b", "c", "d"]) is None
    assert tip_of_joints(both, ["c", "d"]) == "four"


def test_a_joint_that_follows_another_need_not_be_read():
    assert tip_of_joints(urdf(*ARM, *FINGERS[:1], mimic="left"), ["a", "b"]) in {"two", "tip1"}
    assert tip_of_joints(urdf(*ARM, ("f", "prismatic", "two", "end"), mimic="f"), ["a", "b"])


def test_what_is_no_xml_is_refused():
    with pytest.raises(InvalidInput, match="no XML"):
        tip_of_joints("<robot", ["a"])
