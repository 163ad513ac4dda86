"""From a log of a robot to a calibrated model and how good it is."""

from typing import Any, Literal, NamedTuple

import numpy as np

from handeye.arrays import Array
from handeye.calibration.calibrators import NetworkCorrection, Nominal
from handeye.calibration.combined import Combined
from handeye.calibration.estimation import ParameterEstimator
from handeye.calibration.models import AnyModel, PlanarModel
from handeye.calibration.placed_arm import PlacedArm
from handeye.calibration.placement import estimate_placement
from handeye.calibration.planar_placement import eye_points, place_eye
from handeye.calibration.plant import PlanarPlant
from handeye.calibration.results import CalibrationResult, HeldOut
from handeye.calibration.session import AfterEach, AnyCalibrator, ignore, learn_from_log
from handeye.errors import LogError
from handeye.io.logs import BadRow, Log
from handeye.observations import Observation, PointObservation, StereoObservation
from handeye.randomness import stream
from handeye.robots.arm import Arm

Robot = PlanarPlant | Arm
Method = Literal["combined", "network", "estimator", "nominal"]

_FEWEST_ROWS = 9
_STDS = 3.0


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
    replicate: int = 0,
    after_each: AfterEach = ignore,
) -> Calibration:
    """Place the frames, then learn the rows in order, each tested before it is learned.

    Frames between sensor and base and between flange and marker come first (closed form, then least
    squares over all rows): with them alone the error is `before`. Then a second calibrator, with
    frames of its own, learns a random two thirds of the rows and is tested on the rest, so that
    `held_out` judges rows that had no part in anything. `replicate` chooses the split. The default
    method is `combined` for the planar robot and `network` for others.

    Raises:
        LogError: too few rows, or a log of another kind of robot.
    """
    _check(log, robot)
    method = method or ("combined" if isinstance(robot, PlanarPlant) else "network")
    seen = log.observations
    model, frames = place(robot, seen)
    calibrator = calibrator_for(model, method)
    before = calibrator_for(model, "nominal").errors(seen)
    online = learn_from_log(calibrator, seen, after_each=after_each)
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
        held_out=_held_out(robot, log, method, replicate),
        rejected=tuple(str(bad) for bad in rejected),
        settings={"replicate": str(replicate), "calibrator": repr(calibrator), "frames": frames},
        findings=_findings(calibrator),
    )
    return Calibration(result, calibrator, frames)


def arm_of(robot: Robot) -> Arm:
    """The arm of a robot."""
    return robot.arm if isinstance(robot, PlanarPlant) else robot


def robot_name(robot: Robot) -> str:
    """A name for messages."""
    return arm_of(robot).name


def calibrator_for(model: AnyModel, method: Method) -> AnyCalibrator:
    """A calibrator that has seen nothing.

    Raises:
        LogError: a method that needs the planar robot, for another one.
    """
    if method == "nominal":
        return Nominal(model)
    if method == "network":
        return NetworkCorrection(model)
    if not isinstance(model, PlanarModel):
        raise LogError(
            f"the method {method} knows only the planar robot so far: choose the method network"
        )
    return Combined(model) if method == "combined" else ParameterEstimator(model)


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
    return PlacedArm(robot, fit.placement, low, high, _resolution(seen)), fit.status


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
    """State, changes of parts and undetermined directions; single outliers are in the state."""
    if not isinstance(calibrator, Combined):
        return ()
    changes = [str(event) for event in calibrator.events if event.kind != "outlier"]
    return (calibrator.health(), *changes, calibrator.knowledge().status)


def _held_out(robot: Robot, log: Log, method: Method, replicate: int) -> HeldOut:
    seen: Any = log.observations
    order = stream("held out", replicate).permutation(len(log))
    test, train = np.sort(order[: len(log) // 3]), np.sort(order[len(log) // 3 :])
    model, _ = place(robot, seen[train])
    calibrator = calibrator_for(model, method)
    learn_from_log(calibrator, seen[train])
    before = calibrator_for(model, "nominal").errors(seen[test])
    return HeldOut(test, before, calibrator.errors(seen[test]))


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
