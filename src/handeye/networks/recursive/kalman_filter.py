"""One step of the extended Kalman filter of a Kalman network, neuron by neuron."""

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array
from handeye.networks.recursive.kalman_units import (
    LEAST_WIDTH,
    MOST_WIDTH,
    Settings,
    Shared,
    Units,
    Work,
)

_LARGEST_STEP = 0.5  # widths, and logarithms: beyond it the linearisation says nothing
_LEAST_NOISE = 1e-3  # of the noise's first deviation


@compiled
def linearise(units: Units, shared: Shared, found: int, x: Array, work: Work) -> None:
    """Derivatives of the outputs by weights, centers, log h and log scales of the neighbours.

    With `o = exp(-z / R)`: `do/dc_i = 2 o q_i (x_i - c_i) / R`, q the precision; `do/dlog h =
    2 o z / R`; `do/dlog s_i = 2 o q_i (x_i - c_i)^2 / R`.
    """
    m, d = len(units.weights), x.size
    work.by_scale[:] = 0.0
    for a in range(found):
        j = work.which[a]
        part = 2.0 * work.o[j] / units.widths[j]
        for k in range(m):
            w = units.weights[k, j]
            work.slopes[a, k, k] = work.o[j]
            work.slopes[a, k, m + d] = w * part * work.z[j]
            for i in range(d):
                away = x[i] - units.centers[i, j]
                slope = w * part * shared.precision[i] * away
                work.slopes[a, k, m + i] = slope
                work.by_scale[k, i] += slope * away


@compiled
def see(root: Array, slope: Array, seen: Array) -> float:
    """seen = `S^T h`, overwritten; returns `h^T S S^T h`."""
    seen[:] = 0.0
    for i in range(slope.size):
        if slope[i] != 0.0:
            for c in range(slope.size):
                seen[c] += root[i, c] * slope[i]
    total = 0.0
    for c in range(slope.size):
        total += seen[c] * seen[c]
    return total


@compiled
def shrink(root: Array, seen: Array, own: float, total: float, gain: float, step: Array) -> None:
    """One scalar measurement (Potter 1963): `S -= S f f^T / (t + sqrt(t (t - own)))`, f = seen.

    t is the total variance of the error, of which `own = |f|^2` is this root's: `S S^T` becomes
    `P - P h h^T P / t`. Adds gain `S f` to step.
    """
    part = 1.0 / (total + np.sqrt(total * (total - own)))
    for i in range(step.size):
        moved = 0.0
        for c in range(step.size):
            moved += root[i, c] * seen[c]
        step[i] += gain * moved
        for c in range(step.size):
            root[i, c] -= part * moved * seen[c]


@compiled
def correct(units: Units, shared: Shared, settings: Settings, found: int, gain: float,
            error: Array, work: Work) -> None:  # fmt: skip
    """The outputs, one after the other, correct the neighbours and the scales; noise follows."""
    shapes, scales = settings.shape_deviation > 0.0, settings.scale_deviation > 0.0
    m, p = len(units.weights), units.prior.shape[1]
    wide = p if shapes else m
    floor = (_LEAST_NOISE * settings.noise_deviation) ** 2
    work.steps[:] = 0.0
    work.scale_step[:] = 0.0
    owns = np.empty(found)
    for k in range(m):
        total, left = shared.noise[k], error[k]
        for a in range(found):
            slope = work.slopes[a, k, :wide]
            owns[a] = see(units.roots[work.which[a]], slope, work.seen[a, :wide])
            total += owns[a]
            for i in range(wide):
                left -= slope[i] * work.steps[a, i]
        scale_own = 0.0
        if scales:
            scale_own = see(shared.root, work.by_scale[k], work.scale_seen)
            total += scale_own
            for i in range(work.scale_step.size):
                left -= work.by_scale[k, i] * work.scale_step[i]
        for a in range(found):
            shrink(units.roots[work.which[a]], work.seen[a, :wide], owns[a], total, left / total,
                   work.steps[a, :wide])  # fmt: skip
        if scales:
            shrink(shared.root, work.scale_seen, scale_own, total, left / total, work.scale_step)
        surprise = error[k] * error[k]
        shared.noise[k] = max(shared.noise[k] + gain * (surprise - shared.noise[k]), floor)


@compiled
def forget(root: Array, prior: Array, factor: float) -> None:
    """Multiply every standard deviation by the factor, to at most its prior (p,)."""
    for i in range(prior.size):
        size = 0.0
        for c in range(prior.size):
            size += root[i, c] * root[i, c]
        if size > 0.0:
            root[i] *= min(factor, max(prior[i] / np.sqrt(size), 1.0))


@compiled
def move(units: Units, shared: Shared, settings: Settings, found: int, work: Work) -> None:
    """Take the steps, and let covariances grow again."""
    m, d = len(units.weights), len(units.centers)
    grow = 1.0 / np.sqrt(settings.forgetting)
    low, high = 2.0 * LEAST_WIDTH**2, 2.0 * MOST_WIDTH**2
    for a in range(found):
        j, most = work.which[a], _LARGEST_STEP * np.sqrt(0.5 * units.widths[work.which[a]])
        for k in range(m):
            units.weights[k, j] += work.steps[a, k]
        for i in range(d):
            units.centers[i, j] += min(max(work.steps[a, m + i], -most), most)
        step = min(max(work.steps[a, m + d], -_LARGEST_STEP), _LARGEST_STEP)
        units.widths[j] = min(max(units.widths[j] * np.exp(2.0 * step), low), high)
        if settings.forgetting < 1.0:
            forget(units.roots[j], units.prior[j], grow)
    if settings.scale_deviation > 0.0:
        for i in range(d):
            step = min(max(work.scale_step[i], -_LARGEST_STEP), _LARGEST_STEP)
            precision = shared.precision[i] * np.exp(-2.0 * step)
            shared.precision[i] = min(max(precision, LEAST_WIDTH**2), 1.0 / LEAST_WIDTH**2)
        if settings.forgetting < 1.0:
            forget(shared.root, np.full(d, settings.scale_deviation), grow)
