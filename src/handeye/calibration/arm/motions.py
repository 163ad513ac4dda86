"""Small motions of a pose in compiled loops, and what they do to whatever follows."""

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array
from handeye.calibration.arm.rotations import turned


@compiled
def compose(T: Array, D: Array) -> None:
    """T (3, 4) becomes T D, with D (3, 4) or (4, 4)."""
    for i in range(3):
        a, b, c = T[i, 0], T[i, 1], T[i, 2]
        for j in range(4):
            T[i, j] = a * D[0, j] + b * D[1, j] + c * D[2, j] + (T[i, 3] if j == 3 else 0.0)


@compiled
def shift_and_turn(T: Array, e: Array, ways: Array) -> None:
    """T (3, 4) becomes T E(e) with e (6,); ways (6, 6), overwritten, by each component of e.

    Rows 0 to 2: how the origin of what follows shifts with T's frame, 3 to 5: turn [rad], both in
    the axes outside; the turn is about the new origin of T.
    """
    R, L = np.empty((3, 3)), np.empty((3, 3))
    turned(e[3:], R, L)
    D = np.empty((3, 4))
    for i in range(3):
        D[i, 3] = e[i]
        for j in range(3):
            D[i, j] = R[i, j]
            ways[i, j], ways[3 + i, j], ways[i, 3 + j] = T[i, j], 0.0, 0.0
            ways[3 + i, 3 + j] = T[i, 0] * L[0, j] + T[i, 1] * L[1, j] + T[i, 2] * L[2, j]
    compose(T, D)


@compiled
def move_joint(T: Array, amount: float, slides: bool) -> None:
    """T (3, 4) becomes T J: a turn about z by amount [rad], or a shift along it [m]."""
    if slides:
        for i in range(3):
            T[i, 3] += amount * T[i, 2]
        return
    c, s = np.cos(amount), np.sin(amount)
    for i in range(3):
        x, y = T[i, 0], T[i, 1]
        T[i, 0] = c * x + s * y
        T[i, 1] = c * y - s * x


@compiled
def carry(ways: Array, origin: Array, T: Array, out: Array) -> None:
    """out (6, k), overwritten: ways (6, k) about `origin` (3,), as shift and turn of T (3, 4)."""
    x, y, z = T[0, 3] - origin[0], T[1, 3] - origin[1], T[2, 3] - origin[2]
    for k in range(ways.shape[1]):
        a, b, c = ways[3, k], ways[4, k], ways[5, k]
        out[0, k] = ways[0, k] + b * z - c * y
        out[1, k] = ways[1, k] + c * x - a * z
        out[2, k] = ways[2, k] + a * y - b * x
        out[3, k], out[4, k], out[5, k] = a, b, c
