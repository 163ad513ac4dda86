"""Described set-ups with a known truth: tables of every kind, of an arm with errors, in files."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation
from tests.calibration.arm.measured import pose
from tests.calibration.setups.setup_seen import board, points, poses, spot, two_cameras
from tests.calibration.setups.setup_world import FAR, NEAR, PLAIN, Truth, World

from handeye.arrays import Array
from handeye.geometry import invert, make_pose, transform


def pin(world: World) -> Array:
    """A tip that is stated to within a millimetre."""
    return np.array([0.0, 0.0, 0.1]) + world.noise(1e-3, 3)


def touches(world: World, geometry: bool) -> Truth:
    tip, base = pin(world), np.array([0.6, 0.3, 0.2])
    plate = make_pose(pose(world.rng)[:3, :3], base)
    holes = np.array([(0.0, 0.0, 0.0), (0.15, 0.0, 0.0), (0.0, 0.12, 0.0)])
    places, qs, which = transform(plate, holes), list[Array](), list[int]()
    for k, place in enumerate(places):
        qs.append(world.reaching(25, lambda A, at=place: transform(A, tip) - at, NEAR))
        which += [k] * 25
    world.table("touches.csv", np.concatenate(qs), place=np.array(which))
    known = ", geometry: [[0, 0, 0], [0.15, 0, 0], [0, 0.12, 0]]" if geometry else ""
    text = f"  - {{kind: touches, file: touches.csv, plate: cones, tip: pin{known}}}\n"
    text += "points:\n  pin: {at: [0, 0, 0.1], within: 0.001}\n"
    return Truth(text, {"pin": tip, "cones": plate if geometry else places})


def distances(world: World) -> Truth:
    """A draw-wire of unknown zero, and a ball bar to another anchor."""
    end, ball = world.noise(0.05, 3), pin(world)
    reel, socket, bar = np.array([1.4, 0.3, 0.2]), np.array([0.6, -0.2, 0.2]), 0.3
    q, zero = world.joints(100), float(world.noise(0.05))
    d = np.linalg.norm(transform(world.flanges(q), end) - reel, axis=1)
    world.table("wire.csv", q, distance_m=d + zero + world.noise(FAR, 100))

    def too_long(flanges: Array) -> Array:
        away = np.linalg.norm(transform(flanges, ball) - socket, axis=1)
        return away[:, np.newaxis] - bar

    q = world.reaching(60, too_long, NEAR)
    world.table("bar.csv", q, distance_m=np.full(60, bar))
    text = """\
  - {kind: distances, file: wire.csv, anchor: reel, zero_within: 0.1, name: wire}
  - {kind: distances, file: bar.csv, anchor: socket, tip: ball, name: bar}
points:
  ball: {at: [0, 0, 0.1], within: 0.001}
"""
    return Truth(text, {"reel": reel, "wire end": end, "reel zero": np.array([zero]),
                        "socket": socket, "ball": ball})  # fmt: skip


def plane(world: World, gauge: bool) -> Truth:
    """A table that is touched, or above which a gauge tells how high the tip is."""
    tip = pin(world)
    turned = Rotation.from_rotvec(world.noise(0.1, 3)).as_matrix()
    table = make_pose(turned, [0.0, 0.0, 0.15])

    def high(flanges: Array) -> Array:
        return transform(invert(table), transform(flanges, tip))[:, 2:]

    q = world.joints(80) if gauge else world.reaching(80, high, NEAR)
    heights = high(world.flanges(q))[:, 0] + world.noise(NEAR, 80)
    world.table("plane.csv", q, **({"height_m": heights} if gauge else {}))
    text = "  - {kind: plane, file: plane.csv, tip: pin, plane: table}\n"
    text += "points:\n  pin: {at: [0, 0, 0.1], within: 0.001}\n"
    return Truth(text, {"pin": tip, "table": table})


def stereo(world: World) -> Truth:
    c, q = world.noise(0.03, 3), world.joints(150)
    P = make_pose(pose(world.rng, turn=1.0)[:3, :3], [-1.5, 0.2, 0.3])
    s = transform(invert(P) @ world.flanges(q), c)
    eta, zeta, sigma = 0.1 * world.noise(1.0, 3) + [0.0, 0.0, 1.0]
    r, angle, eps = np.hypot(s[:, 0], s[:, 1]), np.arctan2(s[:, 1], s[:, 0]), world.noise(0.2, 150)
    e = eta * np.sin(eps) ** 2 * (r + 2.0) / (r + 1.0)
    seen = sigma * r + zeta * (e + (r - 1.0) ** 2) + world.noise(2e-4, 150)
    world.table("head.csv", q, pointing_rad=angle - eps, range_m=seen,
                eccentricity_rad=eps + e + world.noise(1e-4, 150))  # fmt: skip
    text = "  - {kind: stereo, file: head.csv, target: dot, std: [2e-4, 1e-4]}\n"
    return Truth(text, {"dot": c, "head optics": np.array([eta, zeta, sigma])})


CASES: dict[str, Callable[[World], Truth]] = {
    "points, eye to hand": lambda world: points(world, "eye_to_hand"),
    "points, eye in hand": lambda world: points(world, "eye_in_hand"),
    "poses, eye to hand": lambda world: poses(world, "eye_to_hand"),
    "poses, eye in hand": lambda world: poses(world, "eye_in_hand"),
    "pixels of a board, eye to hand": lambda world: board(world, "eye_to_hand"),
    "pixels of a board, eye in hand": lambda world: board(world, "eye_in_hand"),
    "pixels through an unknown lens, eye to hand": lambda world: board(world, "eye_to_hand", 1),
    "pixels through an unknown lens, eye in hand": lambda world: board(world, "eye_in_hand", 1),
    "pixels of one point, eye to hand": lambda world: spot(world, "eye_to_hand"),
    "pixels of one point, eye in hand": lambda world: spot(world, "eye_in_hand"),
    "pixels of one point in two cameras": two_cameras,
    "points touched again": lambda world: touches(world, geometry=False),
    "points at known distances": lambda world: touches(world, geometry=True),
    "a draw-wire and a ball bar": distances,
    "a plane": lambda world: plane(world, gauge=False),
    "a gauge above a plane": lambda world: plane(world, gauge=True),
    "the stereo head": stereo,
}
"""Every kind of observation, as a description names it."""


def described(case: str, folder: Path, seed: int) -> Truth:
    """The set-up in a folder, `setup.yaml` and its tables."""
    truth = CASES[case](World(folder, seed))
    text = f"robot: ur10\nmeasurements:\n{truth.text}{PLAIN}"
    (folder / "setup.yaml").write_text(text, encoding="utf-8")
    return truth
