"""All rows at once: recovers an arm, in any order of the rows, in spite of wild ones."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from tests.calibration.arm.arms import (
    NOISE,
    SHEET,
    errors_of,
    kernel_of,
    model,
    poses_of,
    sightings,
)

from handeye.arrays import Array
from handeye.calibration.arm import ArmEstimator
from handeye.calibration.arm.groups import prior_groups
from handeye.calibration.arm.sheet import CurveTerms
from handeye.errors import InvalidInput

N = 130
STIFF = replace(SHEET, compliance=0.0, curves=CurveTerms(2, 0))


@cache
def taught(n=N, seed=0, wild=0, shuffled=False):
    placed = model()
    x = errors_of(placed, seed, STIFF)
    seen = sightings(placed, x, n, seed, STIFF)
    if wild:
        position = seen.position.copy()
        position[np.random.default_rng(1).choice(n, wild, replace=False)] += 0.3
        seen = replace(seen, position=position)
    if shuffled:
        seen = seen[np.random.default_rng(2).permutation(n)]
    estimator = ArmEstimator(placed, STIFF)
    estimator.observe_many(seen)
    return estimator, x


def misses(estimator, x) -> Array:
    """Of predicted from true positions at fresh joints, (M, 3)."""
    placed = model()
    joints = np.random.default_rng(9).uniform(placed.low, placed.high, (100, 6))
    fresh = sightings(placed, x, 100, joints=joints, sheet=STIFF, noise=0.0)
    return estimator.errors(fresh)


def test_an_arm_with_errors_in_every_stage_is_known_better_than_it_is_seen():
    estimator, x = taught()
    nominal = np.linalg.norm(misses(ArmEstimator(model(), STIFF), x), axis=1).mean()
    left = np.linalg.norm(misses(estimator, x), axis=1).mean()
    assert nominal > 1e-3
    assert left < NOISE


def test_wild_rows_hardly_matter_and_are_recognised():
    estimator, x = taught(wild=9)
    assert np.linalg.norm(misses(estimator, x), axis=1).mean() < 1.5 * NOISE
    squares = estimator.posterior().squares[:, 0]
    wild = np.random.default_rng(1).choice(N, 9, replace=False)
    assert set(np.argsort(-squares)[:9]) == set(wild)


def test_the_order_of_rows_does_not_matter():
    a, x = taught()
    b, _ = taught(shuffled=True)
    np.testing.assert_allclose(misses(a, x), misses(b, x), atol=1e-8)


def test_standard_deviations_cover_the_errors():
    scores = []
    for seed in range(3):
        estimator, x = taught(seed=seed)
        scores.append(((estimator.x - x) / estimator.std())[12:])
    assert 0.3 < np.mean(np.square(scores)) < 1.5


def test_one_by_one_is_the_same_as_many():
    placed = model()
    seen = sightings(placed, errors_of(placed, 1, STIFF), 40, 1, STIFF)
    many, one = ArmEstimator(placed, STIFF), ArmEstimator(placed, STIFF)
    errors = many.observe_many(seen).error
    for i in range(40):
        np.testing.assert_allclose(one.observe(seen[i]).error, errors[i], atol=1e-9)
    np.testing.assert_allclose(one.x, many.x, atol=1e-9)


def test_errors_are_reported_before_learning():
    placed = model()
    seen = sightings(placed, errors_of(placed, 1, STIFF), 30, 1, STIFF)
    errors = ArmEstimator(placed, STIFF).observe_many(seen[:24]).error
    np.testing.assert_array_equal(errors, ArmEstimator(placed, STIFF).errors(seen[:24]))


def test_a_command_brings_the_real_hand_to_the_target():
    estimator, x = taught()
    placed = model()
    joints = np.random.default_rng(3).uniform(-1.5, 1.5, (20, 6))
    wanted = sightings(placed, x, 20, joints=joints, sheet=STIFF, noise=0.0)
    found = estimator.command(wanted.target)
    reached = poses_of(placed, x, found, STIFF)[:, :, 3]
    assert np.linalg.norm(reached - wanted.position, axis=1).mean() < 2.0 * NOISE
    np.testing.assert_array_equal(estimator.command(wanted[0].target), found[0])


def test_what_was_restored_goes_on_as_if_nothing_had_happened():
    estimator, x = taught()
    again = ArmEstimator(model(), STIFF)
    again.restore(estimator.seen, estimator.x)
    np.testing.assert_array_equal(again.x, estimator.x)
    np.testing.assert_allclose(misses(again, x), misses(estimator, x), atol=1e-9)
    with pytest.raises(InvalidInput, match="not what this arm learns from"):
        again.restore(estimator.seen[:, :-1], estimator.x)


def test_it_refuses_what_it_cannot_use():
    estimator = ArmEstimator(model(), STIFF)
    seen = sightings(model(), errors_of(model(), 0, STIFF), 3, 0, STIFF)
    with pytest.raises(InvalidInput, match="for N of them use observe_many"):
        estimator.observe(seen)
    with pytest.raises(InvalidInput, match="for one observation use observe"):
        estimator.observe_many(seen[0])
    with pytest.raises(InvalidInput, match="observe first"):
        estimator.posterior()
    np.testing.assert_array_equal(estimator.std(), estimator.robot.chain.tolerance)
    assert estimator.n_observations == 0


def test_groups_hold_alike_things_together():
    kernel = kernel_of(model(), replace(STIFF, curves=CurveTerms(3, 1)))
    groups = prior_groups(kernel)
    n, terms = 6, len(kernel.terms)
    assert len(groups) == 7 * n + 2 * terms
    per_joint = groups[: 7 * n].reshape(n, 7)
    assert (per_joint == per_joint[0]).all()
    assert per_joint[0].tolist() == [0, 0, 0, 1, 1, 2, 3]
    curves = groups[7 * n :].reshape(terms, 2)
    assert (curves[:, 0] == curves[:, 1]).all()
    own = (kernel.terms[:, 0] == 2) & (kernel.terms[:, 1] == 5)
    # Harmonics 1, 2, and 3 with 4.
    assert len(set(curves[own, 0])) == 3
