"""Described set-ups in which something looks: trackers, probes and cameras."""

import numpy as np
from scipy.spatial.transform import Rotation
from tests.calibration.arm.measured import looking, pose
from tests.calibration.setups.setup_world import (
    FAR,
    GRID,
    LENS,
    MATRIX,
    PIXEL,
    Truth,
    World,
    carried,
    pixels,
    xyz,
)

from handeye.arrays import Array, Booleans
from handeye.geometry import invert, make_pose, transform, wxyz_from_matrix


def points(world: World, setup: str) -> Truth:
    q, P = world.joints(40), pose(world.rng, 1.0 if setup == "eye_to_hand" else 0.1)
    c = world.noise(0.05 if setup == "eye_to_hand" else 0.5, 3)
    s = transform(invert(P) @ carried(world, q, setup), c) + world.noise(FAR, 40, 3)
    world.table("points.csv", q, **xyz(s))
    text = f"  - {{kind: points, file: points.csv, setup: {setup}, target: ball}}\n"
    return Truth(text, {"sensor": P, "ball": c})


def poses(world: World, setup: str) -> Truth:
    q, P, Q = world.joints(25), pose(world.rng), pose(world.rng)
    S = invert(P) @ carried(world, q, setup) @ Q
    turns = Rotation.from_rotvec(world.noise(2e-4, 25, 3)).as_matrix()
    wxyz = wxyz_from_matrix(turns @ S[:, :3, :3])
    quaternion = dict(zip(("qw", "qx", "qy", "qz"), wxyz.T, strict=True))
    world.table("poses.csv", q, **xyz(S[:, :3, 3] + world.noise(FAR, 25, 3)), **quaternion)
    text = f"  - {{kind: poses, file: poses.csv, setup: {setup}, sensor: probe, target: tag}}\n"
    return Truth(text, {"probe": P, "tag": Q})


def camera(within: int = 0, name: str = "eye", lens: tuple[float, ...] = LENS) -> str:
    numbers = f"matrix: [{', '.join(map(str, MATRIX))}], distortion: [{', '.join(map(str, lens))}]"
    return f"cameras:\n  {name}: {{{numbers}, within: {within}, size: [1920, 1200]}}\n"


def in_picture(uv: Array) -> Booleans:
    return np.all((uv > 0.0) & (uv < [1919.0, 1199.0]), axis=1)


def seeing(world: World, n: int, X: Array, centre: Array) -> Array:
    """Joints (n, 6) at which a camera at X on the flange has a place of the base before it."""
    depth = world.rng.uniform(0.45, 0.7)

    def misses(flanges: Array) -> Array:
        s = transform(invert(flanges @ X), centre)
        return s - depth * np.array([0.1, -0.05, 1.0])

    return world.reaching(n, misses) + world.noise(0.03, n, 6)


def board(world: World, setup: str, within: int = 0) -> Truth:
    """A board on the flange, or a camera there."""
    if setup == "eye_to_hand":
        q, P, Q = world.joints(25), looking(world.rng, 3.0), pose(world.rng, 0.05)
    else:
        P, Q = pose(world.rng, 0.05, 0.3), make_pose(pose(world.rng)[:3, :3], [0.6, 0.2, 0.3])
        q = seeing(world, 20, P, transform(Q, GRID.mean(axis=0)))
    moved = invert(P) @ carried(world, q, setup) @ Q
    n, m = len(q), len(GRID)
    which, rows = np.tile(np.arange(m), n), np.repeat(np.arange(n), m)
    s = transform(moved[rows], GRID[which])
    numbers = np.array([*MATRIX, *LENS])
    if within:
        # What is true is as far from what is stated as the tolerances say.
        numbers = numbers + np.array([5, 5, 5, 5, 0.02, 0.05, 2e-3, 2e-3, 0]) * world.noise(1.0, 9)
    uv = (pixels(s, numbers[4:]) - MATRIX[2:]) / MATRIX[:2] * numbers[:2] + numbers[2:4]
    uv += world.noise(PIXEL, n * m, 2)
    good = in_picture(uv) & (s[:, 2] > 0.1)
    corner = which[good].astype(np.float64)
    world.table("corners.csv", q[rows[good]], point=corner, u_px=uv[good, 0], v_px=uv[good, 1])
    text = (
        f"  - {{kind: pixels, file: corners.csv, setup: {setup}, camera: eye, board: corners,"
        " target: board}\n" + camera(within) + "points:\n  corners: {grid: [5, 4, 0.04]}\n"
    )
    return Truth(text, {"frame of eye": P, "board": Q, **({"eye": numbers} if within else {})})


def spot(world: World, setup: str) -> Truth:
    """A single point: on the flange, or before a camera that is there."""
    if setup == "eye_to_hand":
        q, P, c = world.joints(150), looking(world.rng, 3.0), world.noise(0.05, 3)
    else:
        P, c = pose(world.rng, 0.05, 0.3), np.array([0.6, 0.2, 0.3])
        q = seeing(world, 60, P, c) + world.noise(0.1, 60, 6)
    s = transform(invert(P) @ carried(world, q, setup), c)
    uv = pixels(s) + world.noise(PIXEL, len(q), 2)
    good = in_picture(uv) & (s[:, 2] > 0.1)
    world.table("spot.csv", q[good], u_px=uv[good, 0], v_px=uv[good, 1])
    text = f"  - {{kind: pixels, file: spot.csv, setup: {setup}, camera: eye, target: dot}}\n"
    return Truth(text + camera(), {"frame of eye": P, "dot": c})


def two_cameras(world: World) -> Truth:
    c, of, text = world.noise(0.05, 3), dict[str, Array](), ""
    for name in ("left", "right"):
        q, P = world.joints(100), looking(world.rng, 3.0)
        s = transform(invert(P) @ world.flanges(q), c)
        uv = pixels(s) + world.noise(PIXEL, len(q), 2)
        good = in_picture(uv) & (s[:, 2] > 0.1)
        world.table(f"{name}.csv", q[good], u_px=uv[good, 0], v_px=uv[good, 1])
        text += (
            f"  - {{kind: pixels, file: {name}.csv, camera: {name}, name: {name}, target: dot}}\n"
        )
        of[f"frame of {name}"] = P
    right = camera(name="right").removeprefix("cameras:\n")
    return Truth(text + camera(name="left") + right, {**of, "dot": c})
