"""Where a serial arm brings its marker, and the joints that bring it to a place; compiled."""

from typing import NamedTuple

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array, Booleans
from handeye.calibration.arm.kernels import (
    TWIST,
    SerialArm,
    chain,
    joint_at,
    pose,
    waves,
)
from handeye.calibration.arm.motions import carry

_ITERATIONS = 200
ARRIVED = 1e-7
"""Far below what any sensor resolves [m]."""
_DAMPING = 1e-3  # of the reach: limits the step near singular postures
_LARGEST_STEP = 0.3  # [rad] or [m], so that the arm stays on the side of its posture


class Bounds(NamedTuple):
    """Where an arm may go.

    low, high (m,): limits of the readings; held (m,): which stay as they are; envelope [m] of
    corrections; its reach [m].
    """

    low: Array
    high: Array
    held: Booleans
    envelope: float
    reach: float


@compiled
def held_back(nominal: Array, learned: Array, envelope: float, out: Array) -> None:
    """out (3,), overwritten: learned (3,), or no farther than envelope [m] from nominal (3,)."""
    size = 0.0
    for i in range(3):
        size += (learned[i] - nominal[i]) ** 2
    size = np.sqrt(size)
    part = 0.0
    if np.isfinite(size):
        part = 1.0 if size <= envelope else envelope / size
    for i in range(3):
        out[i] = nominal[i] + part * (learned[i] - nominal[i]) if part > 0.0 else nominal[i]


@compiled
def predicted(
    kernel: SerialArm, x: Array, extra: Array, seen: Array, envelope: float, places: Array
) -> None:
    """places (2, 3), overwritten: the marker at the joints of seen (w,), nominal and learned.

    What was learned is x (n,) and extra (3,) [m], held back.
    """
    T, learned = np.empty((3, 4)), np.empty(3)
    pose(kernel, np.zeros(len(x)), seen, T)
    places[0] = T[:, 3]
    pose(kernel, x, seen, T)
    for i in range(3):
        learned[i] = T[i, 3] + extra[i]
    held_back(places[0], learned, envelope, places[1])


@compiled
def predicted_many(
    kernel: SerialArm, x: Array, extra: Array, seen: Array, envelope: float, places: Array
) -> None:
    """The learned ones alone, places (N, 3), for rows (N, w) and extra (N, 3)."""
    both = np.empty((2, 3))
    for i in range(len(seen)):
        predicted(kernel, x, extra[i], seen[i], envelope, both)
        places[i] = both[1]


@compiled
def by_joints(kernel: SerialArm, x: Array, seen: Array, J: Array) -> None:
    """J (3, m), overwritten: the marker's shift per reading, but for the slopes of curves.

    Those are some milliradians per radian: Newton's method needs a step more for them.
    """
    n = len(kernel.slides)
    wave, T = np.empty((len(kernel.terms), 2)), np.empty((3, 4))
    ways, origins = np.zeros((n + 2, TWIST, TWIST + 1)), np.empty((n + 2, 3))
    moved = np.empty((TWIST, TWIST + 1))
    waves(kernel, seen, wave)
    chain(kernel, x, seen, wave, T, ways, origins)
    J[:] = 0.0
    for j in range(n):
        carry(ways[1 + j], origins[1 + j], T, moved)
        scale = 1.0 + x[joint_at(kernel, j) + TWIST]
        for i in range(3):
            J[i, kernel.of[j]] += kernel.gains[j] * scale * moved[i, TWIST]


@compiled
def seek(
    kernel: SerialArm, x: Array, extra: Array, goal: Array, bounds: Bounds, row: Array
) -> float:
    """Joints of row (w,), overwritten, near those it has, that bring the marker to goal (3,).

    Damped Gauss-Newton, `dq = J^T (J J^T + damping^2)^-1 e`, within limits. Returns by how
    much the marker misses [m].
    """
    n = kernel.n_readings
    J, places, error = np.empty((3, n)), np.empty((2, 3)), np.empty(3)
    missed = np.inf
    for j in range(n):
        if not bounds.held[j]:
            row[j] = min(max(row[j], bounds.low[j]), bounds.high[j])
    for _ in range(_ITERATIONS):
        predicted(kernel, x, extra, row, bounds.envelope, places)
        missed = 0.0
        for i in range(3):
            error[i] = goal[i] - places[1, i]
            missed += error[i] * error[i]
        missed = np.sqrt(missed)
        if missed <= ARRIVED:
            break
        by_joints(kernel, x, row, J)
        for j in range(n):
            if bounds.held[j]:
                J[:, j] = 0.0
        square = J @ J.T
        for i in range(3):
            square[i, i] += (_DAMPING * bounds.reach) ** 2
        step = J.T @ np.linalg.solve(square, error)
        largest = np.max(np.abs(step))
        part = min(1.0, _LARGEST_STEP / largest) if largest > 0.0 else 1.0
        for j in range(n):
            if not bounds.held[j]:
                row[j] = min(max(row[j] + part * step[j], bounds.low[j]), bounds.high[j])
    return missed


@compiled
def seek_many(
    kernel: SerialArm, x: Array, extra: Array, goals: Array, bounds: Bounds, rows: Array,
    missed: Array,
) -> None:  # fmt: skip
    """The same for rows (N, w), extra and goals (N, 3); missed (N,) is overwritten."""
    for i in range(len(rows)):
        missed[i] = seek(kernel, x, extra[i], goals[i], bounds, rows[i])
