"""From a log of a robot to a calibrated model and how good it is."""

from collections.abc import Callable
from typing import Literal, NamedTuple

import numpy as np

from handeye.arrays import Array
from handeye.calibration.arm import ArmEstimator
from handeye.calibration.arm.noise import with_noise
from handeye.calibration.calibrators import NetworkCorrection, Nominal
from handeye.calibration.changes import changed_at, drifts
from handeye.calibration.combined import Combined, knows
from handeye.calibration.estimation import ParameterEstimator
from handeye.calibration.influence import influence
from handeye.calibration.learned import parameters_of, parts_of, undetermined_of
from handeye.calibration.models import AnyModel, PlanarModel
from handeye.calibration.placed_arm import PlacedArm
from handeye.calibration.placement import estimate_placement, sensor_of
from handeye.calibration.planar_placement import eye_points, place_eye
from handeye.calibration.plant import PlanarPlant
from handeye.calibration.results import CalibrationResult, Validation
from handeye.calibration.session import AnyCalibrator, learn_from_log
from handeye.calibration.validation import held_out, left_out, to_learn
from handeye.errors import LogError
from handeye.io.logs import BadRow, Log
from handeye.observations import Observation, PointObservation, StereoObservation
from handeye.robots.arm import Arm
from handeye.robots.urdf import UrdfArm

Robot = PlanarPlant | Arm
Method = Literal["combined", "network", "estimator", "nominal"]

Progress = Callable[[int, int], None]
"""Called with the rows learned so far, and those to learn in all."""

_FEWEST_ROWS = 9
# A robot that changed so few rows before the end is judged without holding any of them out.
_FEWEST_SINCE = 25
_STDS = 3.0


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
    """Place the frames, then learn the rows in order of time, each tested before it is learned.

    Frames between sensor and base and between flange and marker come first (closed form, then least
    squares over all rows): with them alone the error is `before`. Then some of the rows are left
    out and others calibrators, with frames of their own, learn the rest, so that `held_out` judges
    rows that had no part in anything: by default five blocks of time, each left out once. Where the
    robot was noticed to change, the blocks begin after its last change: what was seen before still
    teaches, but judges nothing. `verdict` says which number to trust. The default method is
    `combined` for the planar robot and arms of URDF files, and `network` for others.

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
    method = method or _usual_method(robot)
    seen = log.observations
    n, work = len(log), len(log) + to_learn(len(log), left_out(len(log), validate))
    model, frames = place(robot, seen)
    calibrator = calibrator_for(model, method)
    before = calibrator_for(model, "nominal").errors(seen)
    online = learn_from_log(calibrator, seen, after_each=lambda k: progress(k, work))
    since = changed_at(calibrator, seen)
    parts = left_out(n, validate, replicate=replicate, since=since)
    if n - since < _FEWEST_SINCE and since:
        parts = []

    def learn(
        some: Observation, after_each: Callable[[int], None]
    ) -> tuple[AnyCalibrator, AnyCalibrator]:
        placed, _ = place(robot, some)
        learner = calibrator_for(placed, method)
        learn_from_log(learner, some, after_each=after_each)
        return calibrator_for(placed, "nominal"), learner

    held = held_out(
        seen, parts, validate, learn, calibrator, since=since,
        after_each=lambda k: progress(min(n + k, work), work),
    )  # fmt: skip
    progress(work, work)
    result = CalibrationResult(
        robot=robot_name(robot),
        log=log.name,
        method=method,
        joint_names=log.joint_names,
        joints=seen.joints,
        positions=_positions(seen),
        before=before,
        online=online.error,
        n_neurons=np.cumsum(online.allocated, dtype=np.int64) if method == "network" else None,
        held_out=held,
        rejected=tuple(str(bad) for bad in rejected),
        settings={
            "validation": validate,
            "replicate": str(replicate),
            "calibrator": repr(calibrator),
            "frames": frames,
        },
        findings=_findings(calibrator),
        since=since,
        drifting=drifts(calibrator),
        times=seen.time,
        rows=log.rows,
        parameters=parameters_of(calibrator, seen),
        parts=parts_of(calibrator, seen),
        undetermined=undetermined_of(calibrator),
        influence=influence(calibrator, seen, held, since=since),
    )
    return Calibration(result, calibrator, frames)


def _usual_method(robot: Robot) -> Method:
    return "combined" if isinstance(robot, PlanarPlant | UrdfArm) else "network"


def arm_of(robot: Robot) -> Arm:
    """The arm of a robot."""
    return robot.arm if isinstance(robot, PlanarPlant) else robot


def robot_name(robot: Robot) -> str:
    """A name for messages."""
    return arm_of(robot).name


def calibrator_for(model: AnyModel, method: Method) -> AnyCalibrator:
    """A calibrator that has seen nothing.

    Raises:
        LogError: a method that does not know the robot.
    """
    if method == "nominal":
        return Nominal(model)
    if method == "network":
        return NetworkCorrection(model)
    if method == "combined" and isinstance(model, PlanarModel | PlacedArm) and knows(model):
        return Combined(model)
    if isinstance(model, PlanarModel):
        return ParameterEstimator(model)
    if isinstance(model, PlacedArm) and knows(model):
        return ArmEstimator(model)
    raise LogError(
        f"the method {method} knows only the planar robot and arms of URDF files: choose the "
        "method network"
    )


def place(robot: Robot, seen: Observation) -> tuple[AnyModel, str]:
    """The nominal robot with its frames fitted to observations, and what came of the fit."""
    if isinstance(robot, PlanarPlant):
        assert isinstance(seen, StereoObservation)
        placed = place_eye(robot, seen)
        where = (
            f"eye at ({placed.v_x:.4f}, {placed.v_y:.4f}) m, offset {placed.gamma.offset:.4f} rad"
        )
        return PlanarModel(placed), where
    assert isinstance(seen, PointObservation)
    fit = estimate_placement(robot, seen)
    low, high = working_range(seen.joints)
    turn_std, noise = sensor_of(fit, seen)
    model = PlacedArm(robot, fit.placement, low, high, _resolution(seen), turn_std, noise)
    return with_noise(model, seen) if isinstance(robot, UrdfArm) else model, fit.status


def working_range(joints: Array) -> tuple[Array, Array]:
    """The box of joint angles (N, n) with room at its sides, so that a joint at rest has some."""
    low, high = joints.min(axis=0), joints.max(axis=0)
    margin = np.maximum(0.05 * (high - low), 0.05)
    return low - margin, high + margin


def _resolution(seen: PointObservation) -> float:
    """Three standard deviations of the measurement where they are given, else a tenth of a mm."""
    if seen.position_std is None:
        return 1e-4
    return _STDS * float(np.median(np.linalg.norm(seen.position_std, axis=1)))


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
