"""Which pose to visit next: task-optimal design, in compiled loops over candidates."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array
from handeye.calibration.combined.chain import reach, residuals
from handeye.calibration.combined.engine import Engine
from handeye.calibration.combined.filter import Bank, Rules, unknowns
from handeye.calibration.combined.roots import spread_of


@dataclass(frozen=True, eq=False)
class Suggestion:
    """The pose that teaches most, and what it is expected to bring.

    joints, eccentricity  the pose: encoder readings (2,) [rad], and where beside the hand the eye
                          points [rad]
    before, after         uncertainty of the hand at the working points, root mean square [m]
    gains                 (C,) of every candidate: mean variance that it takes away [m^2]
    best                  the place of the pose among the candidates
    """

    joints: Array
    eccentricity: float
    before: float
    after: float
    gains: Array
    best: int


@compiled
def hand_slopes(
    kernel: NamedTuple, x: Array, spread: Array, seen: Array, doubt: float, by: Array, out: Array,
    to_metres: Array,
) -> None:  # fmt: skip
    """The hand's displacement [m] by unknowns in tolerances, were the robot to act on `seen`.

    by (k, n), out (m, n) and to_metres (m, k), overwritten: slopes of residuals, those of the hand,
    and the hand by residuals.
    """
    k, n = by.shape
    values = np.empty(k)
    residuals(kernel, x, seen, doubt, values, by)
    reach(kernel, x, seen, doubt, to_metres)
    for j in range(n):
        for i in range(k):
            by[i, j] *= spread[j]
        for i in range(len(out)):
            out[i, j] = 0.0
            for c in range(k):
                out[i, j] += to_metres[i, c] * by[c, j]


@compiled
def without_gauges(lines: Array, gauges: Array) -> None:
    """Lines (k, n) without their parts along gauges (g, n), in place."""
    for i in range(len(lines)):
        for g in range(len(gauges)):
            along = 0.0
            for j in range(lines.shape[1]):
                along += gauges[g, j] * lines[i, j]
            for j in range(lines.shape[1]):
                lines[i, j] -= along * gauges[g, j]


@compiled
def spreads_of(
    kernel: NamedTuple,
    rules: Rules,
    bank: Bank,
    h: int,
    doubt: float,
    rows: Array,
    of_hand: bool,
    out: Array,
) -> None:
    """out (N, k, n), overwritten: slopes at rows (N, w) times R^-1, of residuals or of the hand.

    With w one of them, `w w^T` is the covariance of the residuals, or of the hand [m^2].
    """
    k, n = out.shape[1:]
    x = np.empty(n)
    unknowns(rules, h, bank.d[h], x)
    by, hand, to_metres = np.empty((k, n)), np.empty((k, n)), np.empty((k, k))
    for i in range(len(rows)):
        hand_slopes(kernel, x, rules.spreads[h], rows[i], doubt, by, hand, to_metres)
        lines = hand if of_hand else by
        without_gauges(lines, rules.gauges[h])
        spread_of(bank.roots[h], lines, out[i])


def task_gains(engine: Engine, tasks: Array, candidates: Array) -> tuple[Array, float]:
    """Gains (C,) of candidates for tasks, rows of observations; and the mean variance now [m^2].

    With B = A R^-1 for the hand's slopes A at a task, and w = J R^-1 for a candidate's slopes J,
    the covariance B B^T falls by `B w^T (I + w w^T)^-1 w B^T`; variance is that of both components
    together. By the hypothesis that leads among those with curves: a robot thought to be straight
    has nothing more to learn about its curves, and would never look.
    """
    h, n, k = engine.flexible(), len(engine.x), engine.chain.n_values
    parts = np.empty((len(tasks), k, n)), np.empty((len(candidates), k, n))
    for rows, of_hand, out in ((tasks, True, parts[0]), (candidates, False, parts[1])):
        spreads_of(engine.chain.kernel, engine.rules, engine.bank, h, engine.doubt, rows,
                   of_hand, out)  # fmt: skip
    B, w = parts[0].reshape(-1, n), parts[1]
    across = w @ B.T
    S = np.eye(k) + w @ w.transpose(0, 2, 1)
    gains: Array = np.sum(across * np.linalg.solve(S, across), axis=(1, 2)) / len(tasks)
    return gains, float(np.sum(B**2) / len(tasks))
