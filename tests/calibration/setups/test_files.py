"""A fitted set-up in files: as it was, and as other programs want it."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml
from tests.calibration.arm.arms import arm
from tests.calibration.arm.measured import KINDS, flanges, zeros
from tests.calibration.setups.setups import described

from handeye.arrays import Array
from handeye.calibration.arm.measurements.storage import from_arrays, to_arrays
from handeye.calibration.arm.robot import SETTINGS
from handeye.calibration.exporting import (
    calibrated_joints_yaml,
    calibrated_urdf,
    camera_infos,
    hand_eyes,
    not_in_urdf,
)
from handeye.calibration.setups.commands import SetupCommands
from handeye.calibration.setups.description import Description, load_description
from handeye.calibration.setups.fit import MixedFit, fit_measurements
from handeye.calibration.setups.knowledge import beside_arm, of_arm, parts_of, undetermined_of
from handeye.calibration.setups.storage import load_setup, save_setup
from handeye.errors import FileFormatError, InvalidInput
from handeye.geometry import invert, transform
from handeye.io.tensors import read_tensors, write_tensors
from handeye.observations import PointTarget
from handeye.robots.urdf import UrdfArm

Fitted = tuple[Description, MixedFit]


@pytest.fixture(scope="module")
def cameras(tmp_path_factory: pytest.TempPathFactory) -> Fitted:
    """Two cameras beside an arm."""
    folder = tmp_path_factory.mktemp("cameras")
    described("pixels of one point in two cameras", folder, 0)
    setup = load_description(folder / "setup.yaml")
    return setup, fit_measurements(setup.arm, setup.measurements, setup.sheet)


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_is_stored_to_the_bit(kind: str):
    one = KINDS[kind](np.random.default_rng(3))
    arrays, header = to_arrays(one)
    back = from_arrays(arrays, header)
    A = flanges(np.random.default_rng(4))
    assert type(back) is type(one)
    assert [u.name for u in back.unknowns] == [u.name for u in one.unknowns]
    first, second = one.equations(A, zeros(one)), back.equations(A, zeros(back))
    np.testing.assert_array_equal(first.residuals, second.residuals)
    for left, right in zip(first.by_blocks, second.by_blocks, strict=True):
        np.testing.assert_array_equal(left, right)
    np.testing.assert_array_equal(one.std, back.std)
    with pytest.raises(TypeError, match="no measurement"):
        from_arrays(*_of(one.sight))


def _of(thing: object) -> tuple[dict[str, Array], dict[str, object]]:
    return to_arrays(thing)  # pyright: ignore[reportArgumentType]


def test_a_set_up_comes_back_as_it_was(cameras: Fitted, tmp_path: Path):
    setup, fit = cameras
    save_setup(tmp_path / "a.safetensors", fit, setup.sizes)
    stored = load_setup(tmp_path / "a.safetensors")
    back = stored.fit
    assert stored.sizes == {"left": (1920, 1200), "right": (1920, 1200)}
    q = np.random.default_rng(0).uniform(-2.0, 2.0, (9, 6))
    np.testing.assert_array_equal(back.flanges(q), fit.flanges(q))
    np.testing.assert_array_equal(back.covariance, fit.covariance)
    assert back.noise == fit.noise
    assert [p.tolist() for p in back.doubtful()] == [p.tolist() for p in fit.doubtful()]
    assert of_arm(back) == of_arm(fit)
    assert beside_arm(back, {}) == beside_arm(fit, {})
    assert parts_of(back) == parts_of(fit)
    assert undetermined_of(back) == undetermined_of(fit)


def test_files_that_are_no_set_up_are_refused(cameras: Fitted, tmp_path: Path):
    path = tmp_path / "a.safetensors"
    save_setup(path, cameras[1])
    with pytest.raises(FileFormatError, match="no such file"):
        load_setup(tmp_path / "absent")
    arrays, header = read_tensors(path, "handeye.setup", 1, "a set-up")
    for broken in (
        {**arrays, "x": arrays["x"][1:]},
        {**arrays, "used": arrays["used"][1:]},
        {name: array for name, array in arrays.items() if not name.endswith("joints")},
    ):
        write_tensors(path, "handeye.setup", 1, broken, header)
        with pytest.raises(FileFormatError, match="do not fit together"):
            load_setup(path)
    write_tensors(path, "handeye.model", 1, arrays, header)
    with pytest.raises(FileFormatError, match="not a calibrated set-up"):
        load_setup(path)


def test_the_urdf_has_the_arm_as_found(cameras: Fitted):
    _, fit = cameras
    made = UrdfArm.from_text(calibrated_urdf(fit), fit.problem.arm.tip, "found")
    q = np.random.default_rng(1).uniform(-2.0, 2.0, (20, 6))
    scales = fit.corrected.scales
    np.testing.assert_allclose(made.poses(q * scales), fit.flanges(q), atol=1e-9)
    assert np.abs(made.poses(q) - arm().poses(q)).max() > 1e-3
    assert "shoulder_pan_joint:" in calibrated_joints_yaml(fit)
    assert not_in_urdf(fit)[-1] == "error curves of the joints"


def test_cameras_are_written_as_ros_keeps_them(cameras: Fitted):
    setup, fit = cameras
    files = camera_infos(fit, setup.sizes)
    assert list(files) == ["left", "right"]
    left = yaml.safe_load(files["left"])
    assert (left["image_width"], left["image_height"]) == (1920, 1200)
    assert left["camera_matrix"]["data"] == [1200.0, 0.0, 960.0, 0.0, 1210.0, 600.0, 0.0, 0.0, 1.0]
    assert left["distortion_model"] == "plumb_bob"
    with pytest.raises(InvalidInput, match="size of the pictures of left"):
        camera_infos(fit, {})


def test_sensors_are_written_as_easy_handeye_keeps_them(cameras: Fitted):
    _, fit = cameras
    files = hand_eyes(fit)
    assert list(files) == ["frame of left", "frame of right"]
    left = yaml.safe_load(files["frame of left"])
    named = left["parameters"]
    assert named["calibration_type"] == "eye_on_base"
    assert named["robot_base_frame"] == "world"
    assert named["robot_effector_frame"] == fit.problem.arm.tip
    assert named["tracking_base_frame"] == "frame_of_left"
    assert named["tracking_marker_frame"] == "dot"
    found = fit.measurements[0].sight.sensor.reference[:3, 3]
    at = [left["transform"]["translation"][axis] for axis in "xyz"]
    np.testing.assert_allclose(at, found, rtol=1e-12)


def test_commands_bring_the_marker_where_a_camera_wants_it(cameras: Fitted):
    _, fit = cameras
    left = fit.measurements[0].sight
    wanted = np.random.default_rng(2).uniform(-1.2, 1.2, (5, 6))
    base = transform(fit.flanges(wanted), left.points.reference[0])
    seen = transform(invert(left.sensor.reference), base)
    for commands, goals in (
        (SetupCommands(fit), seen),
        (SetupCommands(fit, "base", "dot"), base),
    ):
        joints = commands.command(PointTarget(goals, wanted + 0.05))
        there = transform(fit.flanges(joints), left.points.reference[0])
        np.testing.assert_allclose(there, base, atol=1e-5)
    assert SetupCommands(fit).sensor == "frame of left"
    assert SetupCommands(fit, "frame of right").sensor == "frame of right"
    with pytest.raises(InvalidInput, match="no sensor is called eye: choose from base, frame of"):
        SetupCommands(fit, "eye")
    with pytest.raises(InvalidInput, match="no marker is called spot: choose from dot"):
        SetupCommands(fit, marker="spot")


def test_no_correction_brings_the_marker_farther_than_the_envelope(
    cameras: Fitted, monkeypatch: pytest.MonkeyPatch
):
    _, fit = cameras
    near = replace(SETTINGS, envelope=1e-4)
    monkeypatch.setattr("handeye.calibration.setups.commands.SETTINGS", near)
    wanted = np.random.default_rng(2).uniform(-1.2, 1.2, (5, 6))
    c = fit.measurements[0].sight.points.reference[0]
    goals = transform(fit.flanges(wanted), c)
    joints = SetupCommands(fit, "base", "dot").command(PointTarget(goals, wanted))
    off = np.linalg.norm(transform(arm().poses(joints), c) - goals, axis=1)
    np.testing.assert_allclose(off, 1e-4, rtol=1e-2)


def test_a_set_up_that_only_carries_sensors_has_nothing_to_bring(tmp_path: Path):
    described("points, eye in hand", tmp_path, 0)
    setup = load_description(tmp_path / "setup.yaml")
    fit = fit_measurements(setup.arm, setup.measurements, setup.sheet)
    with pytest.raises(InvalidInput, match="the flange carries the sensors"):
        SetupCommands(fit)
    named = yaml.safe_load(hand_eyes(fit)["sensor"])["parameters"]
    assert named["calibration_type"] == "eye_in_hand"
