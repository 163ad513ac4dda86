"""Arms that move, cameras that see a target, and what both say."""

from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from handeye.arrays import Array
from handeye.calibration.hand_eye.samples import Setup
from handeye.geometry import invert, make_pose

SETUPS: tuple[Setup, ...] = ("eye_in_hand", "eye_to_hand")


class Scene(NamedTuple):
    """Poses of the flange, of what is on it, of what is in the base, and what the camera sees."""

    flanges: Array
    X: Array
    Z: Array
    sensed: Array


def random_poses(rng: np.random.Generator, n: int, size: float = 0.3) -> Array:
    return make_pose(Rotation.random(n, rng=rng).as_matrix(), rng.normal(size=(n, 3)) * size)


def turned_about(rng: np.random.Generator, n: int, axis: Array) -> Array:
    """Poses anywhere, turned about one axis only."""
    turns = np.linspace(0.0, 2.0, n)[:, None] * axis
    return make_pose(Rotation.from_rotvec(turns).as_matrix(), rng.normal(size=(n, 3)) * 0.2)


def seen(flanges: Array, X: Array, Z: Array, setup: Setup) -> Array:
    """T_camera_target: A X B^-1 = Z eye in hand, A X = Z B eye to hand."""
    return invert(flanges @ X) @ Z if setup == "eye_in_hand" else invert(Z) @ flanges @ X


def scene(rng: np.random.Generator, setup: Setup, flanges: Array | int = 12) -> Scene:
    A = random_poses(rng, flanges) if isinstance(flanges, int) else flanges
    X, Z = random_poses(rng, 1, 0.1)[0], random_poses(rng, 1, 0.5)[0]
    return Scene(A, X, Z, seen(A, X, Z, setup))


def noisy(rng: np.random.Generator, T: Array, turn: float, shift: float) -> Array:
    """Poses with normal errors: turns [rad] of the pose itself, shifts [m]."""
    errors = Rotation.from_rotvec(rng.normal(size=(len(T), 3)) * turn).as_matrix()
    return make_pose(T[:, :3, :3] @ errors, T[:, :3, 3] + rng.normal(size=(len(T), 3)) * shift)


def apart(a: Array, b: Array) -> tuple[float, float]:
    """Angle [rad] and distance [m] between two poses."""
    turn = Rotation.from_matrix(a[:3, :3].T @ b[:3, :3]).magnitude()
    return float(turn), float(np.linalg.norm(a[:3, 3] - b[:3, 3]))
