"""Which pose to visit next: task-optimal design, in compiled loops over candidates."""

from typing import NamedTuple, cast

import numpy as np
from scipy.linalg import solve_triangular

from handeye._compiled import compiled
from handeye.arrays import Array
from handeye.calibration.engine.chain import reach, residuals
from handeye.calibration.engine.engine import Engine
from handeye.calibration.engine.filter import Bank, Rules, unknowns


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
def slopes_of(
    kernel: NamedTuple, rules: Rules, bank: Bank, h: int, doubt: float, rows: Array, out: Array
) -> None:
    """out (N, k, n), overwritten: slopes of the residuals at rows (N, w), in tolerances."""
    k, n = out.shape[1:]
    x, values, by = np.empty(n), np.empty(k), np.empty((k, n))
    unknowns(rules, h, bank.d[h], x)
    for i in range(len(rows)):
        residuals(kernel, x, rows[i], doubt, values, by)
        for j in range(n):
            for c in range(k):
                out[i, c, j] = by[c, j] * rules.spreads[h, j]
        without_gauges(out[i], rules.gauges[h])


@compiled
def hand_slopes_of(
    kernel: NamedTuple, rules: Rules, bank: Bank, h: int, doubt: float, rows: Array, out: Array
) -> None:
    """out (N, m, n), overwritten: the same of the hand [m]."""
    m, n = out.shape[1:]
    k = bank.lines.shape[2]
    x, by, to_metres = np.empty(n), np.empty((k, n)), np.empty((m, k))
    unknowns(rules, h, bank.d[h], x)
    for i in range(len(rows)):
        hand_slopes(kernel, x, rules.spreads[h], rows[i], doubt, by, out[i], to_metres)
        without_gauges(out[i], rules.gauges[h])


def spreads(engine: Engine, rows: Array, *, hand: bool) -> Array:
    """Slopes J of the residuals (N, k, n), or of the hand (N, m, n) [m], at rows (N, w), by R^-1.

    With w one of them, `w w^T` is the covariance of the residuals, or of the hand [m^2]. By the
    hypothesis that leads among those with curves.
    """
    h, n = engine.flexible(), len(engine.x)
    out = np.empty((len(rows), engine.chain.n_hand if hand else engine.chain.n_values, n))
    known = (engine.chain.kernel, engine.rules, engine.bank, h, engine.doubt)
    (hand_slopes_of if hand else slopes_of)(*known, rows, out)
    root = engine.bank.roots[h][:, :n]
    solved = cast("Array", solve_triangular(root, out.reshape(-1, n).T, trans=1))
    return solved.T.reshape(out.shape)


def task_gains(engine: Engine, tasks: Array, candidates: Array) -> tuple[Array, float]:
    """Gains (C,) of candidates for tasks, rows of observations; and the mean variance now [m^2].

    With B = A R^-1 for the hand's slopes A at a task, and w = J R^-1 for a candidate's slopes J,
    the covariance B B^T falls by `B w^T (I + w w^T)^-1 w B^T`; variance is that of both components
    together. By the hypothesis that leads among those with curves: a robot thought to be straight
    has nothing more to learn about its curves, and would never look.
    """
    B = spreads(engine, tasks, hand=True).reshape(-1, len(engine.x))
    w = spreads(engine, candidates, hand=False)
    across = w @ B.T
    S = np.eye(engine.chain.n_values) + w @ w.transpose(0, 2, 1)
    gains: Array = np.sum(across * np.linalg.solve(S, across), axis=(1, 2)) / len(tasks)
    return gains, float(np.sum(B**2) / len(tasks))
