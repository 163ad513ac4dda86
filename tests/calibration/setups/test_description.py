"""Descriptions in YAML: a small arm, tables of every kind, and what is said of a slip."""

from pathlib import Path

import numpy as np
import pytest
from tests.calibration.arm.arms import arm
from tests.calibration.setups.described import EYE, POINTS, table, tables, written

from handeye.arrays import Array
from handeye.calibration.arm.estimator import FINE
from handeye.calibration.arm.measurements import (
    Distances,
    Frame,
    Instrument,
    PixelSightings,
    PlaneContacts,
    Points,
    PointSightings,
    PoseSightings,
    StereoSightings,
    Touches,
)
from handeye.calibration.arm.sheet import CurveTerms
from handeye.calibration.setups.description import load_description
from handeye.calibration.setups.kinds import KINDS
from handeye.errors import FileFormatError, InvalidInput
from handeye.geometry import invert, transform, wxyz_from_matrix


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tables(tmp_path_factory.mktemp("described"))


ALL = """\
robot: ur10
measurements:
  - {kind: points, file: points.csv, sensor: tracker, target: ball, std: 1e-5, name: tracker}
  - {kind: poses, file: poses.csv, setup: eye_in_hand, sensor: wrist camera, std: [1e-4, 1e-3]}
  - {kind: pixels, file: pixels.csv, camera: eye, target: ball}
  - kind: touches
    file: touches.csv
    plate: cones
    tip: pin
  - {kind: distances, file: distances.csv, tip: ball, zero_within: 0.1, anchor: reel}
  - {kind: plane, file: plane.csv, tip: pin}
  - {kind: stereo, file: stereo.csv, target: ball}
cameras:
  eye: {matrix: [1000, 1000, 640, 480], within: 1}
points:
  pin: {at: [0, 0, 0.1], within: 0.002}
arm: {shift: 2e-3, compliance: 0}
curves: {own: 8}
"""
CLASSES = {
    "points": PointSightings, "poses": PoseSightings, "pixels": PixelSightings, "touches": Touches,
    "distances": Distances, "plane": PlaneContacts, "stereo": StereoSightings,
}  # fmt: skip


def residuals(one: Instrument) -> Array:
    own = tuple(np.zeros(len(block.names)) for block in one.blocks)
    return one.equations(arm().poses(one.joints), own).residuals


def test_every_kind_is_read_and_placed(folder: Path):
    found = load_description(written(folder, ALL), arm())
    assert set(CLASSES) == set(KINDS)
    assert [type(one) for one in found.measurements] == list(CLASSES.values())
    for kind, one in zip(CLASSES, found.measurements, strict=True):
        if kind != "plane":
            np.testing.assert_allclose(residuals(one), 0.0, atol=2e-3, err_msg=kind)
    assert found.sheet.shift == 2e-3
    assert found.sheet.compliance == 0.0
    assert found.sheet.curves == CurveTerms(8, FINE.others)
    tracker, camera, eye, touches, *_ = found.measurements
    assert tracker.channels == ("position of tracker",) * 3
    np.testing.assert_array_equal(tracker.std, 1e-5)
    np.testing.assert_array_equal(camera.std[0], [1e-4] * 3 + [1e-3] * 3)
    assert [block.name for block in eye.blocks] == ["frame of eye", "ball", "eye"]
    assert isinstance(touches, Touches)
    assert touches.touched.tolist() == [0] * 6 + [1] * 7
    assert touches.sight.points.tolerance.tolist() == [0.002] * 3


def test_what_is_stated_of_a_frame_holds(folder: Path):
    T = EYE.copy()
    wxyz = wxyz_from_matrix(T[:3, :3])
    numbers = ", ".join(f"{n:.12g}" for n in [*T[:3, 3], *wxyz])
    text = f"""\
measurements:
  - {{kind: points, file: points.csv, sensor: tracker, target: ball}}
frames:
  tracker:
    pose: [{numbers}]
"""
    (one,) = load_description(written(folder, text), arm()).measurements
    assert [block.name for block in one.blocks] == ["ball"]
    np.testing.assert_allclose(residuals(one), 0.0, atol=1e-9)
    loose = text + "    shift: 0.01\n    turn: 0\n"
    (one,) = load_description(written(folder, loose), arm()).measurements
    frame = one.unknowns[0]
    assert isinstance(frame, Frame)
    assert frame.tolerance.tolist() == [0.01] * 3 + [0.0] * 3


def test_boards_may_be_grids_and_columns_may_have_other_names(folder: Path, tmp_path: Path):
    rng = np.random.default_rng(4)
    q = np.repeat(rng.uniform(-1.5, 1.5, (8, 6)), 6, axis=0)
    which = np.tile(np.arange(6), 8)
    board = 0.1 * np.array([(i, k, 0.0) for k in range(2) for i in range(3)])
    s = transform(invert(EYE), transform(arm().poses(q), board[which]))
    uv = 1000.0 * s[:, :2] / s[:, 2:] + [640.0, 480.0]
    table(tmp_path / "corners.csv", q, corner=which, u_px=uv[:, 0], v_px=uv[:, 1])
    text = """\
robot: ur10
measurements:
  - kind: pixels
    file: corners.csv
    camera: eye
    board: corners
    columns: {point: corner}
points: {corners: {grid: [3, 2, 0.1]}}
cameras: {eye: {matrix: [1000, 1000, 640, 480]}}
"""
    found = load_description(written(tmp_path, text))
    (one,) = found.measurements
    assert isinstance(one, PixelSightings)
    np.testing.assert_allclose(one.sight.points.reference, board)
    assert isinstance(one.sight.points, Points)
    assert one.sight.points.block is None
    np.testing.assert_allclose(residuals(one), 0.0, atol=1e-3)
    assert found.arm.name == "ur10"
    assert folder != tmp_path


SLIPS = {
    "sensors: 1\n" + POINTS: r"setup.yaml, line 1, sensors: is not known here: .*measurements",
    "robot: ur10\n": "setup.yaml, line 1: needs measurements",
    "measurements: []\n": "line 1, measurements: is empty: list one or more of points",
    "measurements: 3\n": "line 1, measurements: must be a list, got 3",
    "measurements:\n  - {file: points.csv}\n": "line 2, measurements 1: needs kind, one of points",
    POINTS.replace("points,", "point,"): "1: kind: 'point' is not known: did you mean points",
    POINTS.replace("file: points.csv, ", ""): "line 2, measurements 1: needs file",
    POINTS.replace("points.csv", "other.csv"): r"file: .*other.csv is not there",
    POINTS.replace("points.csv", "pixels.csv"): "lacks the columns x_m, y_m, z_m",
    POINTS.replace("sensor:", "sensr:"): "sensr: is not known here: did you mean sensor",
    POINTS.replace("ball}", "ball, std: wide}"): "std: must be a number, got 'wide'",
    POINTS.replace("ball}", "ball, std: -1}"): "1: std of PointSightings must be at least",
    POINTS.replace("ball}", "ball, setup: eye_on_hand}"): "setup: 'eye_on_hand' is not known",
    POINTS + "frames: {trakcer: {pose: [0, 0, 0, 1, 0, 0, 0]}}\n": "no measurement uses trakcer",
    POINTS + "frames: {tracker: {pose: [0, 0, 0]}}\n": r"3, frames: tracker: pose: must be \[x",
    POINTS + "points: {ball: {within: 1}}\n": "needs either `at`",
    POINTS + "points: {ball: {grid: [2, 2.5, 1]}}\n": r"must be \[columns, rows, spacing",
    POINTS + "arm: {sift: 1}\n": "arm: sift: is not known here: did you mean shift",
    POINTS + "arm: {shift: 0}\n": "line 3, arm: arm sheet: shift must be greater than 0",
    POINTS + "curves: {own: 1.5}\n": "curves: own: must be a whole number, got 1.5",
    POINTS + "cameras: {eye: {matrix: [1, 1, 1]}}\n": "eye: fx, fy, cx, cy must have shape",
    "measurements:\n  - {kind: pixels, file: pixels.csv}\n": "describe the camera camera under",
    "measurements:\n  - {kind: touches, file: touches.csv, geometry: [[0, 0, 0]]}\n":
        "geometry: must list x, y, z of the 2 places place 4, 9",
    POINTS + POINTS: "line 3, measurements: comes twice, first in line 1",
    "measurements:\n  - {kind: plane, file: short.csv}\n":
        "line 2, measurements 1: plane needs at least 4 contacts to be placed, got 2",
    "measurements:\n  - {kind: pixels, file: pixels.csv, camera: eye}\n"
    "cameras: {eye: {matrix: [1, 1, 0, 0], size: [640]}}\n":
        r"size: must be \[width, height\] in pixels",
    POINTS + "cameras: {eye: {within: 1}}\n": "eye: needs either `matrix`",
    POINTS + "cameras: {eye: {camera_info: ros.yaml, size: [1, 1]}}\n": "has distortion and size",
    POINTS + "cameras: {eye: {camera_info: setup.yaml}}\n": "lacks image_width, image_height",
}  # fmt: skip


@pytest.mark.parametrize("text", SLIPS)
def test_a_slip_is_named_with_its_line(folder: Path, text: str):
    with pytest.raises(InvalidInput, match=SLIPS[text]):
        load_description(written(folder, text), arm())


def test_files_that_are_no_descriptions(folder: Path):
    with pytest.raises(FileFormatError, match=r"line 3: is not YAML .* check indentation"):
        load_description(written(folder, "measurements:\n  - {kind: points\nrobot: ur10\n"), arm())
    with pytest.raises(InvalidInput, match="is empty"):
        load_description(written(folder, "# nothing\n"), arm())
    with pytest.raises(InvalidInput, match="cannot be read"):
        load_description(folder / "absent.yaml", arm())
    with pytest.raises(InvalidInput, match="says no `robot:`"):
        load_description(written(folder, POINTS))
    with pytest.raises(InvalidInput, match="line 1, robot: no robot is called 'ur11'"):
        load_description(written(folder, "robot: ur11\n" + POINTS))
