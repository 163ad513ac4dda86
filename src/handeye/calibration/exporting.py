"""A calibrated arm, and the sensors around it, in the files that other programs read."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from handeye.calibration.arm.corrected import CorrectedJoints
from handeye.calibration.arm.measurements import PixelSightings
from handeye.calibration.combined import Combined
from handeye.calibration.placed_arm import PlacedArm
from handeye.calibration.session import AnyCalibrator
from handeye.calibration.setups.fit import MixedFit
from handeye.calibration.setups.knowledge import looks
from handeye.errors import InvalidInput
from handeye.io.urdf_origins import corrected_urdf, joint_origins
from handeye.io.yaml_files import (
    HandEyeFrames,
    camera_info_yaml,
    hand_eye_yaml,
    joint_origins_yaml,
)
from handeye.robots.urdf import UrdfArm

# A scale or compliance whose effect over the joint's travel is below this is none [rad].
_NONE = 1e-6


def calibrated_urdf(calibrator: AnyCalibrator | MixedFit) -> str:
    """The URDF of an arm with the joints where they were found.

    Placements, and with them lengths, directions and zeros of joints. Error curves, scales and
    compliance cannot be stated there: `not_in_urdf` says what stays out, and `command` has it all.

    Raises:
        InvalidInput: a calibrator that has not learned an arm from a URDF file.
    """
    urdf, joints = _joints(calibrator)
    return corrected_urdf(urdf, joints.names, joints.departures)


def calibrated_joints_yaml(calibrator: AnyCalibrator | MixedFit) -> str:
    """The same placements as YAML that a xacro file can load.

    Raises:
        InvalidInput: as `calibrated_urdf`.
        MissingExtra: without PyYAML.
    """
    names = _joints(calibrator)[1].names
    return joint_origins_yaml(names, joint_origins(calibrated_urdf(calibrator), names))


def not_in_urdf(calibrator: AnyCalibrator | MixedFit) -> tuple[str, ...]:
    """What was learned of an arm and cannot be stated in a URDF file, in words."""
    _, joints = _joints(calibrator)
    out: list[str] = []
    for name, scale, give in zip(joints.names, joints.scales, joints.compliances, strict=True):
        if abs(scale - 1.0) > _NONE:
            out.append(f"{name}: scale {scale:.6f}")
        if give > _NONE:
            out.append(f"{name}: gives way by {give:.3g} rad/Nm (m/N)")
    return (*out, "error curves of the joints")


def camera_infos(fit: MixedFit, sizes: Mapping[str, tuple[int, int]]) -> dict[str, str]:
    """Intrinsics of each camera of a set-up, as ROS keeps them in camera_info files, by name.

    sizes: width and height of pictures [px].

    Raises:
        InvalidInput: a camera of unknown size.
        MissingExtra: without PyYAML.
    """
    out: dict[str, str] = {}
    for one in fit.measurements:
        if isinstance(one, PixelSightings):
            name, numbers = one.camera.name, one.camera.reference
            if name not in sizes:
                raise InvalidInput(f"the size of the pictures of {name} is not known: state it")
            fx, fy, cx, cy = numbers[:4]
            K = np.array([[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]])
            out[name] = camera_info_yaml(name, sizes[name], K, numbers[4:])
    return out


def hand_eyes(fit: MixedFit) -> dict[str, str]:
    """Where each camera or other sensor of a set-up is, as easy_handeye2 stores it, by name.

    In the frame of the link that carries it, as it was found: publish it with the corrected URDF.
    Frames have the names of the URDF; the sensor's own has the name of the sensor.

    Raises:
        MissingExtra: without PyYAML.
    """
    arm = fit.problem.arm
    out: dict[str, str] = {}
    for one in fit.measurements:
        if looks(one):
            sensor, seen = one.sight.sensor, one.sight.target
            target = seen.name if seen.free.any() else one.sight.points.name
            eye = _plain(sensor.name)
            ends = one.base or arm.base, one.link or arm.tip
            frames = HandEyeFrames(eye, *ends, eye, _plain(target))
            out[sensor.name] = hand_eye_yaml(one.sight.setup, sensor.reference, frames)
    return out


def _plain(name: str) -> str:
    """A name without spaces, as frames have."""
    return "_".join(name.split())


def _joints(calibrator: AnyCalibrator | MixedFit) -> tuple[str, CorrectedJoints]:
    """The text of the nominal URDF, and the joints as found."""
    if isinstance(calibrator, MixedFit):
        return calibrator.problem.arm.urdf, calibrator.corrected
    model: Any = getattr(calibrator, "model", None)
    if (
        isinstance(calibrator, Combined)
        and isinstance(model, PlacedArm)
        and isinstance(model.arm, UrdfArm)
    ):
        arm = model.arm
        found = CorrectedJoints.of_arm(arm.stage_names, arm.stages(), calibrator.plant)
        return arm.urdf, found
    raise InvalidInput(
        "only an arm from a URDF file that was calibrated with the method combined, or from a "
        "description of a set-up, has corrected joints to write"
    )
