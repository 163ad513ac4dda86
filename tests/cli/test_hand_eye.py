"""`handeye hand-eye`: from a table of pairs to where the camera sits."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
import yaml
from scipy.spatial.transform import Rotation
from tests.cli.running import done, refused

from handeye.geometry import invert, make_pose, wxyz_from_matrix
from handeye.io.pairs import read_pairs

NAMES = ("x_m", "y_m", "z_m", "qw", "qx", "qy", "qz")
HEADER = [prefix + name for prefix in ("flange_", "target_") for name in NAMES]


def poses(rng, n, size):
    return make_pose(Rotation.random(n, rng=rng).as_matrix(), rng.normal(size=(n, 3)) * size)


def flat(T):
    return np.column_stack([T[:, :3, 3], wxyz_from_matrix(T[:, :3, :3])])


def write(path: Path, flanges, sensed, header=HEADER) -> Path:
    with path.open("w", newline="") as file:
        rows = np.hstack([flat(flanges), flat(sensed)]).tolist()
        csv.writer(file).writerows([header, *rows])
    return path


@pytest.fixture
def scene():
    """X, Z, flanges and what the camera in the hand sees, exactly."""
    rng = np.random.default_rng(4)
    X, Z = poses(rng, 2, 0.2)
    A = poses(rng, 15, 0.3)
    return X, Z, A, invert(A @ X) @ Z


def test_pairs_are_read_back(tmp_path, scene):
    _, _, A, B = scene
    read = read_pairs(write(tmp_path / "pairs.csv", A, B))
    np.testing.assert_allclose(read.flanges, A, atol=1e-14)
    np.testing.assert_allclose(read.sensed, B, atol=1e-14)
    np.testing.assert_array_equal(read.rows, np.arange(2, 17))


def test_the_camera_in_the_hand_is_found(tmp_path, scene):
    X, Z, A, B = scene
    B[3, :3, 3] += 0.3
    path = write(tmp_path / "pairs.csv", A, B)
    files = ("--json", tmp_path / "r.json", "--yaml", tmp_path / "eye.calib")
    shown = done("hand-eye", path, *files, "--name", "wrist", "--camera-frame", "eye").stdout
    data = json.loads((tmp_path / "r.json").read_text())
    assert data["determined"]
    np.testing.assert_allclose(data["T_flange_camera"]["matrix"], X, atol=1e-6)
    np.testing.assert_allclose(data["T_base_target"]["position"], Z[:3, 3], atol=1e-6)
    # The header is row 1, so the fourth pair stands in row 5.
    assert data["outlier_rows"] == [5]
    assert data["samples"]["row"] == list(range(2, 17))
    assert np.argmin(data["samples"]["good"]) == 3
    assert "an outlier, left out" in shown
    read = yaml.safe_load((tmp_path / "eye.calib").read_text())
    assert read["parameters"]["calibration_type"] == "eye_in_hand"
    assert (read["parameters"]["name"], read["parameters"]["tracking_base_frame"]) == (
        "wrist",
        "eye",
    )
    at = read["transform"]["translation"]
    np.testing.assert_allclose([at[k] for k in "xyz"], X[:3, 3], atol=1e-6)


def test_the_camera_in_the_world_is_found(tmp_path, scene):
    X, Z, A, _ = scene
    path = write(tmp_path / "pairs.csv", A, invert(Z) @ A @ X)
    out = ("--eye-to-hand", "--json", "-", "--yaml", tmp_path / "world.calib")
    data = json.loads(done("hand-eye", path, *out).stdout)
    np.testing.assert_allclose(data["T_base_camera"]["matrix"], Z, atol=1e-6)
    np.testing.assert_allclose(data["T_flange_target"]["matrix"], X, atol=1e-6)
    at = yaml.safe_load((tmp_path / "world.calib").read_text())["transform"]["translation"]
    np.testing.assert_allclose([at[k] for k in "xyz"], Z[:3, 3], atol=1e-6)


def test_an_unknown_unit_is_estimated(tmp_path, scene):
    _, _, A, B = scene
    B[:, :3, 3] *= 1000.0
    data = json.loads(
        done("hand-eye", write(tmp_path / "p.csv", A, B), "--free-scale", "--json", "-").stdout
    )
    assert data["scale"] == pytest.approx(1000.0, rel=1e-6)


def test_what_the_motion_leaves_open_is_said(tmp_path, scene):
    X, Z, _, _ = scene
    turns = np.linspace(0, 2, 12)[:, None] * np.array([0, 0, 1.0])
    places = np.random.default_rng(1).normal(size=(12, 3)) * 0.2
    A = make_pose(Rotation.from_rotvec(turns).as_matrix(), places)
    path = write(tmp_path / "pairs.csv", A, invert(A @ X) @ Z)
    data = json.loads(done("hand-eye", path, "--json", "-").stdout)
    assert not data["determined"]
    assert data["undetermined"] == [
        "translation of the camera along (0.00, 0.00, 1.00) of the flange"
    ]


def test_with_the_robot_a_log_is_enough(tmp_path):
    pytest.importorskip("pinocchio")
    from handeye.robots.urdf import load_arm  # noqa: PLC0415

    rng = np.random.default_rng(2)
    arm = load_arm("ur10")
    joints = rng.uniform(-1.5, 1.5, (25, 6))
    X, Z = poses(rng, 2, 0.2)
    seen = flat(invert(arm.poses(joints) @ X) @ Z)
    names = ["time_s", *(f"{n}_rad" for n in arm.joint_names), *NAMES]
    with (tmp_path / "log.csv").open("w", newline="") as file:
        rows = np.column_stack([np.arange(25), joints, seen]).tolist()
        csv.writer(file).writerows([names, *rows])
    out = ("--robot", "ur10", "--json", "-")
    data = json.loads(done("hand-eye", tmp_path / "log.csv", *out).stdout)
    np.testing.assert_allclose(data["T_flange_camera"]["matrix"], X, atol=1e-4)
    assert "--free-scale" in refused("hand-eye", tmp_path / "log.csv", *out, "--free-scale")
    with (tmp_path / "log.csv").open("w", newline="") as file:
        csv.writer(file).writerows([names[:-4], *[row[:-4] for row in rows]])
    assert "orientation" in refused("hand-eye", tmp_path / "log.csv", *out)


def test_bad_tables_and_places_are_explained(tmp_path, scene):
    _, _, A, B = scene
    path = write(
        tmp_path / "pairs.csv", A, B, [n.replace("flange_x_m", "flange_x_mm") for n in HEADER]
    )
    said = refused("hand-eye", path)
    assert "missing columns: flange_x_m" in said
    assert "divide it by 1000" in said
    rows = write(tmp_path / "pairs.csv", A, B).read_text().splitlines()
    rows[2] = "9," + rows[2].split(",", 1)[1]
    rows[4] = ",".join([*rows[4].split(",")[:3], "0.5", "0", "0", "0", *rows[4].split(",")[7:]])
    rows[6] = rows[6].replace(",", ",oops", 1)
    path.write_text("\n".join(rows))
    said = refused("hand-eye", path)
    assert "row 5: the quaternion flange_qw, flange_qx, flange_qy, flange_qz has length 0.5" in said
    assert "row 7: flange_y_m is 'oops" in said
    data = json.loads(done("hand-eye", path, "--skip-bad", "--json", "-").stdout)
    assert (data["n_observations"], data["n_rejected"]) == (13, 2)
    assert data["outlier_rows"] == [3]
    for option in ("--json", "--yaml"):
        assert "there is no folder" in refused("hand-eye", path, option, tmp_path / "no" / "file")
    assert not (tmp_path / "no").exists()
    few = write(tmp_path / "few.csv", A[:2], B[:2])
    assert "at least 3 poses" in refused("hand-eye", few)


def test_a_table_that_was_meant_in_another_way_is_explained(tmp_path, scene):
    _, _, A, B = scene
    names = [*NAMES[:3], "qx", "qy", "qz", "qw"]
    header = [prefix + name for prefix in ("flange_", "target_") for name in names]
    said = done("hand-eye", write(tmp_path / "p.csv", A, B, header)).stdout
    assert "the quaternions of flange and target were read as x, y, z, w but are w, x, y, z" in said
    said = done("hand-eye", write(tmp_path / "p.csv", A[[0] * 6], B[[0] * 6])).stdout
    assert "the flange does not turn: add poses" in said
