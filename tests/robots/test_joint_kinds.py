"""Joints of every kind and number that a URDF file may have on the way to the hand."""

import numpy as np
import pytest
from tests.robots.made import LIMIT, joint, redundant

from handeye.robots.urdf import FREE_TRAVEL, UrdfArm

UNLIMITED = '<limit effort="1" velocity="1"/>'


GRIPPER = (
    '<link name="finger_l"/><link name="finger_r"/><link name="palm"/>'
    + joint("grip", "fixed", "l8", "palm")
    + joint("open", "prismatic", "palm", "finger_l", axis="0 1 0")
    + joint("close", "prismatic", "palm", "finger_r", axis="0 -1 0", extra=UNLIMITED)
)


def test_a_redundant_arm_has_motions_that_leave_the_hand_where_it_is():
    arm = UrdfArm.from_text(redundant(), None, "redundant")
    q = np.random.default_rng(0).uniform(-1.0, 1.0, (5, 8))
    assert arm.tip == "l8"
    for J, joints in zip(arm.jacobians(q), q, strict=True):
        assert np.linalg.matrix_rank(J) == 6
        idle = np.linalg.svd(J)[2][6]
        there = arm.poses([joints, joints + 1e-4 * idle])
        np.testing.assert_allclose(there[1], there[0], atol=1e-7)
    np.testing.assert_allclose(arm.stages().upright().poses(q), arm.poses(q), atol=1e-12)


def test_a_gripper_below_the_tip_is_not_asked_for():
    arm = UrdfArm.from_text(redundant(behind=GRIPPER), "palm", "gripped")
    assert arm.joint_names == tuple(f"j{i}" for i in range(8))
    q = np.random.default_rng(1).uniform(-1.0, 1.0, (3, 8))
    plain = UrdfArm.from_text(redundant(), None, "redundant")
    np.testing.assert_array_equal(arm.poses(q), plain.poses(q))
    finger = UrdfArm.from_text(redundant(behind=GRIPPER), "finger_l", "gripped")
    assert finger.joint_names == (*arm.joint_names, "open")


def test_limits_that_a_file_leaves_out_are_none():
    text = redundant(behind=GRIPPER).replace(LIMIT, UNLIMITED)
    arm = UrdfArm.from_text(text, "finger_r", "free")
    assert np.all(np.isinf(arm.lower) & np.isinf(arm.upper))
    np.testing.assert_array_equal(arm.travel, np.full(9, FREE_TRAVEL))
    # What slides without limits counts a metre, so that the reach is a number.
    assert arm.reach == pytest.approx(8 * np.hypot(0.02, 0.2) + 2 * FREE_TRAVEL)
    limited = UrdfArm.from_text(redundant(), None, "redundant")
    assert limited.reach == pytest.approx(8 * np.hypot(0.02, 0.2) + 2.5)
    np.testing.assert_array_equal(limited.travel, np.full(8, 4.0))


def test_every_link_between_two_joints_may_carry_the_marker():
    text = redundant(behind=GRIPPER)
    q = np.random.default_rng(2).uniform(-1.0, 1.0, (2, 8))
    for n in range(1, 9):
        arm = UrdfArm.from_text(text, f"l{n}", "redundant")
        assert arm.joint_names == tuple(f"j{i}" for i in range(n))
        whole = UrdfArm.from_text(text, "l8", "redundant")
        rest = UrdfArm.from_text(text, "l8", "redundant", f"l{n}") if n < 8 else None
        ahead = np.tile(np.eye(4), (2, 1, 1)) if rest is None else rest.poses(q[:, n:])
        np.testing.assert_allclose(arm.poses(q[:, :n]) @ ahead, whole.poses(q), atol=1e-12)
