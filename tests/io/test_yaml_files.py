"""YAML for the ROS world, read back as its programs read it."""

import sys

import numpy as np
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from handeye.errors import InvalidInput, MissingExtra
from handeye.geometry import make_pose
from handeye.io.yaml_files import (
    HandEyeFrames,
    camera_info_yaml,
    hand_eye_yaml,
    joint_origins_yaml,
)

POSE = make_pose(Rotation.from_rotvec([0.1, -2.0, 0.4]).as_matrix(), [1e-5, -0.25, 1 / 3])


def numbers(tree):
    if isinstance(tree, dict):
        return [n for value in tree.values() for n in numbers(value)]
    if isinstance(tree, list):
        return [n for value in tree for n in numbers(value)]
    return [tree]


def test_joint_origins_by_joint_and_number():
    text = joint_origins_yaml(["a", "b"], np.array([np.eye(4), POSE]))
    joints = yaml.safe_load(text)["kinematics"]
    assert list(joints) == ["a", "b"]
    b = joints["b"]
    assert list(b) == ["x", "y", "z", "roll", "pitch", "yaw"]
    assert [b["x"], b["y"], b["z"]] == POSE[:3, 3].tolist()
    R = Rotation.from_euler("xyz", [b["roll"], b["pitch"], b["yaw"]]).as_matrix()
    np.testing.assert_allclose(R, POSE[:3, :3], atol=1e-15)
    assert all(isinstance(number, float) for number in numbers(joints))


@pytest.mark.parametrize(
    ("setup", "kind"), [("eye_in_hand", "eye_in_hand"), ("eye_to_hand", "eye_on_base")]
)
def test_a_hand_eye_calibration_has_the_fields_of_its_messages(setup, kind):
    frames = HandEyeFrames("arm", "base", "flange", "eye", "board")
    read = yaml.full_load(hand_eye_yaml(setup, POSE, frames))
    assert list(read) == ["parameters", "transform"]
    # The order of the message's fields.
    assert read["parameters"] == {
        "name": "arm",
        "calibration_type": kind,
        "robot_base_frame": "base",
        "robot_effector_frame": "flange",
        "tracking_base_frame": "eye",
        "tracking_marker_frame": "board",
        "freehand_robot_movement": True,
        "move_group_namespace": "/",
        "move_group": "manipulator",
    }
    at, turn = read["transform"]["translation"], read["transform"]["rotation"]
    assert [at[k] for k in "xyz"] == POSE[:3, 3].tolist()
    R = Rotation.from_quat([turn[k] for k in "xyzw"]).as_matrix()
    np.testing.assert_allclose(R, POSE[:3, :3], atol=1e-15)


@given(st.floats(-1e3, 1e3), st.floats(1e-12, 1.0))
def test_small_numbers_stay_numbers_in_yaml_1_1(place, small):
    pose = make_pose(np.eye(3), [place, small, 0.0])
    at = yaml.safe_load(hand_eye_yaml("eye_in_hand", pose))["transform"]["translation"]
    assert [at["x"], at["y"]] == [place, small]


@pytest.mark.parametrize(("model", "n"), [("plumb_bob", 5), ("rational_polynomial", 8)])
def test_intrinsics_as_ros_keeps_them(model, n):
    K = np.array([[600.0, 0, 320], [0, 601, 240], [0, 0, 1]])
    D = np.arange(n) / 100
    read = yaml.safe_load(camera_info_yaml("wrist", (640, 480), K, D, model))
    assert (read["image_width"], read["image_height"], read["camera_name"]) == (640, 480, "wrist")
    assert read["distortion_model"] == model
    assert read["camera_matrix"] == {"rows": 3, "cols": 3, "data": K.reshape(-1).tolist()}
    assert read["distortion_coefficients"] == {"rows": 1, "cols": n, "data": D.tolist()}
    assert read["rectification_matrix"]["data"] == np.eye(3).reshape(-1).tolist()
    P = np.reshape(read["projection_matrix"]["data"], (3, 4))
    np.testing.assert_array_equal(P, np.column_stack([K, np.zeros(3)]))


def test_misuse_is_explained(monkeypatch):
    with pytest.raises(InvalidInput, match="plumb_bob has 5 coefficients"):
        camera_info_yaml("c", (1, 1), np.eye(3), np.zeros(4))
    with pytest.raises(InvalidInput, match="model must be one of"):
        camera_info_yaml("c", (1, 1), np.eye(3), np.zeros(4), "fisheye")  # pyright: ignore[reportArgumentType]
    with pytest.raises(InvalidInput, match="origins must have shape"):
        joint_origins_yaml(["a"], np.eye(4))
    monkeypatch.setitem(sys.modules, "yaml", None)
    with pytest.raises(MissingExtra, match=r"handeye\[yaml\]"):
        hand_eye_yaml("eye_in_hand", POSE)
