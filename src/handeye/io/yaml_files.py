"""Results as YAML that programs of the ROS world read."""

from collections.abc import Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import Any, Literal

import numpy as np
from scipy.spatial.transform import Rotation

from handeye.arrays import Array, count, finite, shaped
from handeye.errors import InvalidInput, MissingExtra
from handeye.io.urdf_origins import xyz_rpy

DistortionModel = Literal["plumb_bob", "rational_polynomial", "equidistant"]

_COEFFICIENTS = {"plumb_bob": (5,), "rational_polynomial": (8,), "equidistant": (4,)}


@dataclass(frozen=True)
class HandEyeFrames:
    """The names of frames in a robot's tree of transforms.

    name      of the calibration
    base, effector, camera, target
    """

    name: str = "handeye"
    base: str = "base_link"
    effector: str = "tool0"
    camera: str = "camera_optical_frame"
    target: str = "target"


def joint_origins_yaml(joint_names: Sequence[str], origins: Array) -> str:
    """Placements T_parent_joint (n, 4, 4) for a xacro file, by joint: x, y, z, roll, pitch, yaw.

    A xacro file reads it with `xacro.load_yaml(...)['kinematics']['<joint>']['x']` and so on.

    Raises:
        InvalidInput: for arrays of another shape.
        MissingExtra: without PyYAML.
    """
    T = shaped(origins, (len(joint_names), 4, 4), "origins")
    joints: dict[str, dict[str, float]] = {}
    for name, pose in zip(joint_names, T, strict=True):
        xyz, rpy = xyz_rpy(pose)
        joints[name] = dict(zip(("x", "y", "z", "roll", "pitch", "yaw"), xyz + rpy, strict=True))
    return _text({"kinematics": joints})


def hand_eye_yaml(
    setup: Literal["eye_in_hand", "eye_to_hand"], T: Array, frames: HandEyeFrames | None = None
) -> str:
    """A calibration as easy_handeye2 stores it, which its publisher broadcasts.

    T (4, 4) is T_flange_camera for an eye in the hand, T_base_camera for an eye in the world. The
    program looks for it in ~/.ros2/easy_handeye2/calibrations/<name>.calib.

    Raises:
        InvalidInput: for no pose.
        MissingExtra: without PyYAML.
    """
    pose = shaped(T, (4, 4), "T")
    at = frames or HandEyeFrames()
    turn = Rotation.from_matrix(pose[:3, :3]).as_quat(canonical=True).tolist()
    return _text(
        {
            "parameters": {
                "name": at.name,
                "calibration_type": "eye_in_hand" if setup == "eye_in_hand" else "eye_on_base",
                "robot_base_frame": at.base,
                "robot_effector_frame": at.effector,
                "tracking_base_frame": at.camera,
                "tracking_marker_frame": at.target,
                "freehand_robot_movement": True,
                "move_group_namespace": "/",
                "move_group": "manipulator",
            },
            "transform": {
                "translation": dict(zip("xyz", pose[:3, 3].tolist(), strict=True)),
                "rotation": dict(zip("xyzw", turn, strict=True)),
            },
        }
    )


def camera_info_yaml(
    name: str,
    size: tuple[int, int],
    matrix: Array,
    distortion: Array,
    model: DistortionModel = "plumb_bob",
) -> str:
    """Intrinsics as ROS keeps them in camera_info files, for one camera that is not rectified.

    size (width, height) [px]; matrix K (3, 3) [px]; distortion: k1, k2, p1, p2, k3 of OpenCV's
    model ("plumb_bob"), eight coefficients ("rational_polynomial") or four ("equidistant").

    Raises:
        InvalidInput: for arrays of another shape, or coefficients that do not fit the model.
        MissingExtra: without PyYAML.
    """
    K, D = shaped(matrix, (3, 3), "matrix"), finite(distortion, "distortion")
    if model not in _COEFFICIENTS:
        raise InvalidInput(f"model must be one of {', '.join(_COEFFICIENTS)}, got {model!r}")
    if D.shape != _COEFFICIENTS[model]:
        raise InvalidInput(
            f"{model} has {_COEFFICIENTS[model][0]} coefficients, got an array of shape {D.shape}"
        )
    return _text(
        {
            "image_width": count(size[0], "width"),
            "image_height": count(size[1], "height"),
            "camera_name": name,
            "camera_matrix": _matrix(K),
            "distortion_model": model,
            "distortion_coefficients": _matrix(D[np.newaxis]),
            "rectification_matrix": _matrix(np.eye(3)),
            "projection_matrix": _matrix(np.column_stack([K, np.zeros(3)])),
        }
    )


def _matrix(values: Array) -> dict[str, Any]:
    rows, cols = values.shape
    return {"rows": rows, "cols": cols, "data": values.reshape(-1).tolist()}


def _text(data: dict[str, Any]) -> str:
    # YAML 1.1, which ROS reads: it takes a number like 1e-05, as YAML 1.2 writes it, for a word.
    try:
        yaml = import_module("yaml")
    except ImportError as error:
        raise MissingExtra("a YAML file", "yaml") from error
    return str(yaml.safe_dump(data, sort_keys=False, default_flow_style=None, width=100))
