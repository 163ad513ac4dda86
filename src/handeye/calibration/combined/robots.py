"""Which robot a model describes."""

from typing import Any

from handeye.calibration.arm.robot import ArmRobot
from handeye.calibration.arm.sheet import ArmSheet
from handeye.calibration.combined.planar.robot import PlanarRobot
from handeye.calibration.combined.planar.sheet import DataSheet
from handeye.calibration.engine.robot import Robot
from handeye.calibration.models import PlanarModel
from handeye.calibration.placed_arm import PlacedArm
from handeye.errors import InvalidInput
from handeye.robots.urdf import UrdfArm

Model = PlanarModel | PlacedArm
Sheet = DataSheet | ArmSheet


def knows(model: object) -> bool:
    """Whether a model is of a kind that `Combined` can learn."""
    arm = isinstance(model, PlacedArm) and isinstance(model.arm, UrdfArm)
    return arm or isinstance(model, PlanarModel)


def default_sheet(model: Model) -> Sheet:
    """Ordinary tolerances of a robot of this kind."""
    return DataSheet() if isinstance(model, PlanarModel) else ArmSheet()


def robot_of(model: Model, sheet: Sheet) -> Robot:
    """The robot of a model, with the tolerances of a data sheet.

    Raises:
        InvalidInput: for another kind of model, or a sheet of another kind of robot.
    """
    given: Any = model
    if isinstance(given, PlanarModel):
        if isinstance(sheet, DataSheet):
            return PlanarRobot(given, sheet)
        raise InvalidInput(f"the planar robot needs a DataSheet, got an {type(sheet).__name__}")
    if isinstance(given, PlacedArm) and isinstance(given.arm, UrdfArm):
        if isinstance(sheet, ArmSheet):
            return ArmRobot(given, sheet)
        raise InvalidInput(f"an arm needs an ArmSheet, got a {type(sheet).__name__}")
    raise InvalidInput(
        f"Combined needs a PlanarModel, or a PlacedArm of a UrdfArm, got a {type(given).__name__}; "
        "use a NetworkCorrection for other robots"
    )
