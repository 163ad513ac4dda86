"""Robots in front of a sensor: which model describes them, and what learns it."""

from typing import Literal

import numpy as np

from handeye.arrays import Array
from handeye.calibration.arm import ArmEstimator
from handeye.calibration.arm.noise import with_noise
from handeye.calibration.calibrators import NetworkCorrection, Nominal
from handeye.calibration.combined import Combined, knows
from handeye.calibration.estimation import ParameterEstimator
from handeye.calibration.models import AnyModel, PlanarModel
from handeye.calibration.placed_arm import PlacedArm
from handeye.calibration.placement import estimate_placement, sensor_of
from handeye.calibration.planar_placement import place_eye
from handeye.calibration.plant import PlanarPlant
from handeye.calibration.session import AnyCalibrator
from handeye.errors import LogError
from handeye.observations import Observation, PointObservation, StereoObservation
from handeye.robots.arm import Arm
from handeye.robots.urdf import UrdfArm

Robot = PlanarPlant | Arm
Method = Literal["combined", "network", "estimator", "nominal"]

_STDS = 3.0


def usual_method(robot: Robot) -> Method:
    """What learns a robot unless a user says otherwise."""
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
    """The nominal robot with its frames fitted to observations, and what came of the fit.

    Sightings of an arm are taken in an order of their own: the same ones in another order give the
    same frames, to the last bit.
    """
    if isinstance(robot, PlanarPlant):
        assert isinstance(seen, StereoObservation)
        placed = place_eye(robot, seen)
        where = (
            f"eye at ({placed.v_x:.4f}, {placed.v_y:.4f}) m, offset {placed.gamma.offset:.4f} rad"
        )
        return PlanarModel(placed), where
    assert isinstance(seen, PointObservation)
    seen = seen[np.lexsort(np.hstack([seen.joints, seen.position]).T[::-1])]
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
