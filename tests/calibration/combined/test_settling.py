"""All rows of a log at once: order, parts that changed, and what comes afterwards."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tests.calibration.arm.arms import NOISE, SHEET, errors_of, model, sightings

from handeye.calibration.arm.kernels import waves
from handeye.calibration.arm.log_system import Jump
from handeye.calibration.arm.sheet import CurveTerms
from handeye.calibration.combined import combined_from_arrays, combined_to_arrays
from handeye.calibration.combined.settling import settle
from handeye.calibration.storage import load_model, save_model

pytest.importorskip("pinocchio")
PLACED = model(noise=1e-4)
X = errors_of(PLACED, 3)
N = 90
SEEN = sightings(PLACED, X, N, 3)
ZERO = 12 + 8 * 2 + 5  # of the third joint


def fresh(x, n=60) -> Any:
    joints = np.random.default_rng(8).uniform(PLACED.low, PLACED.high, (n, 6))
    return sightings(PLACED, x, n, joints=joints, noise=0.0)


def miss(calibrator, seen) -> float:
    return float(np.linalg.norm(calibrator.errors(seen), axis=1).mean())


def waved(kernel, joints):
    out = np.empty((len(kernel.terms), 2))
    waves(kernel, joints, out)
    return out


@pytest.fixture(scope="module")
def settled():
    return settle(PLACED, SEEN, SHEET)


def test_an_arm_is_known_about_as_well_as_it_is_seen(settled):
    assert miss(settled.calibrator, fresh(X)) < 3.0 * NOISE
    assert miss(settled.rigid, fresh(X)) > 2.0 * miss(settled.calibrator, fresh(X))
    assert settled.calibrator.n_observations == N
    assert "90 observations, all of them fitted at once" in settled.calibrator.health()


def test_the_order_of_the_rows_changes_nothing_to_the_last_bit(settled):
    order = np.random.default_rng(1).permutation(N)
    other = settle(PLACED, SEEN[order], SHEET)
    np.testing.assert_array_equal(other.calibrator.engine.x, settled.calibrator.engine.x)
    for name in ("roots", "olds", "d"):
        pair = (getattr(s.calibrator.engine.bank, name) for s in (other, settled))
        np.testing.assert_array_equal(*pair)
    np.testing.assert_array_equal(other.believed, settled.believed[order])


def test_standard_deviations_cover_what_is_missed(settled):
    calibrator, seen = settled.calibrator, fresh(X)
    covariance = calibrator.covariance(seen.target)
    errors = calibrator.errors(seen)
    squares = np.einsum("ni,nij,nj->n", errors, np.linalg.inv(covariance), errors)
    assert 0.2 < squares.mean() / 3.0 < 4.0


def test_wild_rows_are_not_believed_and_hardly_matter(settled):
    position = SEEN.position.copy()
    wild = np.random.default_rng(2).choice(N, 9, replace=False)
    position[wild] += 0.05
    found = settle(PLACED, replace(SEEN, position=position), SHEET)
    assert set(np.flatnonzero(~found.believed)) == set(wild)
    assert miss(found.calibrator, fresh(X)) < 1.5 * miss(settled.calibrator, fresh(X))


def test_a_part_that_changed_is_told_apart(settled):
    slipped = X.copy()
    slipped[ZERO] += 5e-3
    at = N - 12
    late = sightings(PLACED, slipped, N, 3)
    join = [np.concatenate([a[:at], b[at:]]) for a, b in (
        (SEEN.position, late.position), (SEEN.orientation, late.orientation),
    )]  # fmt: skip
    seen = replace(SEEN, position=join[0], orientation=join[1])
    found = settle(PLACED, seen, SHEET, jumps=[Jump(at, (ZERO,))])
    # Twelve rows alone could not tell the rest of the arm: those before do.
    known = miss(found.calibrator, fresh(slipped))
    assert known < 2.0 * miss(settled.calibrator, fresh(X))
    assert miss(settle(PLACED, seen, SHEET).calibrator, fresh(slipped)) > 5.0 * known
    assert miss(settle(PLACED, seen[at:], SHEET).calibrator, fresh(slipped)) > 2.0 * known


def test_it_goes_on_learning_from_there(settled):
    calibrator = settle(PLACED, SEEN, SHEET).calibrator
    more = sightings(PLACED, X, 40, 4)
    before = miss(settled.calibrator, fresh(X))
    calibrator.observe_many(more)
    assert calibrator.n_observations == N + 40
    assert miss(calibrator, fresh(X)) < 1.05 * before
    assert all(event.observation >= N for event in calibrator.events)


def test_what_was_stored_is_the_same(settled):
    calibrator = settled.calibrator
    arrays, settings = combined_to_arrays(calibrator)
    again = combined_from_arrays(calibrator.model, arrays, settings)
    np.testing.assert_array_equal(again.errors(SEEN), calibrator.errors(SEEN))
    assert again.n_observations == N
    assert again.health() == calibrator.health()


def test_a_sheet_without_curves_has_none(settled):
    found = settle(PLACED, SEEN, replace(SHEET, curves=CurveTerms(0, 0)))
    assert found.calibrator is found.rigid
    np.testing.assert_array_equal(found.rigid.engine.x, settled.rigid.engine.x)


def test_beyond_the_readings_that_were_seen_curves_keep_the_value_of_the_edge(tmp_path):
    joints = np.random.default_rng(4).uniform(PLACED.low, PLACED.high, (150, 6))
    middle, half = 0.5 * (PLACED.low[1] + PLACED.high[1]), 0.25 * (PLACED.high[1] - PLACED.low[1])
    joints[:, 1] = middle + half * np.random.default_rng(5).uniform(-1.0, 1.0, 150)
    seen = sightings(PLACED, X, 150, joints=joints)
    found = settle(PLACED, seen, SHEET)
    robot: Any = found.calibrator.robot
    low, high = joints.min(axis=0), joints.max(axis=0)
    np.testing.assert_allclose([robot.kernel.low, robot.kernel.high], [low, high], atol=1e-12)
    inside, beyond = np.tile(joints[0], (2, 1)), np.tile(joints[0], (2, 1))
    inside[:, 1], beyond[:, 1] = (low[1], high[1]), (low[1] - 1.0, high[1] + 1.0)
    for at_edge, outside in zip(inside, beyond, strict=True):
        np.testing.assert_array_equal(waved(robot.kernel, at_edge), waved(robot.kernel, outside))
    far = fresh(X)
    assert np.any((far.joints < low) | (far.joints > high), axis=1).mean() > 0.3
    assert miss(found.calibrator, far) < miss(found.rigid, far)
    save_model(tmp_path / "arm", found.calibrator, 150)
    again: Any = load_model(tmp_path / "arm").calibrator
    np.testing.assert_array_equal(again.robot.kernel.low, robot.kernel.low)
    np.testing.assert_array_equal(again.errors(far), found.calibrator.errors(far))
