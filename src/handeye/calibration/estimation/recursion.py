"""Parameters followed one sighting at a time, at constant cost, in square-root information form.

What is known is the sum of squares `|R d - z|^2` of the deviations d (n,) of the free parameters
from nominal, in tolerances; R (n, n) is triangular and R^T R the information. Sightings are added
as rows and folded in by QR, so nothing that must stay positive is ever subtracted from.
"""

from typing import NamedTuple

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array, Integers
from handeye.calibration.estimation.gauges import gauges
from handeye.calibration.estimation.kernels import residual_rows
from handeye.calibration.estimation.losses import weight

# Gauss-Newton on one sighting; deviations that move less have converged.
_ITERATIONS = 8
_SETTLED = 1e-9


class Rules(NamedTuple):
    """What stays the same.

    nominal (8,), tolerances (n,) and places free (n,) of the free parameters in it; seen (n, n),
    the projection of deviations on what sightings can notice; the place of the loss in LOSSES and
    its scale; drift: how far parameters wander from one sighting to the next, a standard deviation
    in tolerances.
    """

    nominal: Array
    tolerances: Array
    free: Integers
    seen: Array
    loss: int
    scale: float
    drift: float


class Belief(NamedTuple):
    """What is known: R (n, n), z (n,), and the deviations (n,) with R d = z."""

    R: Array
    z: Array
    deviations: Array


def noticeable(nominal: Array, free: Integers, tolerances: Array) -> Array:
    """The projection (n, n) of deviations from nominal (8,) that leaves their gauges out.

    A gauge bends: linearised at one estimate and then at another, sightings would seem to tell it
    after all, and the parameters would creep along it, ever more certain. So nothing is learned
    about the gauges at the nominal parameters, which costs no generality.
    """
    directions = [gauge.direction for gauge in gauges(nominal, free, tolerances)]
    basis = np.linalg.qr(np.array(directions).reshape(-1, len(free)).T).Q
    return np.eye(len(free)) - basis @ basis.T


def ignorance(n: int) -> Belief:
    """Nothing but the priors of n parameters."""
    return Belief(np.eye(n), np.zeros(n), np.zeros(n))


@compiled
def parameters_at(rules: Rules, deviations: Array, p: Array) -> None:
    """p (8,), overwritten."""
    p[:] = rules.nominal
    for j in range(len(deviations)):
        p[rules.free[j]] += rules.tolerances[j] * deviations[j]


@compiled
def _linearise(rules: Rules, deviations: Array, rows: Array, values: Array, lines: Array) -> None:
    """Residuals values (2 N,) at deviations, and lines (2 N, n + 1) on which they would vanish.

    That is where `lines[:, :n] d = lines[:, n]`.
    """
    n = len(deviations)
    p = np.empty(8)
    slopes = np.empty((len(values), 8))
    parameters_at(rules, deviations, p)
    residual_rows(p, rows, values, slopes)
    for i in range(len(values)):
        lines[i, n] = -values[i]
        lines[i, :n] = 0.0
        for k in range(n):
            slope = slopes[i, rules.free[k]] * rules.tolerances[k]
            for j in range(n):
                lines[i, j] += slope * rules.seen[k, j]
        for j in range(n):
            lines[i, n] += lines[i, j] * deviations[j]


@compiled
def _fold(R: Array, z: Array, lines: Array, roots: Array) -> Array:
    """[R' z'] (n, n + 1) of the old rows and lines (M, n + 1) times roots (M,)."""
    n = len(z)
    stacked = np.empty((n + len(lines), n + 1))
    stacked[:n, :n] = R
    stacked[:n, n] = z
    for i in range(len(lines)):
        stacked[n + i] = lines[i] * roots[i]
    return np.linalg.qr(stacked)[1][:n].copy()


@compiled
def _minimum(folded: Array) -> Array:
    """The deviations (n,) with R d = z."""
    n = len(folded)
    d = np.empty(n)
    for i in range(n - 1, -1, -1):
        d[i] = folded[i, n]
        for j in range(i + 1, n):
            d[i] -= folded[i, j] * d[j]
        d[i] /= folded[i, i]
    return d


@compiled
def _wander(rules: Rules, belief: Belief) -> None:
    """The parameters move on: d' = phi d + w, w of variance drift^2, phi^2 = 1 - drift^2.

    With that phi, what no sighting tells stays as uncertain as the tolerances say, for ever.
    """
    n = len(belief.z)
    phi = np.sqrt(1.0 - rules.drift**2)
    stacked = np.zeros((2 * n, 2 * n + 1))
    for i in range(n):
        stacked[i, i] = 1.0 / rules.drift
        stacked[n + i, 2 * n] = belief.z[i]
        for j in range(i, n):
            stacked[n + i, j] = -belief.R[i, j] / phi
            stacked[n + i, n + j] = belief.R[i, j] / phi
    folded = np.linalg.qr(stacked)[1]
    belief.R[:] = folded[n : 2 * n, n : 2 * n]
    belief.z[:] = folded[n : 2 * n, 2 * n]
    belief.deviations[:] *= phi


@compiled
def _learn_one(rules: Rules, belief: Belief, row: Array) -> None:
    """One sighting (1, 6), linearised where it leads (iterated), its outliers weighed down.

    An outlier is one that surprises: its residual is large against noise and doubt about the
    parameters together, `1 + |R^-T j|^2` in its own variances.
    """
    n = len(belief.z)
    values, lines, roots = np.empty(2), np.empty((2, n + 1)), np.ones(2)
    if rules.drift > 0.0:
        _wander(rules, belief)
    d = belief.deviations.copy()
    folded = np.zeros((n, n + 1))
    for iteration in range(_ITERATIONS):
        _linearise(rules, d, row, values, lines)
        if iteration == 0:
            for i in range(2):
                doubt = np.linalg.solve(belief.R.T, lines[i, :n])
                surprise = values[i] / np.sqrt(1.0 + np.sum(doubt**2))
                roots[i] = np.sqrt(weight(rules.loss, surprise / rules.scale))
        folded = _fold(belief.R, belief.z, lines, roots)
        new = _minimum(folded)
        moved = np.abs(new - d).max()
        d = new
        if moved < _SETTLED:
            break
    p = np.empty(8)
    parameters_at(rules, d, p)
    # A result that is no robot at all is not taken over.
    if np.isfinite(p).all() and min(p[0], p[1], p[7]) > 0.0:
        belief.R[:] = folded[:, :n]
        belief.z[:] = folded[:, n]
        belief.deviations[:] = d


@compiled
def learn_stream(rules: Rules, belief: Belief, rows: Array, before: Array) -> None:
    """Learn from sightings (N, 6) in order; before (N, 8): the parameters when each arrived."""
    for i in range(len(rows)):
        parameters_at(rules, belief.deviations, before[i])
        _learn_one(rules, belief, rows[i : i + 1])
