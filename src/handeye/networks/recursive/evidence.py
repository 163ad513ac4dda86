"""How far each input reaches, from a few samples."""

from typing import NamedTuple

import numpy as np
from scipy.linalg import LinAlgError
from scipy.linalg.lapack import dpotrf, dpotri
from scipy.optimize import minimize

from handeye.arrays import Array

_STEPS = 40
_LEAST_NOISE = 1e-5

# Chosen on five streams of 4,000 to 10,000 samples: on two, scales still shorter were better, on
# two worse.
_FACTORS: Array = np.geomspace(0.75, 1.2, 5)
_NEGLIGIBLE = 1e-3


class Relevance(NamedTuple):
    """Scales (d,) of the inputs, prior variance (m,) of the function and variance of the noise."""

    scales: Array
    signal: Array
    noise: Array

    @property
    def noise_ratio(self) -> float:
        """Noise over signal, the same for all outputs."""
        return float(self.noise[0] / self.signal[0])


def relevance(x: Array, targets: Array) -> Relevance:
    """Scales under which samples x (N, d), targets (N, m) are most probable.

    The targets, each divided by its root mean square, are taken for draws of one Gaussian process
    with covariance `s^2 exp(-|(x - x') / scales|^2 / 2)` and noise; scales, s and noise maximise
    the density of the samples (automatic relevance determination: MacKay 1992, Neal 1996;
    Rasmussen and Williams 2006, eq 5.8 and 5.9) times a broad prior of the scales around sqrt(d)
    spreads of the input, one unit of logarithm wide. An input that does not matter gets a long
    scale. O(N^3) for each of a few tens of steps.
    """
    spread = x.std(axis=0)
    spread = np.where(spread > 1e-9 * np.abs(x).max(axis=0, initial=0.0), spread, 1.0)
    size = np.sqrt((targets**2).mean(axis=0))
    standard = x / spread
    size = np.where(size > 0.0, size, 1.0)
    outputs = targets / size
    d = x.shape[1]
    usual = 0.5 * np.log(d)
    bounds = [(usual - 4.0, usual + 4.0)] * d + [(np.log(_LEAST_NOISE), 0.0), (-3.0, 6.0)]
    start = np.concatenate([np.full(d, usual), [np.log(0.05), 0.0]])
    found = minimize(
        _cost, start, (standard, outputs, usual), "L-BFGS-B", jac=True, bounds=bounds,
        options={"maxiter": _STEPS},
    )  # fmt: skip
    noise, amplitude = np.exp(found.x[d:])
    return Relevance(np.exp(found.x[:d]) * spread, amplitude * size**2, noise * size**2)


def fitting_factor(points: Array, noise_ratio: float, nugget: float) -> float:
    """By how much scales are multiplied, so that neurons suffice and none is wasted.

    Scales that explain a few samples best are too long for the many that follow, which show finer
    detail, where neurons can represent it, and too short where they cannot. What the other points
    (N, d), in scales, do not represent of the prior at one of them is `1 / (C^-1)_jj`, C their
    covariance with the nugget on the diagonal (leave-one-out: Sundararajan and Keerthi 2001). With
    the factor, between 0.75 and 1.2, its mean is the noise ratio, or a thousandth if that is more:
    so little does not matter beside what is still to be learned. O(N^3).
    """
    norms = (points**2).sum(axis=1)
    z = np.maximum(norms[:, np.newaxis] + norms - 2.0 * points @ points.T, 0.0)
    missing = np.empty(len(_FACTORS))
    for i, factor in enumerate(_FACTORS):
        covariance = np.exp((-0.5 / factor**2) * z)
        np.einsum("ii->i", covariance)[...] = 1.0 + nugget
        inverse = np.asarray(dpotri(dpotrf(covariance, lower=1)[0], lower=1)[0])
        missing[i] = (1.0 / np.diag(inverse)).mean()
    level = float(np.log(max(noise_ratio, _NEGLIGIBLE)))
    # It falls as scales grow.
    return float(np.exp(np.interp(level, np.log(missing[::-1]), np.log(_FACTORS[::-1]))))


def _cost(logs: Array, x: Array, outputs: Array, usual: float) -> tuple[float, Array]:
    """Minus the logarithm of the density, and its gradient by the logarithms (d + 2,)."""
    (n, d), m = x.shape, outputs.shape[1]
    scaled = x * np.exp(-logs[:d])
    noise, amplitude = np.exp(logs[d:])
    norms = (scaled**2).sum(axis=1)
    z = np.maximum(norms[:, np.newaxis] + norms - 2.0 * scaled @ scaled.T, 0.0)
    signal = amplitude * np.exp(-0.5 * z)
    factor, failed = dpotrf(signal + noise * np.eye(n), lower=1)
    if failed:  # the noise has a floor, so that only samples beyond all measure come here
        raise LinAlgError("the samples' covariance is not positive")
    inverse = np.asarray(dpotri(factor, lower=1)[0])
    inverse = np.tril(inverse) + np.tril(inverse, -1).T
    solved = inverse @ outputs
    away = logs[:d] - usual
    cost = (
        0.5 * float((solved * outputs).sum())
        + m * float(np.log(np.diag(factor)).sum())
        + 0.5 * float(away @ away)
    )
    by_covariance = 0.5 * (m * inverse - solved @ solved.T)
    by_signal = by_covariance * signal
    # sum_ij G_ij (x_i - x_j)^2 = 2 (sum_i x_i^2 sum_j G_ij - x^T G x) for a symmetric G.
    by_scales = 2.0 * (
        by_signal.sum(axis=1) @ scaled**2 - np.einsum("ia,ia->a", scaled, by_signal @ scaled)
    )
    return cost, np.concatenate(
        [by_scales + away, [noise * np.trace(by_covariance), by_signal.sum()]]
    )
