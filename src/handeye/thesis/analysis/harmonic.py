"""Amplitude and phase of a periodic response."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import minimize_scalar

from handeye.arrays import Array, scalar, shaped
from handeye.errors import InvalidInput

_STARTS = 72
_PARAMETERS = 3


class Harmonic(NamedTuple):
    """A fitted wave: level, amplitude and phase [rad], and standard deviations of the latter."""

    level: float
    amplitude: float
    phase: float
    amplitude_std: float
    phase_std: float


def fit_sine(
    t: ArrayLike, response: ArrayLike, period: float, weights: ArrayLike | None = None
) -> Harmonic:
    """Fit `level + amplitude sin(2 pi t / period + phase)` by harmonic regression.

    Linear least squares in level, sine and cosine, so any times do, not only whole periods. The
    standard deviations hold for independent residuals with variances like 1 / weights.

    Args:
        t: times (N,), N >= 4.
        response: (N,).
        period: of the wave.
        weights: of the points (N,), positive; by default all alike.
    """
    angle, y, w = _checked(t, response, period, weights)
    basis = np.stack([np.ones_like(angle), np.sin(angle), np.cos(angle)], axis=-1)
    (level, sine, cosine), covariance = _least_squares(basis, y, w)
    amplitude = float(np.hypot(sine, cosine))
    along = np.array([0.0, sine, cosine]) / amplitude if amplitude else np.array([0.0, 1.0, 0.0])
    across = np.array([0.0, -along[2], along[1]])
    phase_std = _std(across, covariance) / amplitude if amplitude else np.pi
    return Harmonic(
        level, amplitude, float(np.arctan2(cosine, sine)), _std(along, covariance), phase_std
    )


def fit_rectified_sine(
    t: ArrayLike, response: ArrayLike, period: float, weights: ArrayLike | None = None
) -> Harmonic:
    """Fit `level + amplitude |sin(2 pi t / period + phase)|` (eq 3.106), phase in [0, pi).

    Least squares; for a given phase the rest is linear, so only the phase is searched. Arguments
    as `fit_sine`.
    """
    angle, y, w = _checked(t, response, period, weights)

    def solve(phase: float) -> tuple[Array, Array, float]:
        wave = np.sin(angle + phase)
        basis = np.stack([np.ones_like(angle), np.abs(wave)], axis=-1)
        values, _ = _least_squares(basis, y, w)
        return values, wave, float(w @ (y - basis @ values) ** 2)

    def misfit(phase: float) -> float:
        # Eq 3.106 stands on its floor: a wave that hangs from a ceiling is another one.
        values, _, sum_of_squares = solve(phase)
        return sum_of_squares if values[1] >= 0.0 else np.inf

    grid = np.linspace(0.0, np.pi, _STARTS, endpoint=False)
    best = float(grid[np.argmin([misfit(phase) for phase in grid])])
    step = np.pi / _STARTS
    found = minimize_scalar(
        lambda phase: solve(phase)[2], bounds=(best - step, best + step), method="bounded",
        options={"xatol": 1e-10},
    )  # fmt: skip
    phase = float(found.x)
    (level, amplitude), wave, _ = solve(phase)
    # The slope in the phase is `amplitude` times this: divided by it, columns are of one size.
    turned = np.sign(wave) * np.cos(angle + phase)
    tangent = np.stack([np.ones_like(angle), np.abs(wave), turned], axis=-1)
    residual = y - level - amplitude * np.abs(wave)
    covariance = _covariance(tangent, residual, w)
    amplitude_std, turned_std = np.sqrt(np.diag(covariance))[1:].tolist()
    phase_std = turned_std / abs(amplitude) if amplitude else np.pi
    return Harmonic(float(level), float(amplitude), phase % np.pi, amplitude_std, float(phase_std))


def _checked(
    t: ArrayLike, response: ArrayLike, period: float, weights: ArrayLike | None
) -> tuple[Array, Array, Array]:
    """Angles, responses and weights, each (N,)."""
    times = shaped(t, (None,), "t")
    if len(times) <= _PARAMETERS:
        raise InvalidInput(f"a wave needs at least 4 points, got {len(times)}")
    y = shaped(response, times.shape, "response")
    w = np.ones_like(y) if weights is None else shaped(weights, times.shape, "weights")
    if np.any(w <= 0.0):
        raise InvalidInput("weights must be positive")
    return 2.0 * np.pi * times / scalar(period, "period", above=0.0), y, w


def _least_squares(basis: Array, y: Array, weights: Array) -> tuple[Array, Array]:
    """Weighted least-squares coefficients (p,) of columns (N, p), and their covariance."""
    root = np.sqrt(weights)
    values: Array = np.linalg.lstsq(basis * root[:, np.newaxis], y * root)[0].astype(np.float64)
    return values, _covariance(basis, y - basis @ values, weights)


def _covariance(basis: Array, residual: Array, weights: Array) -> Array:
    variance = float(weights @ residual**2) / (len(residual) - basis.shape[1])
    return variance * np.linalg.pinv(basis.T @ (basis * weights[:, np.newaxis]), hermitian=True)


def _std(direction: Array, covariance: Array) -> float:
    return float(np.sqrt(direction @ covariance @ direction))
