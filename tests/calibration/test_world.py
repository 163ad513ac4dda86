"""Where the robot works, and what it is shown there (section 3.4.3, 3.4.4)."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.stats import kstest

from handeye.calibration.drift import OffsetStep
from handeye.calibration.world import PlanarWorld, Region
from handeye.errors import InvalidInput
from handeye.thesis.plants import NORMAL

seeds = st.integers(0, 2**32 - 1)
ends = st.floats(-2.5, 2.5)


@st.composite
def regions(draw):
    alpha, beta = sorted([draw(ends), draw(ends)]), sorted([draw(ends), draw(ends)])
    strip, eccentricity = draw(st.floats(0.0, 1.0)), draw(st.floats(0.0, 0.5))
    assume(beta[0] <= -strip or beta[1] >= strip)
    return Region(tuple(alpha), tuple(beta), strip, eccentricity)


@given(regions(), seeds)
def test_poses_stay_in_their_region(region, seed):
    joints, eccentricity = region.sample(50, np.random.default_rng(seed))
    tiny = 1e-12
    for column, (low, high) in zip(joints.T, (region.alpha, region.beta), strict=True):
        assert np.all((column >= low - tiny) & (column <= high + tiny))
    assert np.all(np.abs(joints[:, 1]) >= region.singular_beta - tiny)
    assert np.all(np.abs(eccentricity) <= region.eccentricity)


@given(regions(), seeds, st.integers(0, 20), st.integers(0, 20))
def test_poses_are_the_same_drawn_at_once_or_in_parts(region, seed, first, second):
    at_once = region.sample(first + second, np.random.default_rng(seed))
    rng = np.random.default_rng(seed)
    parts = [region.sample(first, rng), region.sample(second, rng)]
    for whole, *pieces in zip(at_once, *parts, strict=True):
        np.testing.assert_array_equal(whole, np.concatenate(pieces))


@pytest.mark.parametrize(
    "region",
    [
        Region(),
        Region(beta=(-0.4, 2.0)),
        Region(beta=(0.5, 1.5), alpha=(1.0, 1.2)),
        Region(beta=(-1.5, 0.1)),
        Region(singular_beta=0.0),
    ],
    ids=str,
)
def test_poses_are_uniform_over_what_is_left(region):
    joints, eccentricity = region.sample(20_000, np.random.default_rng(7))
    low, high = region.beta
    strip = region.singular_beta
    left, right = max(min(high, -strip) - low, 0.0), max(high - max(low, strip), 0.0)

    def share_below(beta):
        """Distribution over the two sides of the strip, by their lengths."""
        covered = np.clip(beta - low, 0.0, left) + np.clip(beta - max(low, strip), 0.0, right)
        return covered / (left + right)

    span = region.alpha[1] - region.alpha[0]
    assert kstest(joints[:, 1], share_below).pvalue > 1e-3
    assert kstest((joints[:, 0] - region.alpha[0]) / span, "uniform").pvalue > 1e-3
    scaled = (eccentricity / region.eccentricity + 1.0) / 2.0
    assert kstest(scaled, "uniform").pvalue > 1e-3
    independent = np.corrcoef([*joints.T, eccentricity]) - np.eye(3)
    assert np.abs(independent).max() < 0.03


def test_the_default_region_is_that_of_the_thesis():
    # Eq 3.29 to 3.32, and half of the sixty-degree field of view.
    assert Region().alpha == Region().beta == (-0.8 * np.pi, 0.8 * np.pi)
    assert Region().singular_beta == 0.1 * np.pi
    assert Region().eccentricity == np.pi / 6.0


@pytest.mark.parametrize(
    "empty",
    [
        {"alpha": (1.0, -1.0)}, {"beta": (-0.2, 0.2), "singular_beta": 0.3},
        {"beta": (2.0, 1.0)}, {"eccentricity": -0.1},
    ],
    ids=str,
)  # fmt: skip
def test_a_region_without_poses_is_refused(empty):
    with pytest.raises(InvalidInput, match="no pose is left"):
        Region(**empty)


@pytest.mark.parametrize("beta", [0.1 * np.pi, 1.0, -1.0])
def test_a_joint_may_stand_still(beta):
    region = Region(alpha=(0.5, 0.5), beta=(beta, beta), eccentricity=0.0)
    joints, eccentricity = region.sample(3, np.random.default_rng(0))
    np.testing.assert_allclose(joints, np.tile([0.5, beta], (3, 1)))
    np.testing.assert_array_equal(eccentricity, 0.0)


def observed(world, n=200, seed=0, first=0):
    return world.observe(
        np.arange(first, first + n), np.random.default_rng(seed), np.random.default_rng(seed + 1)
    )


def test_a_sighting_is_that_of_the_plant_at_the_drawn_pose():
    world = PlanarWorld(NORMAL)
    seen = observed(world)
    joints, eccentricity = world.region.sample(200, np.random.default_rng(0))
    noise = np.random.default_rng(1).standard_normal((200, 2))
    expected = NORMAL.sight(NORMAL.tips(joints), eccentricity, noise)
    np.testing.assert_array_equal(seen.joints, joints)
    np.testing.assert_array_equal([seen.pointing, seen.range, seen.eccentricity], expected)
    np.testing.assert_array_equal(seen.time, np.arange(200))
    np.testing.assert_array_equal(world.tips(joints, np.arange(200)), NORMAL.tips(joints))


def test_noise_and_poses_are_streams_of_their_own():
    noisy, quiet = PlanarWorld(NORMAL), PlanarWorld(NORMAL.without_noise())
    np.testing.assert_array_equal(observed(noisy).joints, observed(quiet).joints)
    np.testing.assert_array_equal(observed(noisy).pointing, observed(quiet).pointing)
    other_noise = noisy.observe(np.arange(200), np.random.default_rng(0), np.random.default_rng(99))
    np.testing.assert_array_equal(other_noise.joints, observed(noisy).joints)
    assert not np.any(other_noise.range == observed(noisy).range)


@pytest.mark.parametrize("foveate", [False, True])
def test_trials_are_the_same_observed_at_once_or_in_parts(foveate):
    world = PlanarWorld(NORMAL, foveate=foveate, drift=OffsetStep("gamma", 0.1, at=6))
    whole = observed(world, 10)
    poses, noise = np.random.default_rng(0), np.random.default_rng(1)
    parts = [world.observe(np.arange(a, b), poses, noise) for a, b in [(0, 4), (4, 4), (4, 10)]]
    for name in ("time", "joints", "pointing", "range", "eccentricity"):
        pieces = [getattr(part, name) for part in parts]
        np.testing.assert_array_equal(getattr(whole, name), np.concatenate(pieces))


def test_a_foveating_eye_measures_the_hand_straight_ahead():
    seen = observed(PlanarWorld(NORMAL, foveate=True))
    assert np.abs(seen.eccentricity).max() < 1e-7
    # What the loop cannot see, the noise of the eccentricity, turns the head instead.
    straight = PlanarWorld(NORMAL.without_noise(), foveate=True)
    turned = seen.pointing - observed(straight).pointing
    slope = float(NORMAL.head.eccentricity_std(np.array(0.0)))
    noise = np.random.default_rng(1).standard_normal((200, 2))
    np.testing.assert_allclose(turned, slope * noise[:, 1], atol=0.03 * slope)
    assert np.abs(observed(straight).eccentricity).max() == 0.0


def test_joints_and_range_do_not_depend_on_foveation():
    quiet = NORMAL.without_noise()
    plain = replace(quiet, head=replace(quiet.head, eccentricity_warp=0.0))
    beside, ahead = observed(PlanarWorld(plain)), observed(PlanarWorld(plain, foveate=True))
    np.testing.assert_array_equal(beside.joints, ahead.joints)
    np.testing.assert_allclose(beside.range, ahead.range, rtol=1e-14)
