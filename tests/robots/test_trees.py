"""Chains that start at any link of a tree: heads, several arms, cameras on flanges."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.robots.made import FOUR, TORSO, joint, robot

from handeye.errors import FileFormatError, InvalidInput
from handeye.geometry import invert, make_pose
from handeye.io.urdf_origins import corrected_urdf
from handeye.robots.stages import Stages
from handeye.robots.urdf import UrdfArm, load_arm
from handeye.robots.ways import Way

HEAD_TO_LEFT = ("tilt", "pan", "left_1", "left_2", "left_3", "left_4", "left_5")
RNG = st.integers(0, 2**32 - 1).map(np.random.default_rng)


def torso(tip, eye=None):
    return UrdfArm.from_text(TORSO, tip, "torso", eye)


ENDS = [
    ("left_hand", "camera"),
    ("left_hand", "right_hand"),
    ("left_hand", "torso"),
    ("base", "left_hand"),
    ("torso", "camera"),
    ("left_b", "left_hand"),
]


def apart(tip, eye, joints, names):
    """T_eye_tip from two chains that both start at the root."""

    def from_root(link):
        if link == "base":
            return np.eye(4)
        arm = torso(link)
        rest = dict(zip(names, joints.T, strict=True))
        return arm.poses(
            np.column_stack([rest.get(n, 0.0 * joints[:, 0]) for n in arm.joint_names])
        )

    return invert(from_root(eye)) @ from_root(tip)


@pytest.mark.parametrize(("tip", "eye"), ENDS)
@given(rng=RNG)
def test_poses_are_those_of_the_hand_seen_from_the_eye(tip, eye, rng):
    arm = torso(tip, eye)
    q = rng.uniform(-1.5, 1.5, (3, len(arm.joint_names)))
    expected = apart(tip, eye, q, arm.joint_names)
    np.testing.assert_allclose(arm.poses(q), expected, atol=1e-12)
    np.testing.assert_allclose(arm.stages().poses(q), expected, atol=1e-12)
    np.testing.assert_allclose(arm.stages().upright().poses(q), expected, atol=1e-12)


@pytest.mark.parametrize(("tip", "eye"), ENDS)
def test_jacobians_are_those_of_differences(tip, eye):
    arm, h = torso(tip, eye), 1e-6
    n = len(arm.joint_names)
    q = np.random.default_rng(4).uniform(-1.5, 1.5, (5, n))
    J, R = arm.jacobians(q), arm.poses(q)[:, :3, :3]
    for i, step in enumerate(h * np.eye(n)):
        D = (arm.poses(q + step) - arm.poses(q - step)) / (2.0 * h)
        spin = D[:, :3, :3] @ R.swapaxes(1, 2)
        angular = np.stack([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]], axis=1)
        np.testing.assert_allclose(J[:, :3, i], D[:, :3, 3], atol=1e-8)
        np.testing.assert_allclose(J[:, 3:, i], angular, atol=1e-8)


def test_joints_above_the_fork_and_on_other_branches_are_not_asked_for():
    arm = torso("left_hand", "camera")
    assert arm.joint_names == arm.stage_names == HEAD_TO_LEFT
    assert arm.stages().upwards == 2
    assert torso("left_hand").joint_names == ("lift", *HEAD_TO_LEFT[2:])
    assert torso("left_hand", "torso").joint_names == HEAD_TO_LEFT[2:]
    assert torso("base", "left_hand").joint_names == (*HEAD_TO_LEFT[:1:-1], "lift")


def test_the_root_as_eye_is_as_no_eye():
    q = np.random.default_rng(5).uniform(-1.0, 1.0, (4, 6))
    np.testing.assert_array_equal(torso("left_hand", "base").poses(q), torso("left_hand").poses(q))
    plain, named = torso("left_hand").stages(), torso("left_hand", "base").stages()
    np.testing.assert_array_equal(plain.placements, named.placements)
    assert (plain.upwards, named.upwards) == (0, 0)


def test_gravity_does_not_depend_on_who_looks():
    seen, rooted = torso("left_hand", "camera"), torso("left_hand")
    q = np.random.default_rng(6).uniform(-1.0, 1.0, (4, 7))
    lifted = np.column_stack([np.zeros(4), q[:, 2:]])
    np.testing.assert_allclose(seen.loads(q)[:, 2:], rooted.loads(lifted)[:, 1:], atol=1e-12)
    # Head and camera, 1.5 kg each 0.1 and 0.05 m before the joint, make it nod.
    nods = seen.loads(np.zeros((1, 7)))[0, 0]
    assert nods == pytest.approx(1.5 * 9.81 * (0.1 + 0.05), rel=0.01)


def test_joints_that_move_the_eye_are_held():
    assert torso("left_hand", "camera").held.tolist() == [True, True] + 5 * [False]
    assert torso("left_hand", "right_hand").held.tolist() == 5 * [True] + 5 * [False]
    # A camera on the hand is itself what moves.
    assert not torso("base", "left_hand").held.any()
    assert not torso("left_hand").held.any()


@pytest.mark.parametrize(("tip", "eye"), ENDS)
def test_joints_written_to_the_file_stand_where_the_stages_were_found(tip, eye):
    arm, rng = torso(tip, eye), np.random.default_rng(7)
    nominal = arm.stages()
    n = len(nominal.slides)
    turns = make_pose(np.eye(3), rng.normal(size=(n + 1, 3)) * 0.01)
    turns[:, :3, :3] = np.linalg.qr(np.eye(3) + 0.02 * rng.normal(size=(n + 1, 3, 3)))[0]
    turns[:, :3, :3] *= np.sign(np.linalg.det(turns[:, :3, :3]))[:, None, None]
    off = nominal.placements @ turns
    # Neither end is a joint's.
    off[-1] = nominal.placements[-1]
    if nominal.upwards:
        off[0] = nominal.placements[0]
    found = Stages(off, nominal.axes, nominal.slides, nominal.upwards)
    text = corrected_urdf(TORSO, arm.stage_names, nominal.departures(found))
    written = UrdfArm.from_text(text, tip, "written", eye)
    q = rng.uniform(-1.0, 1.0, (3, n))
    np.testing.assert_allclose(written.poses(q), found.poses(q), atol=1e-12)


def test_the_marker_stands_in_the_world_when_the_eye_is_at_the_end():
    for name in ("ur10", "xarm7"):
        arm = load_arm(name)
        back = load_arm(name, eye=arm.tip)
        assert back.joint_names == arm.joint_names[::-1]
        q = np.random.default_rng(8).uniform(-1.0, 1.0, (3, len(arm.joint_names)))
        np.testing.assert_allclose(back.poses(q[:, ::-1]), invert(arm.poses(q)), atol=1e-12)
    # An eye elsewhere leaves the usual tip.
    side = joint("pan", "continuous", "base", "camera", extra="")
    text = FOUR.replace("</robot>", f'<link name="camera"/>{side}</robot>')
    assert UrdfArm.from_text(text, None, "four", "camera").tip == "l4"


def test_links_that_do_not_move_against_each_other_are_refused():
    with pytest.raises(InvalidInput, match="no joint moves the link 'head' against 'camera'"):
        torso("head", "camera")
    with pytest.raises(InvalidInput, match="no link 'cam': choose one of camera"):
        torso("left_hand", "cam")
    with pytest.raises(InvalidInput, match="2 chains of 6 moving joints"):
        torso(None, "camera")


def test_ways_through_a_tree():
    assert Way.between([0, 1, 2, 3], [0, 1, 5, 6]) == ((3, 2), (5, 6))
    assert Way.between([0], [0, 1, 2]) == ((), (1, 2))
    assert Way.between([0, 1, 2], [0, 1]).joints == (2,)


@pytest.mark.parametrize("kind", ["floating", "planar"])
def test_joints_of_several_freedoms_are_refused_on_the_way_only(kind):
    text = robot(
        joint("drive", kind, "world", "base", axis="0 0 1", extra=""),
        joint("pan", "continuous", "base", "head", extra=""),
        joint("lift", "prismatic", "base", "l1"),
        joint("turn", "revolute", "l1", "hand", "0.3 0 0"),
        links="world base head l1 hand",
    )
    with pytest.raises(InvalidInput, match=r"joint drive .* no revolute.*--tip.*--eye"):
        UrdfArm.from_text(text, "hand", "rover")
    # From a link that drives along, the drive does not matter.
    assert UrdfArm.from_text(text, "hand", "rover", "base").joint_names == ("lift", "turn")
    assert UrdfArm.from_text(text, "hand", "rover", "head").joint_names == ("pan", "lift", "turn")


def test_another_chain_through_the_same_robot():
    left = torso("left_hand")
    assert (left.base, torso("left_hand", "camera").base) == ("base", "camera")
    seen = left.between("right_hand", "camera")
    q = np.random.default_rng(9).uniform(-1.0, 1.0, (3, 7))
    np.testing.assert_array_equal(seen.poses(q), torso("right_hand", "camera").poses(q))
    assert (seen.tip, seen.base, seen.name) == ("right_hand", "camera", "torso")
    assert seen.between(eye="torso").joint_names == tuple(f"right_{i}" for i in range(1, 6))
    assert left.between() is left
    assert left.between("left_hand", "base") is left
    with pytest.raises(InvalidInput, match="no joint moves the link 'camera' against 'head'"):
        left.between("camera", "head")
    with pytest.raises(InvalidInput, match="torso has no link 'right_hnd': choose one of right_ha"):
        left.between("right_hnd")


@pytest.mark.parametrize(("tip", "eye"), ENDS)
def test_branches_lead_from_the_fork_to_both_ends(tip, eye):
    arm = torso(tip, eye)
    n = arm.stages().upwards
    q = np.random.default_rng(10).uniform(-1.0, 1.0, (3, len(arm.joint_names)))
    base, end = arm.branches()
    assert (len(base.slides), base.upwards, end.upwards) == (n, 0, 0)
    apart = invert(base.poses(q[:, :n][:, ::-1])) @ end.poses(q[:, n:])
    np.testing.assert_allclose(apart, arm.poses(q), atol=1e-12)


def test_links_that_no_joint_connects_are_no_robot():
    stray = TORSO.replace("</robot>", '<link name="table"/></robot>')
    with pytest.raises(FileFormatError, match="no joint connects base and table: connect them"):
        UrdfArm.from_text(stray, "left_hand", "torso")
