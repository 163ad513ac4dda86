"""Mimic joints: one reading moves several joints."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.robots.made import FOUR, joint, mimic, palletiser

from handeye.errors import FileFormatError, InvalidInput
from handeye.robots.readings import Follower, Readings
from handeye.robots.urdf import UrdfArm

NUMBERS = st.floats(-3.0, 3.0).filter(lambda value: abs(value) > 0.01)


ARM = UrdfArm.from_text(palletiser(), None, "palletiser")
FREE = UrdfArm.from_text(palletiser(plain=True), None, "free")


def spread(q):
    """Where the joints are, by hand."""
    level = -q[:, 1] + 0.3
    return np.column_stack([q[:, 0], q[:, 1], level, 0.5 * level])


@given(st.integers(0, 2**32 - 1).map(np.random.default_rng))
def test_followers_stand_where_the_reading_of_their_leader_says(rng):
    q = rng.uniform(-2.0, 2.0, (4, 2))
    assert ARM.joint_names == ("turn", "shoulder")
    assert ARM.stage_names == FREE.joint_names == ("turn", "shoulder", "level", "out")
    np.testing.assert_allclose(ARM.poses(q), FREE.poses(spread(q)), atol=1e-14)
    np.testing.assert_allclose(ARM.loads(q), FREE.loads(spread(q)), atol=1e-12)
    by_joint = FREE.jacobians(spread(q))
    np.testing.assert_allclose(ARM.jacobians(q)[:, :, 0], by_joint[:, :, 0], atol=1e-14)
    led = by_joint[:, :, 1] - by_joint[:, :, 2] - 0.5 * by_joint[:, :, 3]
    np.testing.assert_allclose(ARM.jacobians(q)[:, :, 1], led, atol=1e-14)


@given(NUMBERS, NUMBERS, NUMBERS, NUMBERS)
def test_a_follower_of_a_follower_multiplies_and_adds(g1, o1, g2, o2):
    led = {"b": Follower("a", g1, o1), "c": Follower("b", g2, o2)}
    found = Readings.of_chain(("c", "a", "z"), led)
    assert found.names == ("a", "z")
    q = np.array([[0.7, 0.1], [-0.2, 3.0]])
    expected = np.column_stack([g2 * (g1 * q[:, 0] + o1) + o2, q[:, 0], q[:, 1]])
    np.testing.assert_allclose(found.positions(q), expected, atol=1e-12)
    ahead = (found.positions(q + np.array([1e-3, 0.0])) - found.positions(q)) / 1e-3
    np.testing.assert_allclose(found.slopes(np.eye(3))[:, 0], ahead[0], atol=1e-9)


def test_a_leader_may_be_off_the_chain():
    # Both fingers of a gripper: the right one follows the left one.
    fingers = (
        joint("left", "prismatic", "l4", "finger_l", axis="0 1 0"),
        joint("right", "prismatic", "l4", "finger_r", axis="0 -1 0", extra=mimic("left", 2.0)),
    )
    text = FOUR.replace("</robot>", "<link name='finger_l'/><link name='finger_r'/></robot>")
    text = text.replace("</robot>", "".join(fingers) + "</robot>")
    arm = UrdfArm.from_text(text, "finger_r", "gripper")
    assert arm.joint_names == ("lift", "spin", "bend", "left")
    assert arm.stage_names == ("lift", "spin", "bend", "right")
    opened = arm.poses([[0.0, 0.0, 0.0, 0.1], [0.0, 0.0, 0.0, 0.0]])
    np.testing.assert_allclose(opened[0, :3, 3] - opened[1, :3, 3], [0.0, -0.2, 0.0], atol=1e-14)
    np.testing.assert_array_equal(arm.upper, [2.5, np.inf, 2.5, 2.5])
    assert arm.travel[3] == 8.0  # 2 (2.5 + 1.5)
    # Joints below the tip are not asked for.
    assert UrdfArm.from_text(text, "l4", "gripper").joint_names == ("lift", "spin", "bend")


def test_an_arm_without_mimic_joints_is_read_joint_by_joint():
    plain = FREE.readings
    assert plain.names == FREE.stage_names
    np.testing.assert_array_equal(plain.of, np.arange(4))
    np.testing.assert_array_equal(plain.gains, np.ones(4))
    np.testing.assert_array_equal(plain.offsets, np.zeros(4))


@pytest.mark.parametrize(
    ("extra", "says"),
    [
        (mimic("shoulder", "much"), "not a usable URDF file"),
        (mimic("shoulder", "nan"), "not a usable URDF file"),
        (mimic("shoulder", 1.0, "inf"), "not a usable URDF file"),
        (mimic("shoulder", 0.0), "multiplier 0: a joint that never moves"),
        (mimic("out"), "follow each other in a circle: level, out"),
        (mimic("level"), "follow each other in a circle: level"),
    ],
)
def test_mimics_that_make_no_sense_are_refused(extra, says):
    text = palletiser().replace(mimic("shoulder", -1.0, 0.3), extra)
    with pytest.raises(FileFormatError, match=says):
        UrdfArm.from_text(text, None, "odd")


def test_a_leader_that_does_not_move_is_refused():
    for leader in ("absent", "mount"):
        text = FOUR.replace(joint("bend", "revolute", "l3", "l4", axis="0 1 0"), "").replace(
            "</robot>",
            joint("bend", "revolute", "l3", "l4", axis="0 1 0", extra=mimic(leader)) + "</robot>",
        )
        with pytest.raises(InvalidInput, match=f"follows '{leader}', which is no moving joint"):
            UrdfArm.from_text(text, "tip", "odd")
