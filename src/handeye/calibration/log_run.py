"""From a log of a robot to a calibrated model and how good it is."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from handeye.arrays import Array
from handeye.calibration.changes import drifts, history, in_hindsight
from handeye.calibration.combined import Combined
from handeye.calibration.expected import workspace
from handeye.calibration.influence import influence
from handeye.calibration.learned import parameters_of, parts_of, undetermined_of
from handeye.calibration.log_learning import LogLearner, chosen, follows_better
from handeye.calibration.placed import (
    Method,
    Robot,
    calibrator_for,
    place,
    robot_name,
    usual_method,
)
from handeye.calibration.planar_placement import eye_points
from handeye.calibration.plant import PlanarPlant
from handeye.calibration.results import CalibrationResult, Validation
from handeye.calibration.session import AnyCalibrator, learn_from_log
from handeye.calibration.suspects import suspects
from handeye.calibration.validation import held_out, left_out, to_learn
from handeye.errors import LogError
from handeye.io.logs import BadRow, Log
from handeye.observations import Observation, PointObservation
from handeye.robots.urdf import UrdfArm

Progress = Callable[[int, int], None]
"""Called with the rows learned so far, and those to learn in all."""

_FEWEST_ROWS = 9
# A robot that changed so few rows before the end is judged without holding any of them out; a fit
# to all rows knows all but what has changed from those before.
_FEWEST_SINCE, _FEWEST_FITTED = 25, 10


def _quiet(done: int, total: int) -> None:
    """Shows nothing."""


class Calibration(NamedTuple):
    """The result of a run, and the calibrator after it has learned every row."""

    result: CalibrationResult
    calibrator: AnyCalibrator
    frames: str


def calibrate_log(
    log: Log,
    robot: Robot,
    *,
    method: Method | None = None,
    rejected: tuple[BadRow, ...] = (),
    validate: Validation = "blocks",
    replicate: int = 0,
    progress: Progress = _quiet,
) -> Calibration:
    """Place the frames, learn the rows in order of time, each tested before it is learned, settle.

    Frames between sensor and base and between flange and marker come first (closed form, then least
    squares over all rows): with them alone the error is `before`. Learning in order tells what live
    learning would have been like, and whether the robot changed. Where the method can fit an arm to
    all rows at once (`combined`, of a URDF file, unless it drifts) that fit is the result: the same
    rows in another order give the same model.

    Then some of the rows are left out and others calibrators, with frames of their own, learn the
    rest, so that `held_out` judges rows that had no part in anything: by default five blocks of
    time, each left out once. Where the robot was noticed to change, the blocks begin after its last
    change: what was seen before still teaches, but judges nothing. `verdict` says which number to
    trust. What does worse than the nominal robot on held-out rows is not used. The default method
    is `combined` for the planar robot and arms of URDF files, and `network` for others.

    The order in which the rows stand in the log does not matter, only their times.

    Args:
        log: what was observed.
        robot: the robot as its maker describes it.
        method: what learns.
        rejected: rows that were left out when the log was read, for the record.
        validate: blocks of time, a random third, or none.
        replicate: which random third.
        progress: called now and then.

    Raises:
        LogError: too few rows, or a log of another kind of robot.
        InvalidInput: another word for `validate`.
    """
    _check(log, robot)
    log = log.in_time_order()
    method = method or usual_method(robot)
    seen = log.observations
    n = len(log)
    run = LogLearner(robot, method, seen)
    work = n + to_learn(n, left_out(n, validate)) + (n if run.settles else 0)
    model, frames = place(robot, seen)
    before = calibrator_for(model, "nominal").errors(seen)
    online = calibrator_for(model, method)
    tested = learn_from_log(online, seen, after_each=lambda k: progress(k, work))
    run.history = history(online, seen)
    if run.settles:
        known: Any = model
        told: Any = seen
        run.history = in_hindsight(run.history, known, told)
    since = run.history.since
    parts = left_out(n, validate, replicate=replicate, since=since)
    if since and n - since < (_FEWEST_FITTED if run.settles else _FEWEST_SINCE):
        parts = []
    whole, found, believed, done = online, None, None, n
    if run.settles:
        found, believed = run.learn(np.arange(n), lambda k: progress(n + k, work))
        whole, done = found.whole, 2 * n
        before[since:] = found.placed.errors(_rows(seen, since))
    held = held_out(
        seen, parts, validate, lambda rows, after_each: run.learn(rows, after_each)[0], whole,
        since=since, after_each=lambda k: progress(min(done + k, work), work),
    )  # fmt: skip
    drifting = drifts(online)
    if (
        found is not None
        and drifting
        and follows_better(tested.error, held, since, lambda rows: found.whole.errors(seen[rows]))
    ):
        whole, believed = online, None
    elif found is not None:
        drifting = False
        whole, held = chosen(found, held)
        whole.past = run.history.events
    progress(work, work)
    result = CalibrationResult(
        robot=robot_name(robot),
        log=log.name,
        method=method,
        joint_names=log.joint_names,
        joints=seen.joints,
        positions=_positions(seen),
        before=before,
        online=tested.error,
        n_neurons=np.cumsum(tested.allocated, dtype=np.int64) if method == "network" else None,
        held_out=held,
        rejected=tuple(str(bad) for bad in rejected),
        settings={
            "validation": validate,
            "replicate": str(replicate),
            "calibrator": repr(whole),
            "frames": frames,
        },
        findings=_findings(whole),
        since=since,
        drifting=drifting,
        times=seen.time,
        rows=log.rows,
        parameters=parameters_of(whole, seen),
        parts=parts_of(whole, seen),
        undetermined=undetermined_of(whole),
        influence=influence(whole, seen, held, since=since, believed=believed),
        workspace=workspace(whole, seen, held=held),
        suspects=_suspects(robot, seen, whole.errors(_rows(seen, since))),
        sliding=_sliding(robot),
    )
    return Calibration(result, whole, frames)


def _rows(seen: Any, since: int) -> Any:
    return seen[since:]


def _suspects(robot: Robot, seen: Observation, errors: Array) -> tuple[str, ...]:
    """What is wrong with the log, if it clearly is."""
    if not isinstance(robot, UrdfArm) or not isinstance(seen, PointObservation):
        return ()
    return suspects(robot, seen, float(np.median(np.linalg.norm(errors, axis=1))))


def _sliding(robot: Robot) -> tuple[str, ...]:
    if not isinstance(robot, UrdfArm):
        return ()
    return tuple(np.array(robot.joint_names)[robot.sliding].tolist())


def _findings(calibrator: AnyCalibrator) -> tuple[str, ...]:
    """State and changes of parts; single outliers are in the state."""
    if not isinstance(calibrator, Combined):
        return ()
    changes = [str(event) for event in calibrator.events if event.kind != "outlier"]
    return (calibrator.health(), *changes)


def _positions(seen: Observation) -> Array:
    if isinstance(seen, PointObservation):
        return seen.position
    return np.hstack([eye_points(seen), np.zeros((len(seen), 1))])


def _check(log: Log, robot: Robot) -> None:
    planar = isinstance(robot, PlanarPlant)
    if planar != (log.kind == "stereo"):
        wanted = "pointing_rad, range_m, eccentricity_rad" if planar else "x_m, y_m, z_m"
        raise LogError(
            f"{log.name}: robot {robot_name(robot)} needs a log with the columns {wanted}; "
            "choose another --robot, or see docs/how-to/log-format.md"
        )
    if len(log) < _FEWEST_ROWS:
        raise LogError(
            f"{log.name}: {len(log)} usable rows; at least {_FEWEST_ROWS} are needed to place the "
            "frames and hold a third out: record more poses"
        )
