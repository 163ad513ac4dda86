"""The constants of a chain: they give the same poses as the whole model."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.robots.made import FOUR, joint, robot

from handeye.errors import InvalidInput
from handeye.robots.stages import Stages
from handeye.robots.urdf import UrdfArm

SLANTED = robot(
    joint("slide", "prismatic", "base", "l1", axis="1 2 -2", rpy="0.3 0 0"),
    joint("down", "revolute", "l1", "l2", axis="0 0 -1", xyz="0 0.2 0.1"),
    joint("turn", "continuous", "l2", "tip", axis="0.6 0 0.8", xyz="0.3 0 0", extra=""),
    links="base l1 l2 tip",
)
ARMS = {
    "ur10": UrdfArm.shipped("ur10"),  # revolute, axes along y and z
    "xarm7": UrdfArm.shipped("xarm7"),
    "tiago_no_hand": UrdfArm.shipped("tiago_no_hand"),  # one joint slides
    "double_pendulum_continuous": UrdfArm.shipped("double_pendulum_continuous"),
    "slanted": UrdfArm.from_text(SLANTED, None, "slanted"),
    "four": UrdfArm.from_text(FOUR, "l4", "four"),
}


@pytest.mark.parametrize("name", ARMS)
@given(seed=st.integers(0, 2**32 - 1))
def test_the_stages_of_an_arm_compose_to_its_poses(name, seed):
    arm = ARMS[name]
    joints = np.random.default_rng(seed).uniform(-3.0, 3.0, (3, len(arm.joint_names)))
    stages = arm.stages()
    np.testing.assert_allclose(stages.poses(joints), arm.poses(joints), atol=1e-12)
    np.testing.assert_allclose(stages.upright().poses(joints), arm.poses(joints), atol=1e-12)


@pytest.mark.parametrize("name", ARMS)
def test_upright_joints_move_along_z_and_turns_say_how_they_lay(name):
    stages = ARMS[name].stages()
    upright = stages.upright()
    np.testing.assert_array_equal(upright.axes, np.tile([0.0, 0.0, 1.0], (len(stages.axes), 1)))
    np.testing.assert_array_equal(upright.slides, stages.slides)
    np.testing.assert_allclose(stages.turns @ [0.0, 0.0, 1.0], stages.axes, atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(stages.turns), 1.0)


def test_which_joints_slide():
    assert ARMS["slanted"].stages().slides.tolist() == [True, False, False]
    np.testing.assert_allclose(ARMS["slanted"].stages().axes[0], np.array([1.0, 2.0, -2.0]) / 3.0)


def test_gravity_pulls_a_horizontal_pendulum_down():
    link = '<inertial><mass value="2.0"/><origin xyz="0.5 0 0"/><inertia ixx="1" ixy="0" ixz="0" '
    link = f'<link name="l1">{link}iyy="1" iyz="0" izz="1"/></inertial></link>'
    text = robot(joint("swing", "revolute", "base", "l1", axis="0 1 0"), links="base")
    arm = UrdfArm.from_text(text.replace("<joint", f"{link}<joint", 1), "l1", "pendulum")
    # A turn about +y takes the mass on x downwards: gravity turns the joint forwards.
    loads = arm.loads([[0.0], [np.pi / 2], [np.pi / 3]])
    np.testing.assert_allclose(loads[:, 0], 2.0 * 9.81 * 0.5 * np.array([1.0, 0.0, 0.5]), atol=1e-9)


def test_stages_that_do_not_fit_together_are_refused():
    one = np.eye(4)[np.newaxis]
    axis, slides = np.array([[0.0, 0.0, 1.0]]), np.zeros(1, np.bool_)
    with pytest.raises(InvalidInput, match="placements"):
        Stages(one, axis, slides)
    with pytest.raises(InvalidInput, match="length 1"):
        Stages(np.repeat(one, 2, axis=0), 2.0 * axis, slides)
    with pytest.raises(InvalidInput, match="joints"):
        Stages(np.repeat(one, 2, axis=0), axis, slides).poses(np.zeros((3, 2)))
