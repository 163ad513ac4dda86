"""Closed forms from which the fit of base and marker starts.

Each start is a pair: rotation of the base in the sensor's frame R (3, 3) and marker in the flange's
frame m (3,) [m]. The position of the base follows from both. Notation of `placement`:
p = R (R_i m + t_i) + t.
"""

from typing import cast

import numpy as np
from scipy.spatial.transform import Rotation

from handeye.arrays import Array
from handeye.geometry import nearest_rotation

# Among rotations that fit equally well (points on a line, or in one place), the smallest.
_TOWARDS_NO_TURN = 1e-9
# Singular values closer than this: the flange turns about less than two axes by some degrees.
_AMBIGUOUS = 1e-3
_BEST_OF_CUBE = 3

Start = tuple[Array, Array]


def starts(poses: Array, positions: Array, rotations: Array | None, *, fixed: bool) -> list[Start]:
    """Starts in the order of trust, from T_base_flange (N, 4, 4) and marker positions (N, 3) [m].

    With rotations (N, 3, 3) of the marker in the sensor's frame their closed form comes first.
    With `fixed` every m is zero.
    """
    found: list[Start] = []
    oriented = None if rotations is None else base_turn(poses[:, :3, :3], rotations)
    if oriented is not None:
        m = np.zeros(3) if fixed else _best_marker(poses, positions, oriented)
        found.append((oriented, m))
    found.append((_marker_at_flange(poses, positions), np.zeros(3)))
    if fixed:
        return found
    R = _linear_turn(poses, positions)
    found.append((R, _best_marker(poses, positions, R)))
    return found + _cube(poses, positions)


def base_turn(flanges: Array, markers: Array) -> Array | None:
    """R of robot-world/hand-eye calibration R_marker_i = R R_flange_i Z from rotations (N, 3, 3).

    R_marker_i Z^T = R R_flange_i makes vec R and vec Z^T the leading pair of singular vectors of
    sum_i R_marker_i^T (x) R_flange_i^T (Shah 2013). None where the flange turns about less than
    two axes, for then a whole family of R fits.
    """
    product = np.einsum("nji,nlk->ikjl", markers, flanges).reshape(9, 9) / len(flanges)
    _, sizes, right = np.linalg.svd(product)
    if sizes[1] > (1.0 - _AMBIGUOUS) * sizes[0]:
        return None
    R = right[0].reshape(3, 3)
    return nearest_rotation(R if np.linalg.det(R) > 0.0 else -R)


def _marker_at_flange(poses: Array, positions: Array) -> Array:
    """The turn that best lays the flange's path on the marker's (Kabsch 1976)."""
    path = poses[:, :3, 3] - poses[:, :3, 3].mean(axis=0)
    product = (positions - positions.mean(axis=0)).T @ path
    size = float(np.linalg.norm(product))
    return nearest_rotation(product / (size or 1.0) + _TOWARDS_NO_TURN * np.eye(3))


def _linear_turn(poses: Array, positions: Array) -> Array:
    """R^T p_i - R_i m - t' = t_i is linear in R^T, m and t'; its R^T is then made a rotation."""
    rows = len(poses)
    system = np.zeros((rows, 3, 15))
    for i in range(3):
        system[:, i, 3 * i : 3 * i + 3] = positions
        system[:, i, 12 + i] = -1.0
    system[:, :, 9:12] = -poses[:, :3, :3]
    solution = np.linalg.lstsq(system.reshape(-1, 15), poses[:, :3, 3].reshape(-1))[0]
    return nearest_rotation(solution[:9].reshape(3, 3)).T


def _best_marker(poses: Array, positions: Array, R: Array) -> Array:
    """m of the least-squares solution of R_i m + t' = R^T p_i - t_i that has the least norm."""
    return _markers(poses, positions, R[None])[0][0]


def _markers(poses: Array, positions: Array, turns: Array) -> tuple[Array, Array]:
    """Best markers (K, 3) for turns (K, 3, 3), and the sums of squares (K,) that they leave."""
    system = poses[:, :3, :3] - poses[:, :3, :3].mean(axis=0)
    seen = (positions - positions.mean(axis=0)) @ turns
    wanted = (seen - (poses[:, :3, 3] - poses[:, :3, 3].mean(axis=0))).reshape(len(turns), -1).T
    flat = system.reshape(-1, 3)
    # NumPy's own types lose track of pinv's.
    m = cast("Array", np.linalg.pinv(flat, rcond=1e-9)) @ wanted
    return m.T, np.sum((wanted - flat @ m) ** 2, axis=0)


def _cube(poses: Array, positions: Array) -> list[Start]:
    """The best of the 24 turns of a cube: no rotation is more than 63 degrees from one."""
    turns = Rotation.create_group("O").as_matrix()
    markers, left = _markers(poses, positions, turns)
    return [(turns[i], markers[i]) for i in np.argsort(left)[:_BEST_OF_CUBE]]
