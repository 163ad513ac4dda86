"""How noisy each channel of a system is, and how little a wild row counts.

Residuals of a channel follow a multivariate Student t, which is a normal distribution for each row
whose variance is drawn anew (Lange, Little & Taylor 1989). With d values in a row, nu degrees of
freedom, r^2 the squared residual over the variance and h the leverage,

    w = (nu + d) / (nu + r^2)          weight of a row
    sum w r^2 = sum (d - h)            where the evidence of the variance is greatest
"""

from typing import NamedTuple

import numpy as np

from handeye.arrays import Array, Integers
from handeye.calibration.arm.system import System

FREEDOM = 5.0
"""Degrees of freedom of the t: tails such as real sensors have."""

OF_NORMAL = 0.8855
"""The scale that is found for 3-vectors that are normal, over their standard deviation.

The root of E[(5 + 3) u / (5 + u)] = 3 with u = chi^2_3 / s^2.
"""

_SMALLEST = 1e-9
# Information, over that of a prior, of which rounding loses no more than some thousandths of it.
_MOST_TOLD = 1e13


class Noise(NamedTuple):
    """Of C channels: standard deviation noise (C,) beyond what was stated.

    squares (N, C) of residuals over variance, nan where a row has no such channel; values (C,) in
    a row.
    """

    noise: Array
    squares: Array
    values: Integers

    @property
    def tails(self) -> Array:
        """(C,) share of a row's information that tails leave."""
        freedom = FREEDOM + self.values
        return freedom / (freedom + 2.0)

    def weights(self) -> Array:
        """(N, C) of the squared residuals, tails and all."""
        return self.tails * (FREEDOM + self.values) / (FREEDOM + np.nan_to_num(self.squares))


def least_noise(system: System, x: Array) -> Array:
    """(C,) the least noise of which rounding lets a fit near x (n,) make anything.

    With less, information in units of the priors' widths is so great that these are lost in it.
    """
    told = np.zeros((system.n_channels, len(x)))
    for rows in system.rows(x):
        for k, c in enumerate(rows.channels):
            told[c] += np.sum((rows.slopes[:, k] * system.tolerance) ** 2, axis=0)
    return np.maximum(np.sqrt(told.max(axis=1) / _MOST_TOLD), _SMALLEST)


def first_noise(system: System, x: Array, least: Array) -> Noise:
    """As if all residuals at x (n,) were noise, by their medians, and at least (C,)."""
    squares, _, values = _errors(system, x)
    noise = np.maximum(np.sqrt(np.nanmedian(squares, axis=0) / values), least)
    return Noise(noise, squares / noise**2, values)


def noise_at(system: System, x: Array, known: Array, before: Noise, least: Array) -> Noise:
    """Noise at x, at least (C,); known (C,) is how many values the unknowns took up."""
    errors, stated, values = _errors(system, x)
    weights = before.weights() / before.tails
    noise = np.empty(len(values))
    for c in range(len(values)):
        has = np.isfinite(errors[:, c])
        free = max(float(values[c] * has.sum() - known[c]), 1.0)
        beyond = _beyond(weights[has, c] * errors[has, c], stated[has, c], free)
        noise[c] = max(beyond, least[c])
    return Noise(noise, errors / np.maximum(stated + noise**2, _SMALLEST**2), values)


def _errors(system: System, x: Array) -> tuple[Array, Array, Integers]:
    """Squared residuals (N, C), nan where none; stated variances (N, C); values of a row (C,)."""
    shape = (system.n_rows, system.n_channels)
    squares, stated = np.full(shape, np.nan), np.zeros(shape)
    values = np.zeros(shape[1], np.int64)
    for rows in system.rows(x, slopes=False):
        inside = slice(rows.first, rows.first + len(rows.residuals))
        for c in np.unique(rows.channels):
            own = rows.channels == c
            values[c] = own.sum()
            squares[inside, c] = np.sum(rows.residuals[:, own] ** 2, axis=1)
            stated[inside, c] = np.mean(rows.std[:, own] ** 2, axis=1)
    return squares, stated, values


def _beyond(squares: Array, stated: Array, free: float) -> float:
    """s with sum squares / (stated + s^2) = free, or the least there is; squares, stated (M,)."""

    def over(variance: float) -> float:
        return float(np.sum(squares / (stated + variance))) - free

    low = _SMALLEST**2
    if over(low) <= 0.0:
        return _SMALLEST
    high = float(squares.sum()) / free
    for _ in range(60):
        middle = np.sqrt(low * high)
        low, high = (middle, high) if over(middle) > 0.0 else (low, middle)
    return float(np.sqrt(high))
