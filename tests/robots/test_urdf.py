"""Arms from URDF files: kinematics, which chain is meant, and what is refused."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from tests.robots.made import FOUR, joint, robot

from handeye.errors import FileFormatError, InvalidInput, MissingExtra
from handeye.geometry import make_pose
from handeye.robots import shipped, urdf
from handeye.robots.shipped import shipped_robots
from handeye.robots.urdf import UrdfArm, load_arm


@pytest.fixture
def file(tmp_path):
    def write(text):
        path = tmp_path / "made.urdf"
        path.write_text(text)
        return path

    return write


def by_hand(q):
    """Forward kinematics of FOUR, link by link, to the link `tip`."""

    def turn(axis, angle):
        return make_pose(Rotation.from_rotvec(angle * np.array(axis)).as_matrix(), np.zeros(3))

    def shift(*xyz):
        return make_pose(np.eye(3), np.array(xyz))

    lift, spin, bend = q
    arm = shift(0.1, 0.0, lift) @ shift(0.0, 0.0, 0.2) @ turn([0.0, 0.0, 1.0], spin)
    return arm @ shift(0.3, 0.0, 0.0) @ turn([0.0, 1.0, 0.0], bend) @ shift(0.4, 0.0, 0.0)


@given(st.integers(0, 2**32 - 1).map(np.random.default_rng))
def test_poses_equal_the_chain_written_out(tmp_path_factory, rng):
    path = tmp_path_factory.mktemp("urdf") / "four.urdf"
    path.write_text(FOUR)
    arm = UrdfArm.from_file(path, tip="tip")
    joints = rng.uniform(-7.0, 7.0, (5, 3))
    np.testing.assert_allclose(arm.poses(joints), [by_hand(q) for q in joints], atol=1e-14)


def test_what_an_arm_tells_of_itself(file):
    arm = UrdfArm.from_file(file(FOUR), tip="tip")
    assert (arm.name, arm.tip) == ("made", "tip")
    assert arm.joint_names == ("lift", "spin", "bend")
    np.testing.assert_array_equal(arm.lower, [-1.5, -np.inf, -1.5])
    np.testing.assert_array_equal(arm.upper, [2.5, np.inf, 2.5])
    assert arm.reach == pytest.approx(0.1 + 2.5 + 0.2 + 0.3 + 0.4)
    assert arm.poses(np.empty((0, 3))).shape == (0, 4, 4)
    assert arm.jacobians(np.empty((0, 3))).shape == (0, 6, 3)


def arms():
    panda = UrdfArm.shipped("panda", tip="panda_hand")
    return [load_arm("ur10"), load_arm("kinova"), load_arm("xarm7"), panda]


@pytest.mark.parametrize("arm", arms(), ids=lambda arm: arm.name)
def test_jacobians_equal_central_differences(arm):
    rng = np.random.default_rng(0)
    n, h = len(arm.joint_names), 1e-6
    joints = rng.uniform(-3.0, 3.0, (20, n))
    J = arm.jacobians(joints)
    R = arm.poses(joints)[:, :3, :3]
    for i, step in enumerate(h * np.eye(n)):
        ahead, behind = arm.poses(joints + step), arm.poses(joints - step)
        linear = (ahead - behind)[:, :3, 3] / (2 * h)
        spin = (ahead - behind)[:, :3, :3] / (2 * h) @ R.swapaxes(1, 2)
        angular = np.stack([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]], axis=1)
        np.testing.assert_allclose(J[:, :3, i], linear, atol=1e-8)
        np.testing.assert_allclose(J[:, 3:, i], angular, atol=1e-8)


@pytest.mark.parametrize("arm", arms(), ids=lambda arm: arm.name)
def test_no_pose_is_beyond_reach_and_every_pose_is_rigid(arm):
    joints = np.random.default_rng(1).uniform(-3.0, 3.0, (500, len(arm.joint_names)))
    T = arm.poses(joints)
    assert np.linalg.norm(T[:, :3, 3], axis=1).max() <= arm.reach
    R = T[:, :3, :3]
    np.testing.assert_allclose(R @ R.swapaxes(1, 2), np.eye(3) + 0.0 * R, atol=1e-12)


def test_continuous_joints_take_an_angle():
    kinova = load_arm("kinova")
    assert np.isinf(kinova.upper[[0, 3, 5]]).all()
    assert len(kinova.joint_names) == 6
    q = np.random.default_rng(2).uniform(-3.0, 3.0, (4, 6))
    np.testing.assert_allclose(kinova.poses(q + 2.0 * np.pi), kinova.poses(q), atol=1e-12)


def test_ur10_flange_is_tool0_at_the_makers_dimensions():
    ur10 = load_arm("ur10")
    assert ur10.tip == "tool0"
    assert ur10.joint_names[0] == "shoulder_pan_joint"
    # Stretched along -x: upper arm 612 mm, forearm 572.3 mm, and the wrist's 115.7 mm below.
    at_zero = ur10.poses(np.zeros((1, 6)))[0, :3, 3]
    np.testing.assert_allclose(
        at_zero, [0.612 + 0.5723, 0.163941 + 0.0922, 0.1273 - 0.1157], atol=1e-4
    )


def test_joints_off_the_chain_rest_at_zero_and_are_not_asked_for(file):
    side = joint("camera_pan", "continuous", "base", "camera", extra="")
    text = FOUR.replace("</robot>", f'<link name="camera"/>{side}</robot>')
    q = np.random.default_rng(3).uniform(-1.0, 1.0, (4, 3))
    plain = UrdfArm.from_file(file(FOUR), tip="tip").poses(q)
    arm = UrdfArm.from_file(file(text))
    assert arm.joint_names == ("lift", "spin", "bend")
    assert UrdfArm.from_file(file(text), tip="camera").joint_names == ("camera_pan",)
    np.testing.assert_array_equal(UrdfArm.from_file(file(text), tip="tip").poses(q), plain)


@pytest.mark.parametrize(
    ("fixed", "tip"), [("tip", "l4"), ("my_tool0", "my_tool0"), ("flange", "flange")]
)
def test_default_tip_is_the_usual_flange_or_the_last_moving_link(file, fixed, tip):
    assert UrdfArm.from_file(file(FOUR.replace('"tip"', f'"{fixed}"'))).tip == tip


def test_a_link_and_a_joint_may_share_a_name(file):
    assert UrdfArm.from_file(file(FOUR.replace('"l4"', '"bend"')), tip="bend").tip == "bend"


def test_equally_long_chains_are_refused_with_the_links_to_choose_from():
    with pytest.raises(InvalidInput) as caught:
        load_arm("panda")
    message = str(caught.value)
    assert "2 chains of 8 moving joints" in message
    assert "panda_leftfinger, panda_rightfinger" in message
    assert "before they part: panda_link7, panda_link8, panda_hand, panda_hand_tcp" in message
    assert "--tip" in message
    assert len(load_arm("panda", "panda_link8").joint_names) == 7


def test_links_that_cannot_be_a_tip_are_refused(file):
    path = file(FOUR)
    with pytest.raises(InvalidInput, match="no link 'tips': choose one of tip"):
        UrdfArm.from_file(path, tip="tips")
    with pytest.raises(InvalidInput, match="no joint moves the link 'base'"):
        UrdfArm.from_file(path, tip="base")
    with pytest.raises(InvalidInput, match="no moving joint"):
        UrdfArm.from_file(file(robot(joint("a", "fixed", "b", "c"), links="b c")))


def test_names_and_files_that_do_not_exist_are_refused(tmp_path):
    with pytest.raises(InvalidInput, match=r"'ur11'; did you mean ur10.*\n.*shipped: .*kinova"):
        load_arm("ur11")
    with pytest.raises(InvalidInput, match="no such URDF file"):
        load_arm(str(tmp_path / "absent.urdf"))


@pytest.mark.parametrize("text", ["", "joint 1: 30 cm", "<robot name='r'>", "<robot name='r'/>"])
def test_files_that_are_no_urdf_are_refused(file, text):
    with pytest.raises(FileFormatError, match="not a usable URDF"):
        load_arm(str(file(text)))


def test_joints_of_another_shape_are_refused():
    ur10 = load_arm("ur10")
    for joints in (np.zeros(6), np.zeros((2, 5)), np.full((1, 6), np.nan)):
        with pytest.raises(InvalidInput, match="joints must"):
            ur10.poses(joints)
        with pytest.raises(InvalidInput, match="joints must"):
            ur10.jacobians(joints)


def test_shipped_names_lead_to_files_and_are_unique():
    robots = shipped_robots()
    assert {"ur10", "panda", "anymal_b_simple/anymal", "anymal_c_simple/anymal"} <= set(robots)
    assert robots["ur3"].name == "ur3_robot.urdf"
    assert all(path.is_file() for path in robots.values())
    assert len(set(robots.values())) == len(robots)


def test_missing_extras_are_named(monkeypatch, file):
    def absent(name):
        raise ImportError(name)

    monkeypatch.setattr(urdf, "import_module", absent)
    urdf._pinocchio.cache_clear()
    with pytest.raises(MissingExtra, match=r"handeye\[robots\]"):
        load_arm(str(file(FOUR)))
    monkeypatch.undo()

    def not_installed(name):
        raise shipped.PackageNotFoundError(name)

    monkeypatch.setattr(shipped, "distribution", not_installed)
    shipped_robots.cache_clear()
    with pytest.raises(MissingExtra, match=r"handeye\[robots\]"):
        load_arm("ur10")
    shipped_robots.cache_clear()
