"""Joint angles between joint states."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from handeye.io.bags.matching import JointMotion, JointSamples
from handeye.io.bags.messages import JointReading
from handeye.io.bags.tracks import Joints

TOLERANCE = 0.1


def uneven(n, rng):
    return np.cumsum(rng.uniform(1e-3, TOLERANCE, n))


@given(
    seed=st.integers(0, 2**32),
    n=st.integers(2, 30),
    slope=st.floats(-20.0, 20.0),
    offset=st.floats(-3.0, 3.0),
)
def test_linear_motion_is_recovered_exactly(seed, n, slope, offset):
    rng = np.random.default_rng(seed)
    times = uneven(n, rng)
    samples = JointSamples(times, (offset + slope * times)[:, None], TOLERANCE)
    moments = rng.uniform(times[0], times[-1], 20)
    found = samples.at(moments)
    assert found.interpolated.all()
    np.testing.assert_allclose(found.angles[:, 0], offset + slope * moments, atol=1e-9)
    at_samples = samples.at(times)
    np.testing.assert_array_equal(at_samples.angles[:, 0], offset + slope * times)
    assert np.all(at_samples.gap == 0.0)


@given(seed=st.integers(0, 2**32), speed=st.floats(-15.0, 15.0))
def test_a_joint_that_goes_round_is_followed_the_short_way(seed, speed):
    rng = np.random.default_rng(seed)
    times = uneven(40, rng)
    straight = 3.0 + speed * times
    wrapped = np.arctan2(np.sin(straight), np.cos(straight))
    moments = rng.uniform(times[0], times[-1], 40)
    found = JointSamples(times, wrapped[:, None], TOLERANCE).at(moments).angles[:, 0]
    want = 3.0 + speed * moments
    np.testing.assert_allclose(np.cos(found), np.cos(want), atol=1e-9)
    np.testing.assert_allclose(np.sin(found), np.sin(want), atol=1e-9)
    assert np.all(np.abs(found) <= np.pi + 1e-9)


def test_gaps_beyond_the_tolerance_and_the_ends_have_no_angles():
    times = np.array([0.0, 0.05, 0.1, 0.5, 0.6])
    samples = JointSamples(times, times[:, None], TOLERANCE)
    found = samples.at(np.array([-0.01, 0.02, 0.11, 0.3, 0.5, 0.55, 0.61]))
    np.testing.assert_array_equal(found.usable, [False, True, False, False, True, True, False])
    np.testing.assert_allclose(found.angles[found.usable, 0], [0.02, 0.5, 0.55])
    assert np.isnan(found.angles[~found.usable]).all()
    np.testing.assert_allclose(found.gap, [np.inf, 0.05, 0.4, 0.4, 0.0, 0.1, np.inf])
    np.testing.assert_array_equal(
        samples.covers(np.array([0.0, 0.0, 0.1, 0.5, -0.1]), np.array([0.1, 0.2, 0.5, 0.6, 0.05])),
        [True, False, False, True, False],
    )


def test_where_poses_are_recorded_one_by_one_the_nearest_within_the_tolerance_counts():
    times = np.array([0.0, 10.0, 20.0])
    samples = JointSamples(times, times[:, None], TOLERANCE)
    found = samples.at(np.array([0.02, 9.95, 10.2, 20.1]))
    np.testing.assert_array_equal(found.nearest, [True, True, False, True])
    np.testing.assert_array_equal(found.angles[found.usable, 0], [0.0, 10.0, 20.0])
    assert not found.interpolated.any()


def test_joints_reported_apart_are_put_in_the_order_asked_for():
    joints = Joints()
    for i in range(11):
        joints.add(JointReading(i * 10**7 + 1, ("b", "a"), (20.0 + i, 10.0 + i)), 0)
        joints.add(JointReading(i * 10**7 + 2, ("gripper",), (30.0 + i,)), 0)
    wanted = ("a", "gripper", "b")
    motion = JointMotion(wanted, joints.tracks(wanted), 1, TOLERANCE)
    found = motion.at(np.array([0.055]))
    np.testing.assert_allclose(found.angles, [[15.5, 35.5, 25.5]], atol=1e-6)
    np.testing.assert_allclose(motion.travel, 10.0)
    assert joints.names == ("b", "a", "gripper")


def test_readings_in_any_order_are_sorted_and_of_equal_stamps_the_first_counts():
    joints = Joints()
    for stamp, value in ((3, 0.3), (1, 0.1), (3, 9.0), (2, 0.2)):
        joints.add(JointReading(stamp, ("a",), (value,)), stamp + 5)
    [(_, track)] = joints.tracks(("a",))
    np.testing.assert_array_equal(track.stamps, [1, 2, 3])
    np.testing.assert_array_equal(track.values[:, 0], [0.1, 0.2, 0.3])
    np.testing.assert_array_equal(track.numbers, [2, 4, 1])
    assert track.lag == 5
    assert joints.faults["repeated"] == 1


@pytest.mark.parametrize(
    ("reading", "fault"),
    [
        (None, "decoded"),
        (JointReading(0, ("a",), (0.1,)), "stamped"),
        (JointReading(1, ("a",), (float("nan"),)), "finite"),
    ],
)
def test_readings_that_cannot_be_used_are_counted(reading, fault):
    joints = Joints()
    joints.add(reading, 1)
    assert joints.faults == {fault: 1}
    assert not joints.streams
