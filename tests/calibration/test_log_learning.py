"""What became of a robot during a log, and which of what was learned is used in the end."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tests.calibration.arm.arms import SHEET, arm, errors_of, model, sightings

from handeye.calibration.arm.log_system import Jump
from handeye.calibration.calibrators import Nominal
from handeye.calibration.changes import History, history
from handeye.calibration.combined import Combined, Event
from handeye.calibration.contributions import contributions
from handeye.calibration.log_learning import chosen, follows_better
from handeye.calibration.log_run import calibrate_log
from handeye.calibration.results import HeldOut
from handeye.calibration.validation import Learned
from handeye.calibration.verdict import verdict
from handeye.io.records import Log

pytest.importorskip("pinocchio")
ROWS, PARTS = np.arange(50), np.repeat(np.arange(5), 10)


def held(before=5.0, rigid: float | None = 2.0, after: Any = 1.0) -> HeldOut:
    """Errors of fifty rows in five blocks, all alike or one for each block."""

    def errors(size):
        sizes = np.broadcast_to(np.asarray(size, np.float64), (5,))
        return np.repeat(sizes, 10)[:, np.newaxis] * np.array([[1.0, 0.0, 0.0]])

    return HeldOut(
        ROWS, errors(before), errors(after), PARTS,
        rigid=None if rigid is None else errors(rigid),
    )  # fmt: skip


def learned() -> Any:
    placed: Any = SimpleNamespace()
    return Learned(placed, whole(), whole())


def whole() -> Any:
    return SimpleNamespace(falling_back=False)


def test_what_held_out_rows_do_not_speak_against_is_used():
    found, rows = learned(), held()
    picked = chosen(found, rows)
    assert picked.calibrator is found.whole
    assert picked.held is rows
    assert not found.whole.falling_back
    assert chosen(found, None).calibrator is found.whole


def test_error_curves_that_do_worse_than_none_beyond_chance_are_left_away():
    found = learned()
    picked = chosen(found, held(after=[2.4, 2.5, 2.6, 2.4, 2.6]))
    assert picked.calibrator is found.rigid
    assert picked.held is not None
    np.testing.assert_array_equal(picked.held.after, held().rigid)
    # One bad block of five may be chance.
    by_chance = chosen(found, held(after=[1.9, 1.9, 1.9, 1.9, 3.5]))
    assert by_chance.calibrator is found.whole


def test_commands_stay_nominal_where_all_that_was_learned_is_worse():
    found = learned()
    picked = chosen(found, held(before=1.0, rigid=2.0, after=1.5))
    assert picked.calibrator is found.whole
    assert found.whole.falling_back
    assert picked.held is not None
    np.testing.assert_array_equal(picked.held.after, held(before=1.0).before)


@pytest.mark.parametrize(("late", "follows"), [(0.5, True), (1.5, False)])
def test_a_drifting_robot_is_followed_where_that_is_better(late, follows):
    online = np.full((90, 1), 9.0)
    online[60:] = late
    online[-1] = 9.0 if follows else 0.0

    def fitted(rows):
        np.testing.assert_array_equal(rows, np.arange(60, 90))
        return np.full((30, 1), 1.0)

    assert follows_better(online, held(after=1.0), 0, fitted) == follows
    assert follows_better(online, None, 0, fitted) == follows


def events(*told: Event) -> Any:
    calibrator = Combined(model(), SHEET)
    calibrator.engine.events.extend(told)
    return calibrator


ELBOW = "encoder offset of joint elbow_joint"


@pytest.fixture(scope="module")
def changed():
    """Sightings that fit the nominal arm from row 30 on, and not before."""
    placed = model()
    seen = sightings(placed, 0.0 * errors_of(placed), 60)
    position = seen.position.copy()
    position[:30] += 0.01
    return replace(seen, position=position)


def test_parts_that_changed_are_known_by_their_unknowns(changed):
    calibrator = events(
        Event(20, "change", "marker on the flange", ""), Event(30, "change", ELBOW, "")
    )
    found = history(calibrator, changed)
    assert (found.since, found.first) == (30, 0)
    assert found.jumps == (Jump(20, tuple(range(6, 12))), Jump(30, (12 + 2 * 8 + 5,)))


def test_what_was_before_all_was_lost_tells_nothing(changed):
    calibrator = events(
        Event(20, "change", ELBOW, ""), Event(25, "lost", "", ""), Event(30, "change", ELBOW, "")
    )
    found = history(calibrator, changed)
    assert (found.since, found.first) == (30, 25)
    assert [jump.at for jump in found.jumps] == [30]


def test_a_change_that_does_not_matter_is_none(changed):
    assert history(events(Event(15, "change", ELBOW, "")), changed[30:]) == History()
    assert history(events(Event(30, "outlier", "", "")), changed) == History()
    assert history(Nominal(model()), changed) == History()


def test_jumps_among_some_of_the_rows_are_where_these_are():
    story = History(40, 0, (Jump(10, (3,)), Jump(40, (5,))))
    rows = np.array([0, 5, 9, 12, 39, 41, 50])
    assert story.of(rows) == (Jump(3, (3,)), Jump(5, (5,)))
    # Nothing was seen before the first, or after the second.
    assert story.of(np.array([12, 39, 41])) == (Jump(2, (5,)),)
    assert story.of(np.array([5, 12, 39])) == (Jump(1, (3,)),)


def log_of(seen) -> Log:
    return Log("run.csv", arm().joint_names, seen, np.arange(len(seen)) + 2)


@pytest.fixture(scope="module")
def run():
    placed = model()
    seen = sightings(placed, errors_of(placed, 5), 60, 5)
    return calibrate_log(log_of(seen), arm()), seen


def test_the_same_rows_at_other_times_give_the_same_model(run):
    done, seen = run
    order = np.random.default_rng(4).permutation(60)
    shuffled = replace(seen[order], time=seen.time)
    other: Any = calibrate_log(log_of(shuffled), arm(), validate="none").calibrator
    np.testing.assert_array_equal(other.engine.x, done.calibrator.engine.x)
    np.testing.assert_array_equal(other.errors(seen), done.calibrator.errors(seen))


def test_each_part_of_the_model_contributes(run):
    parts = contributions(run[0].result)
    assert [part.part for part in parts] == ["placement", "geometry", "error curves"]
    sizes = [part.error.mean for part in parts]
    assert sizes[1] < 0.3 * sizes[0]
    assert sizes[2] <= 1.05 * sizes[1]
    turns = [part.orientation.mean for part in parts if part.orientation is not None]
    assert turns[1] < 0.5 * turns[0]
    assert parts[-1].error == verdict(run[0].result).summary_after
    nothing = replace(run[0].result, held_out=None)
    assert contributions(nothing) == ()


def test_an_arm_that_was_learned_on_a_corner_is_better_than_nominal_elsewhere():
    placed = model()
    x = errors_of(placed, 6)
    rng = np.random.default_rng(6)
    near = rng.uniform(-0.4, 0.4, (60, 6)) + np.array([0.5, -1.0, 1.2, 0.3, 0.8, 0.0])
    day = sightings(placed, x, 60, 6, joints=near)
    calibrator: Any = calibrate_log(log_of(day), arm(), validate="none").calibrator
    other = sightings(placed, x, 100, noise=0.0, joints=rng.uniform(-2.4, 2.4, (100, 6)))
    learned_, nominal = (
        np.linalg.norm(c.errors(other), axis=1).mean()
        for c in (calibrator, Nominal(calibrator.model))
    )
    assert learned_ < 0.5 * nominal
