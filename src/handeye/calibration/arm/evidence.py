"""How wide the priors should be, and how noisy the sensor is: both from the observations.

Unknowns come in groups that share the width of their prior. With z the unknowns in units of their
stated tolerances, z ~ N(0, s_g^2) in group g, and residuals r of noise sigma_c in channel c,

    A = S + diag(1 / s^2),  S = sum w J^T J / sigma^2      information, prior included
    gamma_i = 1 - (A^-1)_ii / s_i^2                        how far observations determine z_i
    s_g^2 = sum_g z^2 / sum_g gamma                        where the evidence is greatest
    sum_c w r^2 / sigma^2 = sum_c (1 - h)                  the same for the noise; h, leverage

(MacKay 1992, "Bayesian interpolation"). A harmonic that the observations do not show is so switched
off, and a joint that is worse than its data sheet says is allowed to be. Residuals of a channel
follow a multivariate Student t, so that a wild one counts little (Lange, Little & Taylor 1989).
"""

from collections.abc import Callable, Iterator
from typing import NamedTuple, Protocol, cast

import numpy as np
from scipy.linalg import cho_solve, cholesky, solve_triangular
from scipy.linalg.blas import dsyrk
from scipy.linalg.lapack import dpotri

from handeye.arrays import Array, Booleans, Integers

FREEDOM = 5.0
"""Degrees of freedom of the t: tails such as real sensors have."""

# Widths of priors, over the stated ones; what has become this narrow is left out for good.
_LEAST, _MOST, _OFF = 1e-4, 10.0, 1e-3
_ROUNDS, _FEWEST, _WIDTHS = 20, 8, 2
# While residuals are still those of a nominal robot, everything fine looks like noise: widths stay
# as stated at first, and what they switch off may still come back for a while.
_STATED, _UNDECIDED = 3, 7
# Done when no unknown moves by more than this part of its standard deviation, nor the noise.
_SETTLED, _SAME_NOISE = 0.3, 0.02
_SMALLEST = 1e-9


class Rows(NamedTuple):
    """Some rows of a system, linearised.

    residuals (M, k) measured minus predicted, slopes (M, k, n) their derivatives by the unknowns,
    std (M, k) as stated, channels (k,) of the values, first: number of the first row.
    """

    residuals: Array
    slopes: Array
    std: Array
    channels: Integers
    first: int


class System(Protocol):
    """Equations in n unknowns, nominally 0."""

    @property
    def tolerance(self) -> Array:
        """(n,) standard deviations of the priors, as stated."""
        ...

    @property
    def groups(self) -> Integers:
        """(n,) numbers from 0 of what shares a width, or -1 where it is as stated."""
        ...

    @property
    def n_rows(self) -> int:
        """Of equations."""
        ...

    @property
    def n_channels(self) -> int:
        """Of noise."""
        ...

    def rows(self, x: Array, *, slopes: bool = True) -> Iterator[Rows]:
        """All equations at x (n,), some rows at a time; without `slopes` these are empty."""
        ...


class Posterior(NamedTuple):
    """What is known of n unknowns after N rows in C channels.

    x          (n,) the estimate
    widths     (n,) standard deviations of the priors, as found
    root       (n, n) lower triangular; root root^T is the information in units of the stated
               tolerances, with priors as wide as found or as stated, whichever is wider: that
               nothing was seen of an unknown does not make it small
    noise      (C,) standard deviation of each channel beyond what was stated
    squares    (N, C) squared residuals over their variance; nan where a row has no such channel
    leverage   (N, C) how far a row determines what is predicted for it, 0 to the channel's values
    """

    x: Array
    widths: Array
    root: Array
    noise: Array
    squares: Array
    leverage: Array


def solve(system: System, after_each: Callable[[int, int], None] | None = None) -> Posterior:
    """The most probable unknowns, with the priors and noise for which the evidence is greatest.

    after_each(round, rounds) is called after each round. Every round linearises anew: O(N k n^2).
    """
    tau, groups = system.tolerance, system.groups
    z, width = np.zeros(len(tau)), np.ones(len(tau))
    used = np.ones(len(tau), np.bool_)
    root = np.eye(len(tau))
    noise = _first_noise(system)
    for number in range(_ROUNDS):
        S, g = _information(system, tau * z, noise, used)
        total, old = S.sum(axis=0), z[used]
        wanted = total @ old - g
        inverse = total
        for _ in range(_WIDTHS):
            root = cast("Array", cholesky(total + np.diag(width[used] ** -2.0), lower=True))
            z[used] = cho_solve((root, True), wanted)
            inverse = _inverse(root)
            if number < _STATED:
                break
            gamma = 1.0 - np.diag(inverse) / width[used] ** 2
            width[used] = _widths(groups[used], z[used], gamma, width[used])
        moved = np.max(np.abs(z[used] - old) / np.sqrt(np.diag(inverse)))
        before = noise.noise
        known = np.array([np.sum(inverse * part) for part in S])
        noise = _noise(system, tau * z, known, noise)
        if after_each is not None:
            after_each(number + 1, _ROUNDS)
        same = np.all(np.abs(np.log(noise.noise / before)) < _SAME_NOISE)
        if number + 1 == _ROUNDS or (number + 1 >= _FEWEST and same and moved < _SETTLED):
            break
        if number >= _UNDECIDED:
            used = used & (width >= _OFF)
            z[~used] = 0.0
    leverage = _leverage(system, tau * z, noise, used, root)
    every, _ = _information(system, tau * z, noise, np.ones_like(used))
    stated = np.diag(np.maximum(width, 1.0) ** -2.0)
    wide = cast("Array", cholesky(every.sum(axis=0) + stated, lower=True))
    return Posterior(tau * z, tau * width, wide, noise.noise, noise.squares, leverage)


class _Noise(NamedTuple):
    """Of each channel (C,), squares (N, C) of residuals over variance, values (C,) in a row."""

    noise: Array
    squares: Array
    values: Integers

    def weights(self) -> Array:
        """(N, C) of the squared residuals; the first factor is what tails take of information."""
        freedom = FREEDOM + self.values
        tails = freedom / (freedom + 2.0)
        return tails * freedom / (FREEDOM + np.nan_to_num(self.squares))


def _whitened(rows: Rows, tau: Array, noise: _Noise, used: Booleans) -> tuple[Array, Array]:
    """Residuals (M, k) and slopes (M, k, n) of used unknowns in tolerances, weighted."""
    inside = slice(rows.first, rows.first + len(rows.residuals))
    weights = noise.weights()[inside][:, rows.channels]
    scale = np.sqrt(weights / (rows.std**2 + noise.noise[rows.channels] ** 2))
    return rows.residuals * scale, rows.slopes[:, :, used] * (scale[..., np.newaxis] * tau[used])


def _information(system: System, x: Array, noise: _Noise, used: Booleans) -> tuple[Array, Array]:
    """S of each channel (C, n, n), and the gradient (n,)."""
    n = int(used.sum())
    S, g = np.zeros((system.n_channels, n, n)), np.zeros(n)
    for rows in system.rows(x):
        r, J = _whitened(rows, system.tolerance, noise, used)
        for c in np.unique(rows.channels):
            own = rows.channels == c
            flat = np.ascontiguousarray(J[:, own]).reshape(-1, n)
            S[c] += dsyrk(1.0, flat.T, lower=True)
            g += flat.T @ r[:, own].reshape(-1)
    return S + np.tril(S, -1).swapaxes(1, 2), g


def _inverse(root: Array) -> Array:
    inverse, failed = dpotri(root, lower=True)
    assert failed == 0
    return inverse + np.tril(inverse, -1).T


def _leverage(system: System, x: Array, noise: _Noise, used: Booleans, root: Array) -> Array:
    out = np.zeros(noise.squares.shape)
    for rows in system.rows(x):
        _, J = _whitened(rows, system.tolerance, noise, used)
        half = solve_triangular(root, J.reshape(-1, J.shape[-1]).T, lower=True)
        lever = np.sum(half**2, axis=0).reshape(J.shape[:2])
        for c in np.unique(rows.channels):
            inside = slice(rows.first, rows.first + len(lever))
            out[inside, c] = np.sum(lever[:, rows.channels == c], axis=1)
    return out


def _widths(groups: Integers, z: Array, gamma: Array, width: Array) -> Array:
    free = groups >= 0
    squares = np.bincount(groups[free], weights=z[free] ** 2)
    known = np.bincount(groups[free], weights=np.clip(gamma[free], 0.0, 1.0))
    found = np.sqrt(squares / np.maximum(known, _SMALLEST))
    out = width.copy()
    out[free] = np.clip(found, _LEAST, _MOST)[groups[free]]
    return out


def _first_noise(system: System) -> _Noise:
    """As if all residuals at the start were noise, by their medians."""
    squares, _, values = _errors(system, np.zeros(len(system.tolerance)))
    noise = np.maximum(np.sqrt(np.nanmedian(squares, axis=0) / values), _SMALLEST)
    return _Noise(noise, squares / noise**2, values)


def _noise(system: System, x: Array, known: Array, before: _Noise) -> _Noise:
    """Noise after a step; known (C,) is how many values of each channel the unknowns took up."""
    errors, stated, values = _errors(system, x)
    freedom = FREEDOM + values
    weights = before.weights() * (freedom + 2.0) / freedom
    noise = np.empty(len(values))
    for c in range(len(values)):
        has = np.isfinite(errors[:, c])
        free = max(float(values[c] * has.sum() - known[c]), 1.0)
        noise[c] = _beyond(weights[has, c] * errors[has, c], stated[has, c], free)
    return _Noise(noise, errors / np.maximum(stated + noise**2, _SMALLEST**2), values)


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
