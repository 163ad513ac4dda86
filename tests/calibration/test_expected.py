"""How far the hand is expected to miss: what is said beforehand is what happens."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tests.calibration.cases import CASES
from tests.calibration.cases import sightings as planar_sightings
from tests.reports.made_up import ur_run

from handeye.calibration.calibrators import NetworkCorrection, Nominal
from handeye.calibration.combined import Combined
from handeye.calibration.expected import (
    expected_at,
    expected_at_rows,
    expected_summary,
    stretch,
    workspace,
)
from handeye.calibration.influence import influence
from handeye.calibration.models import PlanarModel
from handeye.calibration.results import HeldOut, Workspace
from handeye.thesis.plants import NOMINAL

pytest.importorskip("pinocchio")
from tests.calibration.arm.arms import (
    NOISE,
    SHEET,
    errors_of,
    kernel_of,
    model,
    poses_of,
    sightings,
    taught,
)

from handeye.calibration.arm import ArmEstimator


def size(vectors):
    """Root mean square length."""
    return float(np.sqrt(np.mean(np.sum(vectors**2, axis=-1))))


def joints_of(placed, n, seed=3):
    return np.random.default_rng(seed).uniform(placed.low, placed.high, (n, len(placed.low)))


def test_before_any_row_it_is_what_tolerances_allow():
    """The mean of many robots within tolerances, each at the same three postures."""
    placed = model()
    calibrator, joints = Combined(placed, SHEET), joints_of(placed, 3)
    expected = expected_at(calibrator, joints)
    assert expected is not None
    std = SHEET.tolerances(kernel_of(placed, SHEET))
    rng = np.random.default_rng(8)
    nominal = poses_of(placed, np.zeros_like(std), joints)[:, :, 3]
    there = [poses_of(placed, std * rng.normal(size=len(std)), joints)[:, :, 3] for _ in range(600)]
    squares = np.mean(np.sum((np.array(there) - nominal) ** 2, axis=2), axis=0)
    left = 3.0 * calibrator.engine.doubt**2
    np.testing.assert_allclose(expected**2, squares + left, rtol=0.15)


def test_held_out_errors_are_as_large_as_expected():
    placed, learned = model(), taught()
    test = sightings(placed, errors_of(placed, 0), 300, 77)
    expected = expected_at_rows(learned, test)
    assert expected is not None
    assert 0.6 < size(learned.errors(test)) / size(expected[:, np.newaxis]) < 1.4


def test_a_noisier_row_is_expected_to_err_more():
    placed, learned = model(), taught()
    test = sightings(placed, errors_of(placed, 0), 5, 77)
    noisy = replace(test, position_std=np.full((5, 3), 1e-3))
    pair = [expected_at_rows(learned, seen) for seen in (test, noisy)]
    assert pair[0] is not None
    assert pair[1] is not None
    np.testing.assert_allclose(pair[1] ** 2 - pair[0] ** 2, 3.0 * (1e-6 - NOISE**2), rtol=1e-6)


def test_rows_and_joints_say_the_same_for_an_exact_sensor():
    placed, learned = model(), taught()
    test = sightings(placed, errors_of(placed, 0), 20, 77)
    exact = replace(test, position_std=np.zeros((20, 3)))
    at_rows, at_joints = expected_at_rows(learned, exact), expected_at(learned, test.joints)
    assert at_rows is not None
    assert at_joints is not None
    np.testing.assert_allclose(at_rows, at_joints, rtol=1e-9)


def test_more_rows_make_it_more_certain_and_elsewhere_it_is_less():
    placed = model()
    narrow = replace(placed, low=0.5 * placed.low, high=0.5 * placed.high)
    x, joints = errors_of(placed), joints_of(narrow, 80, 4)
    estimator, few = ArmEstimator(narrow, SHEET), ArmEstimator(narrow, SHEET)
    estimator.observe_many(sightings(placed, x, 80, joints=joints))
    few.observe_many(sightings(placed, x, 25, joints=joints[:25]))
    inside, outside = joints_of(narrow, 60, 5), joints_of(placed, 60, 6)
    here, there, before = (
        expected_at(*each) for each in ((estimator, inside), (estimator, outside), (few, inside))
    )
    assert here is not None
    assert there is not None
    assert before is not None
    assert 1.3 * np.median(here) < np.median(there)
    assert 1.1 * np.median(here) < np.median(before)


def test_the_workspace_keeps_limits_and_knows_where_the_robot_worked():
    learned = taught()
    arm: Any = learned.model.arm
    seen = sightings(model(), errors_of(model()), 50)
    space = workspace(learned, seen, 200)
    assert space is not None
    assert np.all((space.joints >= arm.lower) & (space.joints <= arm.upper))
    # The other way round is the same posture.
    assert np.abs(space.joints).max() <= np.pi
    worked = (space.joints >= learned.model.low) & (space.joints <= learned.model.high)
    np.testing.assert_array_equal(space.worked, worked.all(axis=1))
    assert 100 <= space.worked.sum() < 200
    assert np.median(space.expected[~space.worked]) > np.median(space.expected[space.worked])
    expected = expected_at(learned, space.joints)
    assert expected is not None
    np.testing.assert_array_equal(space.expected, expected)
    marker = learned.model.placement.T_flange_marker[:, 3]
    np.testing.assert_allclose(space.seen, (arm.poses(seen.joints) @ marker)[:, :3])


def test_what_is_expected_is_stretched_where_held_out_rows_err_more():
    rng, rows = np.random.default_rng(8), np.arange(600)
    errors = rng.normal(scale=1e-3, size=(600, 3))

    def held(times):
        expected = np.full(600, np.sqrt(3.0) * 1e-3 / times)
        return HeldOut(rows, errors, errors, rows, expected=expected)

    assert stretch(held(2.5)) == pytest.approx(2.5, rel=0.06)
    assert stretch(held(0.5)) == stretch(None) == 1.0
    wild = errors.copy()
    wild[:60] *= 100.0
    assert stretch(replace(held(2.5), after=wild)) < 1.15 * 2.5
    seen = sightings(model(), errors_of(model()), 50)
    plain, wider = (workspace(taught(), seen, 40, held=one) for one in (None, held(2.5)))
    assert plain is not None
    assert wider is not None
    np.testing.assert_allclose(wider.expected, stretch(held(2.5)) * plain.expected)


def test_who_does_not_know_says_nothing():
    planar = CASES[0]
    for calibrator in (Nominal(planar.model), NetworkCorrection(planar.model)):
        assert expected_at_rows(calibrator, planar.seen) is None
        assert workspace(calibrator, planar.seen) is None
        assert influence(calibrator, planar.seen, None).expected is None
    assert expected_summary(ur_run(n=30, expected=False)) == {}


def test_the_planar_robot_expects_what_happens():
    combined = Combined(PlanarModel(NOMINAL))
    seen = planar_sightings(n=260)
    combined.observe_many(seen[:200])
    expected = expected_at_rows(combined, seen[200:])
    assert expected is not None
    assert 0.6 < size(combined.errors(seen[200:])) / size(expected[:, np.newaxis]) < 1.4
    assert expected_at(combined, seen.joints) is None
    assert workspace(combined, seen) is None


def test_the_summary_states_held_out_rows_beside_what_was_expected():
    result = ur_run(n=60)
    after = np.zeros((4, 3))
    after[:, 0] = [1e-3, 2e-3, 3e-3, 4e-3]
    held = HeldOut(np.arange(4), after, after, np.arange(4), expected=np.full(4, 2e-3))
    space = Workspace(
        np.zeros((4, 6)), np.zeros((4, 3)), np.array([1.0, 2.0, 3.0, 9.0]) * 1e-3,
        np.array([True, True, True, False]), np.zeros((1, 3)),
    )  # fmt: skip
    found = expected_summary(replace(result, held_out=held, workspace=space))
    # 95 % of lengths of normal vectors in space stay below 1.614 times their root mean square.
    assert found["held_out"]["within"] == 0.75
    assert found["held_out"]["found_rms"] == pytest.approx(np.sqrt(7.5) * 1e-3)
    assert found["held_out"]["expected_rms"] == pytest.approx(2e-3)
    assert found["working_range"] == pytest.approx(
        {"n": 3, "median": 2e-3, "p95": 2.9e-3, "max": 3e-3}
    )
    assert found["elsewhere"]["median"] == pytest.approx(9e-3)


def test_a_row_is_judged_by_who_has_not_seen_it():
    planar = Combined(PlanarModel(NOMINAL))
    seen = planar_sightings(n=40)
    planar.observe_many(seen)
    rows, own = np.array([3, 5]), expected_at_rows(planar, seen)
    held = HeldOut(rows, np.ones((2, 2)), np.ones((2, 2)), rows, expected=np.array([7.0, 8.0]))
    found = influence(planar, seen, held).expected
    assert found is not None
    assert own is not None
    np.testing.assert_array_equal(found[rows], [7.0, 8.0])
    np.testing.assert_array_equal(np.delete(found, rows), np.delete(own, rows))
