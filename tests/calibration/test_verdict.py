"""Which number is to be trusted, and which rows do not fit the others."""

from dataclasses import replace
from math import radians
from typing import Any

import numpy as np
import pytest
from tests.calibration.cases import CASES, sightings

from handeye.calibration.calibrators import Nominal
from handeye.calibration.drift import Thermal
from handeye.calibration.influence import influence
from handeye.calibration.log_run import calibrate_log
from handeye.calibration.placed import Method
from handeye.calibration.results import CalibrationResult, HeldOut, Influence
from handeye.calibration.verdict import verdict
from handeye.io.records import Log
from handeye.thesis.plants import NOMINAL

N = 90


def run(**changes) -> CalibrationResult:
    """A run whose held-out error is 2, and 3 just before a row is learned."""
    rows = np.arange(N)
    parts = rows * 5 // N
    values: dict[str, Any] = {
        "robot": "arm",
        "log": "run.csv",
        "method": "combined",
        "joint_names": ("a",),
        "joints": np.zeros((N, 1)),
        "positions": np.zeros((N, 3)),
        "before": np.full((N, 1), 5.0),
        "online": np.full((N, 1), 3.0),
        "n_neurons": None,
        "held_out": HeldOut(rows, np.full((N, 1), 5.0), np.full((N, 1), 2.0), parts),
        "rejected": (),
        "settings": {},
        "rows": np.arange(N) + 2,
    }
    return CalibrationResult(**values | changes)


def test_held_out_rows_count_where_the_robot_stood_still():
    judged = verdict(run())
    assert judged.by == "held_out"
    assert judged.summary_after.mean == 2.0
    assert judged.summary_before.mean == 5.0
    assert judged.advice == (
        "trust the held-out rows: each was predicted from the other blocks of time alone"
    )


def test_wild_rows_are_counted_apart_where_they_decide_the_mean():
    held = run().held_out
    assert held is not None
    after, wild = held.after.copy(), np.zeros(N, np.bool_)
    wild[[3, 50, 60]] = True
    after[wild] = 90.0
    pulled = Influence(np.zeros(N), np.zeros(N), wild)
    spoilt = replace(held, after=after)
    advice = verdict(run(held_out=spoilt, influence=pulled)).advice
    assert advice.endswith(
        "3 of these rows are not believed; the mean error of the others is 2e+03 mm"
    )
    # Where they decide nothing, nothing is said.
    assert "believed" not in verdict(run(influence=pulled)).advice
    assert "believed" not in verdict(run(held_out=spoilt)).advice


def test_what_is_wrong_with_the_log_comes_first():
    advice = verdict(run(suspects=("joint a seems to have the other sign",))).advice
    assert advice.startswith(
        "the log does not fit this arm: joint a seems to have the other sign; correct it and "
    )
    assert "trust the held-out rows" in advice


def test_after_a_change_its_row_is_named():
    held = run().held_out
    assert held is not None
    late = replace(
        held, rows=held.rows[40:], before=held.before[40:], after=held.after[40:],
        parts=held.parts[40:],
    )  # fmt: skip
    judged = verdict(run(held_out=late, since=40))
    assert judged.by == "held_out"
    assert "since the robot changed at row 42" in judged.advice
    assert judged.where == "50 observations held out since the robot changed"


def test_too_few_rows_after_a_change_are_judged_before_they_are_learned():
    judged = verdict(run(held_out=None, since=80))
    assert judged.by == "online"
    np.testing.assert_array_equal(judged.rows, np.arange(80, N))
    assert "too few came after the robot changed at row 82" in judged.advice


@pytest.mark.parametrize(("online", "by"), [(1.0, "online"), (3.0, "held_out")])
def test_while_the_robot_drifts_the_smaller_error_counts(online, by):
    judged = verdict(run(drifting=True, online=np.full((N, 1), online)))
    assert judged.by == by
    assert ("drifting" in judged.advice) == (by == "online")


def test_without_held_out_rows_the_last_third_counts():
    judged = verdict(run(held_out=None))
    np.testing.assert_array_equal(judged.rows, np.arange(60, N))
    assert judged.summary_after.mean == 3.0
    assert "none was held out" in judged.advice
    assert judged.summary_after.interval == (3.0, 3.0)


@pytest.mark.parametrize(("online", "said"), [(1.3, True), (1.4, False)])
def test_a_much_smaller_error_before_learning_is_remarked_on(online, said):
    judged = verdict(run(online=np.full((N, 1), online)))
    assert judged.by == "held_out"
    assert ("neighbouring rows are alike" in judged.advice) == said


def test_a_random_third_is_called_flattering():
    held = run().held_out
    assert held is not None
    judged = verdict(run(held_out=replace(held, how="random", parts=np.zeros(N, np.int64))))
    assert "flatters" in judged.advice
    # Its rows are taken as independent of each other: every error is 2, so the mean is certain.
    assert judged.summary_after.interval == (2.0, 2.0)


def test_the_robot_of_the_thesis_that_warms_and_cools_is_judged_before_it_is_learned():
    seen = sightings(n=240, drift=Thermal(150.0))
    log = Log("run.csv", ("alpha", "beta"), seen, np.arange(240) + 2)
    method: Method = "combined"
    result = calibrate_log(log, NOMINAL, method=method, validate="random").result
    assert result.drifting
    assert verdict(result).by == "online"


def test_influence_is_the_error_over_an_ordinary_one():
    case = CASES[-1]
    nominal, seen = Nominal(case.model), case.seen
    lengths = np.linalg.norm(nominal.errors(seen), axis=1)
    found = influence(nominal, seen, None, since=10)
    np.testing.assert_array_equal(found.residual[10:], lengths[10:])
    np.testing.assert_allclose(found.times[10:], lengths[10:] / np.median(lengths[10:]))
    assert np.all(np.isnan(found.residual[:10]))
    assert found.worst(3)[0] == 10 + np.argmax(lengths[10:])
    assert not np.any(found.worst(60)[:50] < 10)
    rows = np.array([20, 30])
    held = HeldOut(rows, np.ones((2, 3)), np.array([[0, 0, 3.0], [0, 4.0, 0]]), rows)
    found = influence(nominal, seen, held)
    np.testing.assert_array_equal(found.residual[rows], [3.0, 4.0])
    np.testing.assert_allclose(found.times[rows], [3.0 / 3.5, 4.0 / 3.5])


def test_a_row_that_states_a_large_deviation_may_err_more():
    case = CASES[-1]
    nominal = Nominal(case.model)
    lengths = np.linalg.norm(nominal.errors(case.seen), axis=1)
    s = np.median(lengths) / 1.538  # median length of a vector of three unit normal components
    std = np.full((60, 3), 0.2 * s)
    std[5] = 10.0 * s
    found = influence(nominal, replace(case.seen, position_std=std), None)
    own = s**2 - (0.2 * s) ** 2
    np.testing.assert_allclose(
        found.times, lengths / (1.538 * np.sqrt(own + std[:, 0] ** 2)), rtol=1e-9
    )


def test_wrong_rows_are_found():
    seen = sightings(n=150)
    pointing = seen.pointing.copy()
    pointing[[40, 111]] += radians(20.0)
    log = Log("run.csv", ("alpha", "beta"), replace(seen, pointing=pointing), np.arange(150) + 2)
    found = calibrate_log(log, NOMINAL, method="combined").result.influence
    assert found is not None
    assert set(found.worst(2)) == {40, 111}
    assert found.left_out[111]
    assert found.times[40] > 10.0
    assert np.count_nonzero(found.left_out) < 6
