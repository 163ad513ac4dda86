"""Placements of joints in the text of a URDF: what changes, and that nothing else does."""

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from handeye.errors import FileFormatError, InvalidInput
from handeye.geometry import make_pose
from handeye.io.urdf_origins import corrected_urdf, joint_origins, origin_element, xyz_rpy

TEXT = """<?xml version="1.0"?>
<!-- a word before: <joint name="one"> is not here -->
<robot name="two" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <link name="base"><inertial><origin xyz="9 9 9"/></inertial></link>
  <joint name='one' type="revolute">
    <origin  xyz = '0 0 0.3'
             rpy="0.1 0.2 0.3" />   <!-- kept > so -->
    <parent link="base"/><child link="a"/>
    <axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/>
  </joint>
  <link name="a"/>
  <joint name="two &amp; half" type="revolute">
    <parent link="a"/><child link="b"/>
    <axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <link name="b"/>
  <joint name="f" type="fixed"><parent link="b"/><child link="tip"/>
    <origin xyz="0.4 0 0"></origin></joint>
  <link name="tip"/>
</robot>
"""


def departure(seed):
    rng = np.random.default_rng(seed)
    turn = Rotation.from_rotvec(rng.normal(size=3) * 0.01).as_matrix()
    return make_pose(turn, rng.normal(size=3) * 1e-3)


def test_origins_are_read_and_default_to_nothing():
    one, two = joint_origins(TEXT, ["one", "two & half"])
    np.testing.assert_allclose(one[:3, 3], [0, 0, 0.3])
    # URDF: fixed axes, roll about x first, then pitch about y, then yaw about z.
    about = [Rotation.from_rotvec(a) for a in ([0.1, 0, 0], [0, 0.2, 0], [0, 0, 0.3])]
    np.testing.assert_allclose(one[:3, :3], (about[2] * about[1] * about[0]).as_matrix())
    np.testing.assert_array_equal(two, np.eye(4))


@given(seed=st.integers(0, 1000))
def test_a_departure_follows_the_old_placement_and_all_else_stays(seed):
    D = np.array([departure(seed), departure(seed + 1)])
    names = ["two & half", "one"]
    written = corrected_urdf(TEXT, names, D)
    np.testing.assert_allclose(
        joint_origins(written, names), joint_origins(TEXT, names) @ D, atol=1e-14
    )
    fixed = re.compile(r"\s*<origin[^>]*/>")
    pattern = r"(<joint name='one'[^>]*>|<joint name=\"two[^>]*>)" + fixed.pattern
    assert re.sub(pattern, r"\1", written).split() == re.sub(pattern, r"\1", TEXT).split()
    for kept in ('<origin xyz="9 9 9"/>', '<origin xyz="0.4 0 0"></origin>', "<!-- kept > so -->"):
        assert kept in written


def test_an_origin_with_an_end_tag_goes_as_a_whole():
    written = corrected_urdf(TEXT, ["f"], np.array([departure(0)]))
    assert "</origin>" not in written
    moved = joint_origins(written, ["f"])[0]
    np.testing.assert_allclose(moved, make_pose(np.eye(3), [0.4, 0, 0]) @ departure(0), atol=1e-15)


def test_nothing_changes_without_joints():
    assert corrected_urdf(TEXT, [], np.empty((0, 4, 4))) == TEXT


@given(
    roll=st.floats(-3.14, 3.14),
    pitch=st.sampled_from([-np.pi / 2, -np.pi / 2 + 1e-9, 0.3, np.pi / 2 - 1e-8, np.pi / 2]),
    yaw=st.floats(-3.14, 3.14),
)
def test_roll_pitch_and_yaw_say_every_rotation(roll, pitch, yaw):
    R = Rotation.from_euler("xyz", [roll, pitch, yaw]).as_matrix()
    xyz, rpy = xyz_rpy(make_pose(R, [1, 2, 3]))
    assert xyz == [1, 2, 3]
    np.testing.assert_allclose(Rotation.from_euler("xyz", rpy).as_matrix(), R, atol=1e-14)


def test_numbers_are_written_in_full():
    text = origin_element(make_pose(np.eye(3), [0.1 + 0.2, 1e-17, -3]))
    assert text == '<origin xyz="0.30000000000000004 1e-17 -3.0" rpy="0.0 -0.0 0.0"/>'


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("<robot><joint name='one'><origin", "no XML"),
        ("<robot><joint name='one'><origin xyz='1 2'/></joint></robot>", "three numbers"),
        ("<robot><joint name='one'><origin rpy='a b c'/></joint></robot>", "three numbers"),
    ],
)
def test_text_that_is_no_urdf_is_refused(text, said):
    with pytest.raises(FileFormatError, match=said):
        joint_origins(text, ["one"])


def test_misuse_is_explained():
    with pytest.raises(InvalidInput, match="no joint three; it has f, one, two & half"):
        joint_origins(TEXT, ["three"])
    with pytest.raises(InvalidInput, match="departures must have shape"):
        corrected_urdf(TEXT, ["one"], np.eye(4))


def test_the_written_arm_has_the_corrected_poses():
    pytest.importorskip("pinocchio")
    from handeye.robots.urdf import UrdfArm, shipped_robots  # noqa: PLC0415

    urdf = Path(shipped_robots()["ur10"]).read_text()
    arm = UrdfArm.from_text(urdf, None, "ur10")
    D = np.array([departure(seed) for seed in range(6)])
    written = UrdfArm.from_text(corrected_urdf(urdf, arm.joint_names, D), None, "ur10")
    joints = np.random.default_rng(1).uniform(-2, 2, (5, 6))
    # T = P_0 D_0 J_0(q_0) P_1 D_1 ...: each stage moves the ones after it.
    stages = joint_origins(urdf, arm.joint_names)
    for q, pose in zip(joints, written.poses(joints), strict=True):
        nominal, moved = np.eye(4), np.eye(4)
        for i in range(6):
            J = make_pose(
                Rotation.from_rotvec(q[i] * axis_of(urdf, arm.joint_names[i])).as_matrix(),
                [0, 0, 0],
            )
            nominal, moved = nominal @ stages[i] @ J, moved @ stages[i] @ D[i] @ J
        beyond = np.linalg.inv(nominal) @ arm.poses(q[np.newaxis])[0]
        np.testing.assert_allclose(pose, moved @ beyond, atol=1e-13)


def axis_of(urdf, joint):
    axis = re.search(rf'name="{joint}".*?<axis xyz="([^"]*)"', urdf, re.DOTALL)
    assert axis is not None
    return np.array([float(word) for word in axis[1].split()])
