"""The delay between sensor and joints, from the measurements."""

import numpy as np
import pytest
from tests.io.bags.recordings import Motion, ur10

from handeye.io.bags.delay import estimate_delay, stated
from handeye.io.bags.matching import JointMotion
from handeye.io.bags.tracks import Track


def joint_motion(motion, *, rate=125.0, at=None):
    times = np.arange(0.0, motion.seconds, 1.0 / rate) if at is None else at
    stamps = np.round(times * 1e9).astype(np.int64)
    track = Track(stamps, motion.joints(times), np.arange(len(times)) + 1, 0)
    names = ur10().joint_names
    return JointMotion(names, [(names, track)], 0, 0.1)


def measured(motion, every=0.1, noise=1e-4, seed=0):
    times = np.arange(0.6, motion.seconds - 0.6, every)
    scatter = np.random.default_rng(seed).normal(0.0, noise, (len(times), 3))
    return times, motion.positions(times) + scatter


@pytest.mark.parametrize("delay", [-0.21, 0.004, 0.37])
def test_the_delay_is_found_within_its_stated_deviation(delay):
    motion = Motion(seconds=30.0)
    times, positions = measured(motion)
    found = estimate_delay(times + delay, positions, joint_motion(motion), ur10())
    assert found.estimate is not None
    assert found.std is not None
    assert abs(found.estimate - delay) < 3.0 * found.std
    assert found.std < 5e-4
    assert found.seconds == found.estimate
    assert f"{1e3 * found.estimate:.3g} ± " in found.status


def test_the_deviation_is_honest_for_an_arm_that_is_not_what_its_model_says():
    class Bent:
        joint_names = ur10().joint_names

        def poses(self, joints):
            return ur10().poses(joints + 0.01 * np.sin(2.0 * joints))

    motion = Motion(seconds=30.0)
    scores = []
    for seed in range(3):
        times = np.arange(0.6, 29.0, 0.1) + 0.02 * seed
        found = estimate_delay(times + 0.05, motion.positions(times), joint_motion(motion), Bent())
        assert found.estimate is not None
        assert found.std is not None
        scores.append((found.estimate - 0.05) / found.std)
        assert found.std > 1e-4
    assert np.max(np.abs(scores)) < 3.0


def test_one_wrong_point_in_ten_does_not_matter():
    motion = Motion(seconds=30.0)
    times, positions = measured(motion)
    rng = np.random.default_rng(5)
    wrong = rng.random(len(times)) < 0.1
    positions[wrong] += rng.normal(0.0, 0.1, (wrong.sum(), 3))
    found = estimate_delay(times + 0.05, positions, joint_motion(motion), ur10())
    assert found.std is not None
    assert abs(found.seconds - 0.05) < 3.0 * found.std < 3e-4


def test_a_sensor_on_the_hand_has_its_delay_found_too():
    motion = Motion(seconds=30.0)
    times = np.arange(0.6, 29.4, 0.1)
    flanges = ur10().poses(motion.joints(times))
    point = np.array([0.4, -0.8, 0.1]) - flanges[:, :3, 3]
    positions = np.array([0.02, 0.0, 0.1]) + np.einsum("nji,nj->ni", flanges[:, :3, :3], point)
    found = estimate_delay(times + 0.08, positions, joint_motion(motion), ur10())
    assert found.seconds == pytest.approx(0.08, abs=2e-4)


def test_without_the_arm_a_long_record_still_tells():
    motion = Motion(seconds=150.0)
    times, positions = measured(motion)
    found = estimate_delay(times + 0.12, positions, joint_motion(motion), None)
    assert found.estimate is not None
    assert found.std is not None
    assert abs(found.estimate - 0.12) < 3.0 * found.std
    assert found.std < 5e-3


def test_a_delay_that_may_be_none_is_not_used():
    motion = Motion(seconds=30.0)
    times, positions = measured(motion, noise=5e-3)
    found = estimate_delay(times, positions, joint_motion(motion), ur10())
    assert found.seconds == 0.0
    assert found.estimate is not None
    assert found.estimate != 0.0
    assert "may be none" in found.status


def test_what_cannot_be_told_is_said():
    motion = Motion(seconds=20.0)
    times, positions = measured(motion)
    moving = joint_motion(motion)

    def status(*arguments):
        found = estimate_delay(*arguments)
        assert found.seconds == 0.0
        assert found.estimate is None
        assert found.std is None
        assert found.status.startswith("cannot be told: ")
        return found.status

    still = joint_motion(Motion(seconds=20.0, speed=0.0))
    assert "stood still at every measurement" in status(times, positions, still, ur10())
    assert "fewer than 64 measurements" in status(times[:50], positions[:50], moving, ur10())
    assert "more than 0.5 s" in status(times + 0.59, positions, moving, ur10())
    noise = np.random.default_rng(0).normal(size=positions.shape)
    assert "the motion does not decide it" in status(times, positions + noise, moving, ur10())
    assert "(--robot; in Python: arm=)" in status(times, positions, moving, None)
    one_by_one = joint_motion(motion, at=np.arange(0.0, 20.0, 1.0))
    assert "pose by pose" in status(np.arange(0.0, 20.0), positions[:20], one_by_one, ur10())


def test_a_motion_that_halts_for_each_measurement_decides_nothing():
    class Halting(Motion):
        def joints(self, times):
            # A second of rest, a second of motion; one measurement falls into a motion.
            times = np.atleast_1d(times)
            return super().joints(np.floor(times / 2) + np.clip(times % 2 - 1.0, 0.0, 1.0))

    motion = Halting(seconds=200.0)
    times = np.append(np.arange(2.5, 196.0, 2.0), 197.5)
    noisy = motion.positions(times) + np.random.default_rng(0).normal(0.0, 1e-3, (len(times), 3))
    for positions in (motion.positions(times), noisy):
        found = estimate_delay(times + 0.2, positions, joint_motion(motion), ur10())
        assert found.status == "cannot be told: the motion does not decide it; 0 is used"


def test_a_stated_delay_is_used_as_it_is():
    found = stated(-0.0125)
    assert (found.seconds, found.estimate, found.std) == (-0.0125, None, None)
    assert found.status == "-12.5 ms, as stated"
