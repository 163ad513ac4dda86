"""What is read of the tables and cameras of a description, and which of it is refused."""

from pathlib import Path

import numpy as np
import pytest
from tests.calibration.arm.arms import arm
from tests.calibration.setups.described import EYE, POINTS, N, tables, written

from handeye.calibration.arm.measurements import Numbers, PixelSightings
from handeye.calibration.setups.description import load_description
from handeye.errors import HandeyeError, InvalidInput, LogError
from handeye.geometry import wxyz_from_matrix
from handeye.io.yaml_files import camera_info_yaml


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tables(tmp_path_factory.mktemp("described"))


def test_bad_rows_are_named_or_left_out(folder: Path, tmp_path: Path):
    lines = (folder / "points.csv").read_text(encoding="utf-8").splitlines()
    lines[3] = lines[3].rsplit(",", 1)[0] + ",lost"
    (tmp_path / "points.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    path = written(tmp_path, POINTS)
    with pytest.raises(LogError, match="row 4: z_m is 'lost'"):
        load_description(path, arm())
    (one,) = load_description(path, arm(), skip_bad=True).measurements
    assert len(one.joints) == N - 1
    assert issubclass(LogError, HandeyeError)


MISTAKEN = {
    "degrees": ("shoulder_pan_joint_rad", 180.0 / np.pi, "joints go up to .* multiply them by"),
    "millimetres": ("x_m", 1000.0, "25 rows of x_m, y_m, z_m are farther .* divide them by 1000"),
}


@pytest.mark.parametrize("unit", MISTAKEN)
def test_other_units_are_noticed(folder: Path, tmp_path: Path, unit: str):
    column, times, message = MISTAKEN[unit]
    header, *rows = (folder / "points.csv").read_text(encoding="utf-8").splitlines()
    names = header.split(",")
    values = np.array([row.split(",") for row in rows], float)
    values[:, names.index(column)] *= times
    np.savetxt(tmp_path / "points.csv", values, delimiter=",", header=header, comments="")
    with pytest.raises(InvalidInput, match=message):
        load_description(written(tmp_path, POINTS), arm())


def test_pixels_beside_the_picture_are_rejected(folder: Path, tmp_path: Path):
    (tmp_path / "pixels.csv").write_bytes((folder / "pixels.csv").read_bytes())
    text = """\
measurements:
  - {kind: pixels, file: pixels.csv, camera: eye, target: ball}
cameras: {eye: {matrix: [1000, 1000, 640, 480], size: [900, 700]}}
"""
    path = written(tmp_path, text)
    with pytest.raises(LogError, match="outside the picture of 900 x 700 pixels; correct or"):
        load_description(path, arm())
    found = load_description(path, arm(), skip_bad=True)
    (one,), (source,) = found.measurements, found.sources
    assert isinstance(one, PixelSightings)
    assert 6 <= len(one.joints) < N
    assert np.all(one.measured < [899.5, 699.5])
    assert len(source.rows) == len(one.joints) == N - len(source.rejected)
    assert found.sizes == {"eye": (900, 700)}


def test_cameras_may_be_as_ros_keeps_them(folder: Path):
    numbers = [-0.1, 0.02, 0.001, -0.002, 0.0]
    K = np.array([[1000.0, 0.0, 640.0], [0.0, 1000.0, 480.0], [0.0, 0.0, 1.0]])
    info = camera_info_yaml("eye", (1280, 960), K, np.array(numbers))
    written(folder, info, "ros.yaml")
    text = """\
measurements:
  - {kind: pixels, file: pixels.csv, camera: eye, target: ball}
cameras: {eye: {camera_info: ros.yaml, within: 1}}
"""
    found = load_description(written(folder, text), arm(), skip_bad=True)
    camera = found.stated["eye"]
    assert isinstance(camera, Numbers)
    assert camera.reference.tolist() == [1000.0, 1000.0, 640.0, 480.0, *numbers]
    assert found.sizes == {"eye": (1280, 960)}


def test_what_each_row_states_counts_unless_the_file_says_otherwise(folder: Path, tmp_path: Path):
    header, *rows = (folder / "points.csv").read_text(encoding="utf-8").splitlines()
    stds = [f"{row},{1e-4 * (1 + i % 3)},2e-4,3e-4" for i, row in enumerate(rows)]
    text = "\n".join([f"{header},std_x_m,std_y_m,std_z_m", *stds]) + "\n"
    (tmp_path / "points.csv").write_text(text, encoding="utf-8")
    (one,) = load_description(written(tmp_path, POINTS), arm()).measurements
    np.testing.assert_allclose(one.std[:4, 0], [1e-4, 2e-4, 3e-4, 1e-4])
    np.testing.assert_allclose(one.std[:, 2], 3e-4)
    (one,) = load_description(
        written(tmp_path, POINTS.replace("ball}", "ball, std: 5e-5}")), arm()
    ).measurements
    np.testing.assert_array_equal(one.std, 5e-5)


def test_what_is_stated_stays_where_it_is_stated(folder: Path):
    """Its prior is about there, although an arm without errors would fit better elsewhere."""
    T = EYE.copy()
    wxyz = wxyz_from_matrix(T[:3, :3])
    numbers = ", ".join(f"{n:.12g}" for n in [*(T[:3, 3] + [0.004, 0.0, 0.0]), *wxyz])
    text = POINTS + f"frames:\n  tracker: {{pose: [{numbers}], shift: 0.01, turn: 0.01}}\n"
    found = load_description(written(folder, text), arm())
    stated, placed = (
        one[0].unknowns[0].reference  # pyright: ignore[reportAttributeAccessIssue]
        for one in (found.measurements, found.placed)
    )
    np.testing.assert_allclose(stated[:3, 3] - T[:3, 3], [0.004, 0.0, 0.0], atol=1e-11)
    assert np.linalg.norm(placed[:3, 3] - T[:3, 3]) < 1e-3


def test_rows_at_the_same_joints_are_held_out_together(folder: Path):
    (one,) = load_description(written(folder, POINTS), arm()).measurements
    thrice = np.repeat(np.arange(10), 3)
    assert one.only(np.arange(10)).folds(5).tolist() == [0, 0, 1, 1, 2, 2, 3, 3, 4, 4]
    assert one.only(thrice).folds(3).tolist() == [0] * 12 + [1] * 9 + [2] * 9


def test_what_is_stated_of_a_head_counts(folder: Path):
    text = "measurements:\n  - {kind: stereo, file: stereo.csv, std: [2e-3, 1e-3]}\n"
    (one,) = load_description(written(folder, text), arm()).measurements
    np.testing.assert_array_equal(one.std, np.tile([2e-3, 1e-3], (N, 1)))
    plain = text.replace(", std: [2e-3, 1e-3]", "")
    (own,) = load_description(written(folder, plain), arm()).measurements
    assert len(np.unique(own.std[:, 0])) > 1
