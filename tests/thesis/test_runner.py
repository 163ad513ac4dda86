import os

import numpy as np
import pytest

from handeye.errors import InvalidInput
from handeye.randomness import stream
from handeye.thesis.experiment import Curve, Effort, Experiment, Quantities
from handeye.thesis.runner import WorkerLost, run


def draw(scale: float, replicate: int, effort: Effort) -> Quantities:
    rng = stream("test: draw", replicate)
    n = effort.of(10)
    return {
        "value": scale * rng.random(),
        "walk": Curve(np.arange(n, dtype=np.float64), rng.random(n)),
    }


def fail(setting: str, replicate: int, effort: Effort) -> Quantities:  # noqa: ARG001 (as every measure)
    if replicate == 1:
        raise InvalidInput("too much")
    return {"value": 0.0}


def die(setting: str, replicate: int, effort: Effort) -> Quantities:  # noqa: ARG001 (as every measure)
    os._exit(1)


DRAW = Experiment("draw", {"one": 1.0, "two": 2.0}, draw, replicates=3)
FIXED = Experiment("fixed", {"one": 1.0}, draw, deterministic=True)
FAIL = Experiment("fail", {"only": ""}, fail, replicates=3)


def test_records_are_the_same_in_any_number_of_processes():
    alone = run([DRAW, FIXED], jobs=1)
    assert run([DRAW, FIXED], jobs=3).rows == alone.rows
    assert run([DRAW, FIXED], jobs=1).rows == alone.rows


def test_rows_come_by_experiment_setting_and_replicate():
    rows = [row for row in run([DRAW, FIXED], jobs=1).rows if row.quantity == "value"]
    assert [(r.experiment, r.setting, r.replicate) for r in rows] == [
        *[("draw", setting, i) for setting in ("one", "two") for i in range(3)],
        ("fixed", "one", 0),
    ]


def test_settings_meet_the_same_random_numbers_and_replicates_others():
    records = run([DRAW], jobs=1)
    one, two = records.values("draw/one/value"), records.values("draw/two/value")
    np.testing.assert_array_equal(two, 2.0 * one)
    assert len(set(one.tolist())) == 3


def test_more_replicates_leave_the_first_as_they_were():
    few, more = (run([DRAW], replicates=n, jobs=1).values("draw/one/value") for n in (2, 5))
    np.testing.assert_array_equal(few, more[:2])
    assert len(more) == 5


def test_deterministic_experiments_run_once():
    assert len(run([FIXED], replicates=9, jobs=1).values("fixed/one/value")) == 1


def test_effort_makes_experiments_smaller():
    at, _ = run([DRAW], jobs=1, effort=Effort(0.5)).curve("draw/one/walk")
    assert len(at) == 5
    assert Effort(0.001).of(1000) == 2
    assert Effort(0.001).of(1000, least=1) == 1
    assert Effort().of(1000) == 1000


@pytest.mark.parametrize("jobs", [1, 2])
def test_progress_goes_from_none_to_all(jobs: int):
    told: list[tuple[int, int]] = []
    run([DRAW, FIXED], jobs=jobs, progress=lambda done, total: told.append((done, total)))
    assert told == [(done, 7) for done in range(8)]


@pytest.mark.parametrize("jobs", [1, 2])
def test_an_error_says_where_it_happened(jobs: int):
    with pytest.raises(InvalidInput, match="too much") as caught:
        run([FAIL], jobs=jobs)
    assert caught.value.__notes__ == ["in experiment fail, setting only, replicate 1"]


def test_a_lost_process_is_an_error_with_advice():
    with pytest.raises(WorkerLost, match="jobs=1"):
        run([Experiment("die", {"only": ""}, die)], replicates=2, jobs=2)


def test_numbers_below_one_are_refused():
    with pytest.raises(InvalidInput, match="jobs must be a whole number of at least 1"):
        run([DRAW], jobs=0)
    with pytest.raises(InvalidInput, match="replicates must be a whole number of at least 1"):
        run([DRAW], replicates=0)
