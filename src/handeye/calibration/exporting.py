"""A calibrated arm in the files that other programs read."""

from typing import Any

import numpy as np

from handeye.arrays import Array
from handeye.calibration.arm.corrected import CorrectedArm
from handeye.calibration.combined import Combined
from handeye.calibration.placed_arm import PlacedArm
from handeye.calibration.session import AnyCalibrator
from handeye.errors import InvalidInput
from handeye.geometry import invert
from handeye.io.urdf_origins import corrected_urdf, joint_origins
from handeye.io.yaml_files import joint_origins_yaml
from handeye.robots.urdf import UrdfArm

# A scale or compliance whose effect over the joint's travel is below this is none [rad].
_NONE = 1e-6


def calibrated_urdf(calibrator: AnyCalibrator) -> str:
    """The URDF of an arm with the joints where they were found.

    Placements, and with them lengths, directions and zeros of joints. Error curves, scales and
    compliance cannot be stated there: `not_in_urdf` says what stays out, and `command` has it all.

    Raises:
        InvalidInput: a calibrator that has not learned an arm from a URDF file.
    """
    arm, fixed = _arm(calibrator)
    return corrected_urdf(arm.urdf, arm.joint_names, _departures(arm, fixed))


def calibrated_joints_yaml(calibrator: AnyCalibrator) -> str:
    """The same placements as YAML that a xacro file can load.

    Raises:
        InvalidInput: as `calibrated_urdf`.
        MissingExtra: without PyYAML.
    """
    arm, _ = _arm(calibrator)
    names = arm.joint_names
    return joint_origins_yaml(names, joint_origins(calibrated_urdf(calibrator), names))


def not_in_urdf(calibrator: AnyCalibrator) -> tuple[str, ...]:
    """What was learned of an arm and cannot be stated in a URDF file, in words."""
    arm, fixed = _arm(calibrator)
    out: list[str] = []
    for name, scale, give in zip(arm.joint_names, fixed.scales, fixed.compliances, strict=True):
        if abs(scale - 1.0) > _NONE:
            out.append(f"{name}: scale {scale:.6f}")
        if give > _NONE:
            out.append(f"{name}: gives way by {give:.3g} rad/Nm (m/N)")
    return (*out, "error curves of the joints")


def _departures(arm: UrdfArm, fixed: CorrectedArm) -> Array:
    """D (n, 4, 4): how far each joint stands, in its own frame, from where the file has it."""
    n = len(arm.joint_names)
    return np.asarray(invert(arm.stages().placements[:n]) @ fixed.stages.placements[:n])


def _arm(calibrator: AnyCalibrator) -> tuple[UrdfArm, CorrectedArm]:
    model: Any = getattr(calibrator, "model", None)
    if (
        isinstance(calibrator, Combined)
        and isinstance(model, PlacedArm)
        and isinstance(model.arm, UrdfArm)
    ):
        return model.arm, calibrator.plant
    raise InvalidInput(
        "only an arm from a URDF file that was calibrated with the method combined has corrected "
        "joints to write"
    )
