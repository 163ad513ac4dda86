"""Rows that are held out: which, that they teach nothing, and what is said of them."""

from dataclasses import replace
from math import radians
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import t
from tests.calibration.cases import CASES, sightings

from handeye.calibration.calibrators import NetworkCorrection, Nominal
from handeye.calibration.drift import OffsetStep
from handeye.calibration.log_run import calibrate_log
from handeye.calibration.placed import Method
from handeye.calibration.results import ErrorSummary
from handeye.calibration.validation import BLOCKS, left_out, to_learn, turn_errors
from handeye.errors import InvalidInput
from handeye.geometry import matrix_from_wxyz, wxyz_from_matrix
from handeye.intervals import mean_interval
from handeye.io.records import Log
from handeye.randomness import stream
from handeye.thesis.plants import NOMINAL

N = 60
UR10 = next((case for case in CASES if case.name == "ur10"), None)


def log_of(seen) -> Any:
    return Log("run.csv", ("alpha", "beta"), seen, np.arange(2, len(seen) + 2))


def calibrated(log, robot=NOMINAL, *, method: Method = "network", **settings) -> Any:
    return calibrate_log(log, robot, method=method, **settings)


def held(log, **settings) -> Any:
    return calibrated(log, **settings).result.held_out


@pytest.fixture(scope="module")
def log():
    return log_of(sightings(n=N))


@given(n=st.integers(5, 200), since=st.integers(0, 190))
def test_blocks_are_contiguous_and_every_row_is_in_one(n, since):
    parts = left_out(n, "blocks", since=since)
    np.testing.assert_array_equal(np.concatenate([[], *parts]), np.arange(since, n))
    assert len(parts) == min(BLOCKS, max(n - since, 0))
    sizes = [len(part) for part in parts]
    assert not sizes or max(sizes) - min(sizes) <= 1
    assert to_learn(n, parts) == sum(n - size for size in sizes)


@given(n=st.integers(9, 60), replicate=st.integers(0, 50), since=st.integers(0, 5))
def test_a_random_third_is_the_one_of_its_replicate(n, replicate, since):
    (rows,) = left_out(n, "random", replicate=replicate, since=since)
    left = n - since
    drawn = since + stream("held out", replicate).permutation(left)[: left // 3]
    np.testing.assert_array_equal(rows, np.sort(drawn))


def test_nothing_or_another_word():
    assert left_out(9, "none") == []
    assert to_learn(9, []) == 0
    word: Any = "some"
    with pytest.raises(InvalidInput, match="blocks, random or none, got 'some'"):
        left_out(9, word)


@pytest.mark.parametrize("validate", ["blocks", "random"])
@pytest.mark.parametrize("method", ["network", "nominal", "combined"])
def test_held_out_rows_take_no_part_in_anything(log, method, validate):
    first = held(log, method=method, validate=validate)
    part = np.flatnonzero(first.parts == first.parts[0])
    victims = first.rows[part[::2]]
    r = log.observations.range.copy()
    r[victims] += 0.3
    spoilt = replace(log, observations=replace(log.observations, range=r))
    second = held(spoilt, method=method, validate=validate)
    np.testing.assert_array_equal(first.rows, second.rows)
    kept, bad = part[1::2], part[::2]
    for before, after in ((first.before, second.before), (first.after, second.after)):
        np.testing.assert_array_equal(before[kept], after[kept])
        assert not np.any(before[bad] == after[bad])


def test_rows_of_other_blocks_do_take_part(log):
    first = held(log)
    last = first.parts == BLOCKS - 1
    r = log.observations.range.copy()
    r[first.rows[~last][:5]] += 0.05
    spoilt = replace(log, observations=replace(log.observations, range=r))
    assert not np.any(first.after[last] == held(spoilt).after[last])


def test_held_out_errors_are_those_of_a_calibrator_that_learned_the_others(log):
    found, seen = held(log), log.observations
    np.testing.assert_array_equal(found.rows, np.arange(N))
    whole = calibrated(log).calibrator
    for part in range(BLOCKS):
        rows = found.rows[found.parts == part]
        others = np.setdiff1d(np.arange(N), rows)
        learner = calibrated(log_of(seen[others]), validate="none").calibrator
        test = seen[rows]
        tips = learner.model.nominal.tips
        for errors, calibrator in ((found.after, learner), (found.before, Nominal(learner.model))):
            miss = tips(test.joints) - tips(calibrator.command(test.target))
            np.testing.assert_allclose(errors[rows], miss, atol=1e-12)
        apart = learner.errors(seen) - whole.errors(seen)
        np.testing.assert_allclose(
            found.moves[part], np.mean(np.hypot(apart[:, 0], apart[:, 1])), rtol=1e-12
        )


def test_learning_nothing_changes_nothing(log):
    run = calibrated(log, method="nominal")
    assert isinstance(run.calibrator, Nominal)
    np.testing.assert_array_equal(run.result.before, run.result.online)
    np.testing.assert_array_equal(run.result.held_out.before, run.result.held_out.after)
    assert run.result.n_neurons is None


def test_without_validation_there_are_no_held_out_rows(log):
    result = calibrated(log, validate="none").result
    assert result.held_out is None
    assert set(result.summary()) == {"before", "online"}


@settings(max_examples=8)
@given(
    seed=st.integers(0, 1000), method=st.sampled_from(["network", "combined"]), ties=st.booleans()
)
def test_the_order_of_the_rows_in_the_log_changes_nothing(log, seed, method, ties):
    if ties:
        log = replace(log, observations=replace(log.observations, time=np.arange(N) // 2))
    order = np.random.default_rng(seed).permutation(N)
    other = replace(log, observations=log.observations[order], rows=log.rows[order])
    first, second = calibrated(log, method=method), calibrated(other, method=method)
    assert first.result.summary() == second.result.summary()
    assert first.result.settings == second.result.settings
    assert first.result.findings == second.result.findings
    for name in ("joints", "before", "online", "rows", "times"):
        np.testing.assert_array_equal(getattr(first.result, name), getattr(second.result, name))
    for name in ("residual", "times", "left_out"):
        pair = (getattr(run.result.influence, name) for run in (first, second))
        np.testing.assert_array_equal(*pair)
    target = log.observations.target
    np.testing.assert_array_equal(
        first.calibrator.command(target), second.calibrator.command(target)
    )


def test_blocks_of_a_robot_that_slipped_are_judged_by_what_fits_their_time():
    slipped = sightings(n=240, drift=OffsetStep("alpha", radians(2.0), at=120))
    result = calibrated(log_of(slipped), method="combined").result
    assert 120 <= result.since <= 123
    assert result.held_out.rows.tolist() == list(range(result.since, 240))
    after = ErrorSummary.of(result.held_out.after).mean
    steady = calibrated(log_of(sightings(n=240)), method="combined").result.held_out
    same = ErrorSummary.of(steady.after[result.since :]).mean
    assert after < 1.3 * same
    assert ErrorSummary.of(result.before[result.since :]).mean > 4.0 * after


def test_too_few_rows_after_a_slip_are_not_held_out():
    slipped = sightings(n=200, drift=OffsetStep("alpha", radians(2.0), at=185))
    result = calibrated(log_of(slipped), method="combined").result
    assert 185 <= result.since <= 188
    assert result.held_out is None


@given(st.lists(st.floats(0.1, 5.0), min_size=2, max_size=9), st.floats(0.0, 5.0))
def test_the_interval_of_a_mean_is_students(means, mean):
    parts = np.array(means)
    low, high = mean_interval(mean, means)
    scale = parts.std(ddof=1) / np.sqrt(len(parts))
    half = t.ppf(0.975, len(parts) - 1) * scale
    np.testing.assert_allclose([low, high], [max(mean - half, 0.0), mean + half], atol=1e-12)


def test_the_interval_counts_blocks_not_rows():
    errors = np.repeat([[1.0], [2.0], [3.0]], 100, axis=0)
    blocks = np.repeat([0, 1, 2], 100)
    low, high = ErrorSummary.of(errors, blocks).interval or (0.0, 0.0)
    half = t.ppf(0.975, 2) / np.sqrt(3.0)
    np.testing.assert_allclose([low, high], [max(2.0 - half, 0.0), 2.0 + half])
    assert ErrorSummary.of(errors).interval is None
    assert ErrorSummary.of(errors, np.zeros(300, np.int64)).interval is None


@pytest.mark.skipif(UR10 is None, reason="needs pinocchio")
def test_orientation_errors_are_the_turns_to_what_was_measured():
    assert UR10 is not None
    model, seen = UR10.exact
    placement = model.placement
    T = placement.T_sensor_base @ model.arm.poses(seen.joints) @ placement.T_flange_marker
    turn = np.array([0.0, 0.0, 0.02])
    off = matrix_from_wxyz([np.cos(0.01), 0.0, 0.0, np.sin(0.01)])
    turned = replace(seen, orientation=wxyz_from_matrix(T[:, :3, :3] @ off))
    np.testing.assert_allclose(model.turn_errors(turned), np.tile(turn, (len(seen), 1)), atol=1e-9)
    assert model.turn_errors(seen) is None
    found = calibrated(log_of(turned), model.arm, method="nominal").result.held_out
    # The marker's own turn is learned from the other rows, so nothing is left.
    np.testing.assert_allclose(found.turns_after, 0.0, atol=1e-6)
    assert turn_errors(NetworkCorrection(model), turned) is not None
    assert turn_errors(NetworkCorrection(CASES[0].model), CASES[0].seen) is None
