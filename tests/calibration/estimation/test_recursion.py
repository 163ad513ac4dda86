"""The square-root information filter against dense matrices, written the slow way."""

import numpy as np
import pytest
from tests.calibration.cases import sightings as world_sightings

from handeye.calibration.estimation import NAMES, THESIS, Assumptions, fit_plant
from handeye.calibration.estimation.kernels import residual_rows
from handeye.calibration.estimation.losses import LOSSES
from handeye.calibration.estimation.objectives import sightings
from handeye.calibration.estimation.parameters import indices, vector
from handeye.calibration.estimation.recursion import (
    Rules,
    ignorance,
    learn_stream,
    noticeable,
    parameters_at,
)
from handeye.thesis.plants import NOMINAL, NORMAL

KNOWN = Assumptions()


def rules_of(free=THESIS, loss="squared", drift=0.0, scale=2.0):
    places = indices(free)
    tolerances = KNOWN.tolerances.std()[places]
    seen = noticeable(vector(NOMINAL), places, tolerances)
    return Rules(vector(NOMINAL), tolerances, places, seen, LOSSES.index(loss), scale, drift)


def learned(rules, rows, belief=None):
    belief = belief or ignorance(len(rules.free))
    before = np.empty((len(rows), 8))
    learn_stream(rules, belief, rows, before)
    return belief, before


def slow(rules, rows):
    """Information matrix and estimate by iterated Gauss-Newton with dense matrices."""
    n = len(rules.free)
    information, d = np.eye(n), np.zeros(n)
    for row in rows:
        phi2 = 1.0 - rules.drift**2
        covariance = phi2 * np.linalg.inv(information) + rules.drift**2 * np.eye(n)
        information = np.linalg.inv(covariance)
        prior = np.sqrt(phi2) * d
        d = prior
        weights = None
        for _ in range(8):
            p = rules.nominal.copy()
            p[rules.free] += rules.tolerances * d
            values, slopes = np.empty(2), np.empty((2, 8))
            residual_rows(p, row[np.newaxis], values, slopes)
            J = slopes[:, rules.free] * rules.tolerances @ rules.seen
            if weights is None:
                z = values / np.sqrt(1.0 + np.diag(J @ covariance @ J.T)) / rules.scale
                weights = 1.0 / np.sqrt(1.0 + z**2) if rules.loss == 1 else np.ones(2)
            W = np.diag(weights)
            new = information + J.T @ W @ J
            gradient = information @ (d - prior) + J.T @ W @ values
            d = d - np.linalg.solve(new, gradient)
        information = new
    return information, d


@pytest.mark.parametrize("free", [THESIS, NAMES], ids=len)
@pytest.mark.parametrize("loss", ["squared", "soft_l1"])
@pytest.mark.parametrize("drift", [0.0, 0.05])
def test_it_is_the_iterated_information_filter(free, loss, drift):
    rules = rules_of(free, loss, drift)
    rows = sightings(NOMINAL, KNOWN, world_sightings(NORMAL, 12))
    rows[5, 2] += 1.0  # an outlier
    belief, _ = learned(rules, rows)
    information, d = slow(rules, rows)
    np.testing.assert_allclose(belief.R.T @ belief.R, information, rtol=1e-7, atol=1e-5)
    np.testing.assert_allclose(belief.deviations, d, atol=1e-8)
    np.testing.assert_allclose(belief.R @ belief.deviations, belief.z, atol=1e-9)


def test_it_reports_the_parameters_as_each_sighting_arrived():
    rules = rules_of()
    rows = sightings(NOMINAL, KNOWN, world_sightings(NORMAL, 6))
    _, before = learned(rules, rows)
    np.testing.assert_array_equal(before[0], vector(NOMINAL))
    for i in range(6):
        part, _ = learned(rules, rows[:i])
        p = np.empty(8)
        parameters_at(rules, part.deviations, p)
        np.testing.assert_array_equal(before[i], p)


def test_without_drift_it_ends_near_the_batch():
    plant = NORMAL.without_perturbations()
    seen = world_sightings(plant, 300)
    known = Assumptions(free=THESIS, loss="squared")
    batch = fit_plant(NOMINAL, seen, assumptions=known)
    rules = rules_of()
    belief, _ = learned(rules, sightings(NOMINAL, known, seen))
    p = np.empty(8)
    parameters_at(rules, belief.deviations, p)
    assert batch.knowledge is not None
    free = indices(THESIS)
    # Early sightings were linearised elsewhere: a fraction of the standard deviation.
    assert (np.abs(p - batch.parameters)[free] < 0.5 * batch.knowledge.std[free]).all()


def test_nothing_is_ever_learned_about_the_gauges():
    rules = rules_of(NAMES, drift=0.01)
    rows = sightings(NOMINAL, KNOWN, world_sightings(NORMAL, 2000))
    belief, _ = learned(rules, rows)
    gauge = np.eye(8) - rules.seen
    assert np.linalg.matrix_rank(gauge) == 2
    np.testing.assert_allclose(gauge @ belief.deviations, 0.0, atol=1e-9)
    np.testing.assert_allclose(gauge @ belief.R.T @ belief.R @ gauge, gauge, atol=1e-6)
    np.testing.assert_allclose(rules_of(THESIS).seen, np.eye(6), atol=1e-15)


def test_what_is_not_seen_stays_as_uncertain_as_the_tolerances_say():
    rules = rules_of(drift=0.3)
    blind = np.tile([0.1, 0.9, 2.5, 0.0, 1e12, 1e12], (200, 1))
    belief, _ = learned(rules, blind)
    np.testing.assert_allclose(belief.R.T @ belief.R, np.eye(6), atol=1e-9)
    np.testing.assert_allclose(belief.deviations, 0.0, atol=1e-9)


def test_an_impossible_result_is_not_taken_over():
    rules = rules_of(loss="squared")
    rows = sightings(NOMINAL, KNOWN, world_sightings(NORMAL, 20))
    belief, _ = learned(rules, rows)
    kept = [part.copy() for part in belief]
    learned(rules, np.array([[0.1, 0.9, -1e9, 0.0, 1e-6, 1e-6]]), belief)
    for part, before in zip(belief, kept, strict=True):
        np.testing.assert_array_equal(part, before)
