"""Tables of every kind of measurement, of a small arm without errors."""

from pathlib import Path

import numpy as np
from tests.calibration.arm.arms import arm
from tests.calibration.arm.measured import looking, pose

from handeye.arrays import Array, Integers
from handeye.geometry import invert, transform, wxyz_from_matrix

N = 25
JOINTS = [f"{name}_rad" for name in arm().joint_names]
MARKER = np.array([0.03, -0.02, 0.08])
EYE = looking(np.random.default_rng(1), 3.5)
K = (1000.0, 1000.0, 640.0, 480.0)


def table(path: Path, joints: Array, **columns: Array | Integers) -> None:
    values = np.column_stack([joints, *columns.values()])
    header = ",".join([*JOINTS, *columns])
    np.savetxt(path, values, delimiter=",", header=header, comments="", fmt="%.12g")


def tables(place: Path) -> Path:
    """A table of each kind, of an arm without errors."""
    rng = np.random.default_rng(0)
    q = rng.uniform(-2.0, 2.0, (N, 6))
    A = arm().poses(q)
    p = transform(A, MARKER)
    s = transform(invert(EYE), p)
    xyz = dict(zip(("x_m", "y_m", "z_m"), s.T, strict=True))
    table(place / "points.csv", q, **xyz)
    X, Z = pose(rng), pose(rng)
    S = invert(A @ X) @ Z
    wxyz = wxyz_from_matrix(S[:, :3, :3])
    names = ("x_m", "y_m", "z_m", "qw", "qx", "qy", "qz")
    table(place / "poses.csv", q, **dict(zip(names, [*S[:, :3, 3].T, *wxyz.T], strict=True)))
    u, v = 1000.0 * s[:, 0] / s[:, 2] + 640.0, 1000.0 * s[:, 1] / s[:, 2] + 480.0
    table(place / "pixels.csv", q, u_px=u, v_px=v)
    still = np.repeat(q[:2], [6, 7], axis=0)
    table(place / "touches.csv", still, place=np.repeat([4, 9], [6, 7]))
    reel = np.array([1.4, 0.2, 0.1])
    table(place / "distances.csv", q, distance_m=np.linalg.norm(p - reel, axis=1) + 0.05)
    table(place / "plane.csv", np.tile(q[0], (5, 1)) + np.eye(6)[[5]] * np.arange(5)[:, np.newaxis])
    table(place / "short.csv", q[:2])
    head = transform(invert(pose(rng, 0.01, 0.1)), p + np.array([2.0, 0.0, 0.0]))
    pan = 0.9 * np.arctan2(head[:, 1], head[:, 0])
    r, eps = np.hypot(head[:, 0], head[:, 1]), np.arctan2(head[:, 1], head[:, 0]) - pan
    table(place / "stereo.csv", q, pointing_rad=pan, range_m=r, eccentricity_rad=eps)
    return place


def written(folder: Path, text: str, name: str = "setup.yaml") -> Path:
    (folder / name).write_text(text, encoding="utf-8")
    return folder / name


POINTS = "measurements:\n  - {kind: points, file: points.csv, sensor: tracker, target: ball}\n"
