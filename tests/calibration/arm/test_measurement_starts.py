from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.calibration.arm.measured import flanges, inverse, looking, pose, zeros

from handeye.arrays import Array, Integers
from handeye.calibration.arm.measurements import (
    Distances,
    Instrument,
    PixelSightings,
    PlaneContacts,
    Points,
    PointSightings,
    PoseSightings,
    StereoSightings,
    Touches,
    lens,
)
from handeye.calibration.hand_eye.samples import Setup
from handeye.errors import InvalidInput
from handeye.geometry import make_pose, transform
from handeye.sensors.stereo import StereoHead

SETUPS: tuple[Setup, ...] = ("eye_to_hand", "eye_in_hand")
CAMERA = lens("eye", (900.0, 910.0, 640.0, 360.0), (-0.2, 0.05, 1e-3, -2e-3, 0.01))
BOARD = np.array([(0.03 * x, 0.03 * y, 0.0) for x in range(5) for y in range(4)])
N = 30


def carrier(setup: Setup, flange: Array) -> Array:
    return flange if setup == "eye_to_hand" else inverse(flange)


def exact(kind: Instrument, poses: Array, atol: float = 1e-6) -> None:
    """Nothing is left over: the start has found the truth, or what cannot be told from it."""
    r = kind.equations(poses, zeros(kind)).residuals
    assert len(r)
    np.testing.assert_allclose(r, 0.0, atol=atol)


@pytest.mark.parametrize("setup", SETUPS)
def test_a_point_sensor_and_its_point_are_placed(setup: Setup):
    rng = np.random.default_rng(1)
    A, P, c = flanges(rng, N), looking(rng), np.array([0.08, -0.05, 0.12])
    s = np.array([inverse(P) @ carrier(setup, a) @ [*c, 1.0] for a in A])[:, :3]
    kind = PointSightings.start(np.zeros((N, 6)), A, s, setup=setup)
    exact(kind, A)
    np.testing.assert_allclose(kind.sight.sensor.reference, P, atol=1e-6)
    np.testing.assert_allclose(kind.sight.points.reference[0], c, atol=1e-6)


def test_a_point_sensor_is_placed_although_points_are_wrong():
    rng = np.random.default_rng(2)
    A, P, c = flanges(rng, 60), looking(rng), np.array([0.08, -0.05, 0.12])
    s = transform(inverse(P), transform(A, c)) + 1e-4 * rng.standard_normal((60, 3))
    s[:6] += 0.2
    kind = PointSightings.start(np.zeros((60, 6)), A, s)
    np.testing.assert_allclose(kind.sight.points.reference[0], c, atol=3e-4)


@pytest.mark.parametrize("setup", SETUPS)
def test_a_pose_sensor_and_its_target_are_placed(setup: Setup):
    rng = np.random.default_rng(3)
    A, P, Q = flanges(rng, N), pose(rng), pose(rng)
    S = np.array([inverse(P) @ carrier(setup, a) @ Q for a in A])
    kind = PoseSightings.start(np.zeros((N, 6)), A, S, setup=setup, sensor="eye", target="tag")
    exact(kind, A)
    np.testing.assert_allclose(kind.sight.sensor.reference, P, atol=1e-6)
    np.testing.assert_allclose(kind.sight.target.reference, Q, atol=1e-6)
    assert [block.name for block in kind.blocks] == ["eye", "tag"]


def naive_pixels(s: Array) -> Array:
    fx, fy, cx, cy, k1, k2, p1, p2, k3 = CAMERA.reference
    out: list[tuple[float, float]] = []
    for x, y, z in s:
        a, b = x / z, y / z
        q = a**2 + b**2
        g = 1 + k1 * q + k2 * q**2 + k3 * q**3
        u = fx * (a * g + 2 * p1 * a * b + p2 * (q + 2 * a**2)) + cx
        v = fy * (b * g + p1 * (q + 2 * b**2) + 2 * p2 * a * b) + cy
        out.append((u, v))
    return np.array(out)


def views(rng: np.random.Generator, n: int) -> tuple[Array, Array, Array]:
    """Flanges (n, 4, 4), a camera in the hand, and a target in the base's frame in its picture."""
    X, Z = pose(rng, 0.05), pose(rng)
    A = np.empty((n, 4, 4))
    for i in range(n):
        turn = Rotation.from_rotvec(rng.uniform(-0.4, 0.4, 3)).as_matrix()
        seen = make_pose(turn, [*rng.uniform(-0.15, 0.15, 2), rng.uniform(0.4, 0.7)])
        A[i] = Z @ inverse(seen) @ inverse(X)
    return A, X, Z


@pytest.mark.parametrize("setup", SETUPS)
@pytest.mark.parametrize("solid", [False, True])
def test_a_camera_and_a_board_are_placed(setup: Setup, solid: bool):
    rng = np.random.default_rng(4)
    A, X, Z = views(rng, 10)
    if setup == "eye_to_hand":
        A = inverse(A)
    shape = BOARD + ([0.0, 0.0, 0.03] * rng.standard_normal((len(BOARD), 1)) if solid else 0.0)
    which = np.tile(np.arange(len(shape)), len(A))
    rows = np.repeat(A, len(shape), axis=0)
    s = np.array(
        [
            (inverse(X) @ carrier(setup, a) @ Z @ [*shape[k], 1.0])[:3]
            for a, k in zip(rows, which, strict=True)
        ]
    )
    kind = PixelSightings.start(
        np.zeros((len(rows), 6)), rows, naive_pixels(s), camera=CAMERA,
        board=Points.known("corners", shape), which=which, setup=setup,
    )  # fmt: skip
    exact(kind, rows, 1e-4)
    np.testing.assert_allclose(kind.sight.sensor.reference, X, atol=1e-6)
    np.testing.assert_allclose(kind.sight.target.reference, Z, atol=1e-6)


@pytest.mark.parametrize("setup", SETUPS)
@pytest.mark.parametrize("seed", range(4))
def test_a_camera_and_a_single_point_are_placed(setup: Setup, seed: int):
    rng = np.random.default_rng(seed)
    if setup == "eye_in_hand":
        A, P, Z = views(rng, N)
        c = Z[:3, 3]
    else:
        A, P, c = flanges(rng, N), looking(rng, 2.5), 0.06 * rng.standard_normal(3)
    s = np.array([inverse(P) @ carrier(setup, a) @ [*c, 1.0] for a in A])[:, :3]
    kind = PixelSightings.start(np.zeros((N, 6)), A, naive_pixels(s), camera=CAMERA, setup=setup)
    exact(kind, A, 1e-3)
    np.testing.assert_allclose(kind.sight.points.reference[0], c, atol=1e-4)


@pytest.mark.parametrize("zero", [0.0, 0.07])
def test_the_anchor_of_a_wire_is_placed(zero: float):
    rng = np.random.default_rng(5)
    A, anchor, c = flanges(rng, N), np.array([1.2, -0.4, 0.3]), np.array([0.02, 0.03, 0.05])
    d = np.linalg.norm(transform(A, c) - anchor, axis=1) + zero
    kind = Distances.start(np.zeros((N, 6)), A, d, zero_std=0.1 if zero else 0.0)
    exact(kind, A)
    np.testing.assert_allclose(kind.sight.sensor.reference[:3, 3], anchor, atol=1e-5)
    np.testing.assert_allclose(kind.sight.points.reference[0], c, atol=1e-5)
    names = ["anchor", "wire end", *["anchor zero"] * (zero > 0.0)]
    assert [b.name for b in kind.blocks] == names


def test_a_ball_bar_of_unknown_anchor_is_placed():
    rng = np.random.default_rng(6)
    anchor, bar = np.array([0.5, 0.1, 0.2]), 0.3
    away = rng.standard_normal((N, 3))
    ends = anchor + bar * away / np.linalg.norm(away, axis=1, keepdims=True)
    A = make_pose(flanges(rng, N)[:, :3, :3], ends)
    kind = Distances.start(
        np.zeros((N, 6)), A, np.full(N, bar), tip=Points.known(), zero_std=1e-5, anchor="socket"
    )
    exact(kind, A)
    np.testing.assert_allclose(kind.sight.sensor.reference[:3, 3], anchor, atol=1e-6)


def test_a_plane_is_placed():
    rng = np.random.default_rng(7)
    T = pose(rng)
    tips = transform(T, np.column_stack([0.3 * rng.standard_normal((N, 2)), np.zeros(N)]))
    A = make_pose(flanges(rng, N)[:, :3, :3], tips)
    kind = PlaneContacts.start(np.zeros((N, 6)), A)
    exact(kind, A)
    assert abs(kind.sight.sensor.reference[:3, 2] @ T[:3, 2]) == pytest.approx(1.0, abs=1e-12)
    assert kind.blocks[0].names == ("plane z", "plane rx", "plane ry")


def test_a_gauge_counts_up_from_its_plane():
    rng = np.random.default_rng(12)
    T, high = pose(rng), rng.uniform(-0.1, 0.3, N)
    tips = transform(T, np.column_stack([0.3 * rng.standard_normal((N, 2)), high]))
    A = make_pose(flanges(rng, N)[:, :3, :3], tips)
    kind = PlaneContacts.start(np.zeros((N, 6)), A, heights=high)
    exact(kind, A)
    np.testing.assert_array_equal(kind.measured[:, 0], high)
    assert kind.sight.sensor.reference[:3, 2] @ T[:3, 2] == pytest.approx(1.0, abs=1e-9)


def in_sockets(rng: np.random.Generator, sockets: Array) -> tuple[Array, Integers, Array]:
    which = np.concatenate([np.arange(len(sockets)), rng.integers(0, len(sockets), N)])
    tip = np.array([0.01, -0.02, 0.1])
    R = flanges(rng, len(which))[:, :3, :3]
    return make_pose(R, sockets[which] - R @ tip), which, tip


@pytest.mark.parametrize("count", [1, 2, 3])
def test_sockets_of_known_geometry_are_placed(count: int):
    rng = np.random.default_rng(8)
    geometry = np.array([[0.0, 0.0, 0.0], [0.05, 0.0, 0.0], [0.0, 0.05, 0.01]])[:count]
    A, which, tip = in_sockets(rng, transform(pose(rng), geometry))
    held = Points.near("tip", tip[np.newaxis], 1e-3)
    kind = Touches.start(np.zeros((len(A), 7)), A, which, geometry=geometry, tip=held)
    exact(kind, A)
    assert [b.name for b in kind.blocks] == ["plate", "tip"]


def test_free_points_touched_again_are_where_the_tip_was():
    rng = np.random.default_rng(9)
    places = rng.standard_normal((3, 3))
    A, which, tip = in_sockets(rng, places)
    kind = Touches.start(np.zeros((len(A), 7)), A, which, tip=Points.known("tip", tip[np.newaxis]))
    exact(kind, A)
    np.testing.assert_allclose(kind.places.reference, places, atol=1e-12)
    assert [(b.name, len(b.names)) for b in kind.blocks] == [("plate", 9)]


def test_a_stereo_head_is_placed():
    rng = np.random.default_rng(10)
    A, c = flanges(rng, N), np.array([0.03, 0.02, 0.05])
    V = make_pose(Rotation.from_rotvec([0.1, -0.2, 0.4]).as_matrix(), [-1.0, 0.2, 0.1])
    s = transform(inverse(V), transform(A, c))
    off = rng.uniform(-0.3, 0.3, N)
    head = StereoHead(eccentricity_warp=0.04, range_warp=0.03, range_scale=0.9)
    quiet = replace(head, pixel_pitch=0.0)
    r, eps = quiet.measure(np.hypot(s[:, 0], s[:, 1]), off, np.zeros((N, 2)))
    pointing = np.arctan2(s[:, 1], s[:, 0]) - off
    kind = StereoSightings.start(np.zeros((N, 6)), A, np.stack([r, eps], -1), pointing, head=head)
    exact(kind, A, 1e-5)
    np.testing.assert_allclose(kind.std[:, 0], head.range_std(r, eps))


FEW: dict[str, tuple[str, Callable[[Array, Array], Instrument]]] = {
    "points": ("at least 5", lambda q, A: PointSightings.start(q, A, A[:, :3, 3])),
    "wire": ("at least 5", lambda q, A: Distances.start(q, A, A[:, 0, 3])),
    "plane": ("at least 4", PlaneContacts.start),
    "head": ("at least 6", lambda q, A: StereoSightings.start(q, A, A[:, :2, 3], A[:, 0, 3])),
    "pixels": ("at least 6", lambda q, A: PixelSightings.start(q, A, A[:, :2, 3], camera=CAMERA)),
    "board": (
        "at least 3 pictures",
        lambda q, A: PixelSightings.start(
            q, A, A[:, :2, 3], camera=CAMERA, board=Points.known("b", BOARD)
        ),
    ),
}


@pytest.mark.parametrize("name", FEW)
def test_too_few_rows_are_refused_with_what_is_needed(name: str):
    message, make = FEW[name]
    with pytest.raises(InvalidInput, match=message):
        make(np.zeros((3, 6)), flanges(np.random.default_rng(0), 3))
