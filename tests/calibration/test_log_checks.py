"""Whether a log can be that of an arm."""

from dataclasses import replace

import numpy as np
import pytest

from handeye.calibration.log_checks import check_log
from handeye.errors import LogError
from handeye.io.logs import Log
from handeye.observations import PointObservation, StereoObservation
from handeye.robots.planar import TwoLinkArm
from handeye.robots.urdf import load_arm

ARM = load_arm("ur10")
N = 40


@pytest.fixture
def log():
    rng = np.random.default_rng(0)
    joints = rng.uniform(-2.0, 2.0, (N, 6))
    position = ARM.poses(joints)[:, :3, 3] + [3.0, -2.0, 1.0]
    seen = PointObservation(np.arange(float(N)), joints, position)
    return Log("run.csv", ARM.joint_names, seen, np.arange(2, N + 2))


def with_position(log, position):
    return replace(log, observations=replace(log.observations, position=position))


def test_a_log_that_fits_comes_back_whole(log):
    reading = check_log(ARM, log)
    assert reading.rejected == ()
    assert len(reading.log) == N


def test_joints_are_put_in_the_arms_order_and_others_dropped(log):
    order = [4, 0, 5, 2, 1, 3]
    names = (*(log.joint_names[i] for i in order), "gripper")
    joints = np.column_stack([log.observations.joints[:, order], np.zeros(N)])
    shuffled = replace(
        log, joint_names=names, observations=replace(log.observations, joints=joints)
    )
    fitted = check_log(ARM, shuffled).log
    assert fitted.joint_names == ARM.joint_names
    np.testing.assert_array_equal(fitted.observations.joints, log.observations.joints)


def test_missing_joints_are_named_with_near_names_and_remedies(log):
    names = ("base_joint", "shoulder_lift_joint", "elbow", *log.joint_names[3:])
    renamed = replace(log, joint_names=names, ignored=("shoulder_pan_joint_deg", "temperature"))
    with pytest.raises(LogError) as caught:
        check_log(ARM, renamed, skip_bad=True)
    message = str(caught.value)
    assert "run.csv: joints of ur10 are missing: shoulder_pan_joint, elbow_joint" in message
    assert "shoulder_pan_joint_deg: multiply it by pi/180" in message
    assert "elbow_rad: rename it to elbow_joint_rad" in message
    assert "--tip" in message


def test_millimetres_are_seen_by_the_arms_reach_and_never_skipped(log):
    with pytest.raises(LogError, match=r"millimetres: divide them by 1000"):
        check_log(ARM, with_position(log, 1000.0 * log.observations.position), skip_bad=True)
    with pytest.raises(LogError, match="another robot"):
        check_log(ARM, with_position(log, 1e7 * log.observations.position), skip_bad=True)


def test_single_rows_out_of_reach_are_named_or_left_out(log):
    position = log.observations.position.copy()
    position[7] += [5.0, 0.0, 0.0]
    spoilt = with_position(log, position)
    with pytest.raises(LogError, match=r"1 of 40 rows.*\n  row 9: .*out of reach of ur10"):
        check_log(ARM, spoilt)
    reading = check_log(ARM, spoilt, skip_bad=True)
    assert [bad.row for bad in reading.rejected] == [9]
    assert len(reading.log) == N - 1
    assert 9 not in reading.log.rows


def test_ranges_of_a_stereo_log_are_checked_alike():
    planar = TwoLinkArm(1.0, 1.0)
    rng = np.random.default_rng(1)
    distance = rng.uniform(0.5, 3.5, N)
    seen = StereoObservation(np.arange(float(N)), np.zeros((N, 2)), distance, distance, distance)
    log = Log("s.csv", ("alpha", "beta"), seen, np.arange(2, N + 2))
    assert check_log(planar, log).rejected == ()
    far = replace(log, observations=replace(seen, range=1000.0 * distance))
    with pytest.raises(LogError, match="millimetres"):
        check_log(planar, far)
    distance = distance.copy()
    distance[0] = 9.0
    odd = replace(log, observations=replace(seen, range=distance))
    assert [bad.row for bad in check_log(planar, odd, skip_bad=True).rejected] == [2]
