"""How wide the priors should be, and how noisy the sensor is: both from the observations.

Unknowns come in groups that share the width of their prior. With z the unknowns in units of their
stated tolerances, z ~ N(0, s_g^2) in group g, and residuals r of noise sigma_c in channel c,

    A = S + diag(1 / s^2),  S = sum w J^T J / sigma^2      information, prior included
    gamma_i = 1 - (A^-1)_ii / s_i^2                        how far observations determine z_i
    s_g^2 = sum_g z^2 / sum_g gamma                        where the evidence is greatest
    sum_c w r^2 / sigma^2 = sum_c (d - h)                  the same for the noise (`student`)

(MacKay 1992, "Bayesian interpolation"). A harmonic that the observations do not show is so switched
off, and a joint that is worse than its data sheet says is allowed to be.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.linalg import cho_solve, cholesky, solve_triangular
from scipy.linalg.blas import dsyrk
from scipy.linalg.lapack import dlauum, dtrtri

from handeye.arrays import Array, Booleans, Integers
from handeye.calibration.arm.student import Noise, first_noise, noise_at
from handeye.calibration.arm.system import Rows, System

# Widths of priors, over the stated ones; what has become this narrow is left out for good.
_LEAST, _MOST, _OFF = 1e-4, 10.0, 1e-3
# Rounds at most and at least; in each, widths and noise are found so often on the same tangents.
_ROUNDS, _FEWEST, _WIDTHS = 20, 4, 3
# While residuals are still those of a nominal robot, everything fine looks like noise: widths stay
# as stated at first, and what they switch off may still come back for a while.
_STATED, _UNDECIDED = 1, 3
# Done when predictions move by less than this part of their standard deviation, and the noise.
_SETTLED, _SAME_NOISE = 0.1, 0.02
_SMALLEST = 1e-9


@dataclass(frozen=True, eq=False)
class Posterior:
    """What is known of n unknowns after N rows in C channels.

    x          (n,) the estimate
    widths     (n,) standard deviations of the priors, as found
    used       (n,) those that were not switched off; the others are 0
    noise      (C,) standard deviation of each channel beyond what was stated
    squares    (N, C) squared residuals over their variance; nan where a row has no such channel

    `_told` (m, m) is the information of the rows on the used unknowns, by the latest tangents.
    """

    x: Array
    widths: Array
    used: Booleans
    squares: Array
    _system: System
    _noise: Noise
    _told: Array

    @property
    def noise(self) -> Array:
        """(C,) standard deviation of each channel beyond what was stated."""
        return self._noise.noise

    def rows_say(self, which: Booleans) -> Array:
        """Information (m, m) of the rows on the unknowns of `which` (n,), in stated tolerances."""
        if not np.any(which & ~self.used):
            inside = which[self.used]
            return self._told[np.ix_(inside, inside)]
        return _lines(self._system, self.x, self._noise, which).information.sum(axis=0)

    @cached_property
    def root(self) -> Array:
        """(n, n) lower triangular; root root^T is the information in units of stated tolerances.

        With priors as wide as found or as stated, whichever is wider: that nothing was seen of an
        unknown does not make it small.
        """
        width = np.maximum(self.widths / self._system.tolerance, 1.0)
        inside = self.rows_say(np.ones_like(self.used)) + np.diag(width**-2.0)
        return cholesky(inside, lower=True)

    @cached_property
    def leverage(self) -> Array:
        """(N, C) how far a row determines what is predicted for it, 0 to the channel's values."""
        system, used = self._system, self.used
        width = (self.widths / system.tolerance)[used]
        inside = self.rows_say(used) + np.diag(width**-2.0)
        root = cholesky(inside, lower=True)
        out = np.zeros(self.squares.shape)
        for rows in system.rows(self.x):
            _, J = _whitened(rows, system.tolerance, self._noise, used)
            half = solve_triangular(root, J.reshape(-1, J.shape[-1]).T, lower=True)
            lever = np.sum(half**2, axis=0).reshape(J.shape[:2])
            for c in np.unique(rows.channels):
                some = slice(rows.first, rows.first + len(lever))
                out[some, c] = np.sum(lever[:, rows.channels == c], axis=1)
        return out


def solve(
    system: System, after_each: Callable[[int, int], None] | None = None, start: Array | None = None
) -> Posterior:
    """The most probable unknowns, with the priors and noise for which the evidence is greatest.

    start (n,): near the unknowns, by default 0. after_each(round, rounds) is called after each
    round. Every round linearises anew: O(N k n^2).
    """
    tau = system.tolerance
    z = np.zeros(len(tau)) if start is None else start / tau
    width, used = np.ones(len(tau)), system.shown.copy()
    z[~used] = 0.0
    noise, told = first_noise(system, tau * z), np.empty((0, 0))
    for number in range(_ROUNDS):
        if number > _UNDECIDED:
            used = used & (width >= _OFF)
            z[~used] = 0.0
        lines = _lines(system, tau * z, noise, used)
        groups = system.groups[used] if number >= _STATED else np.full(int(used.sum()), -1)
        step = _step(lines, z[used], width[used], groups)
        z[used], width[used] = step.z, step.width
        before = noise.noise
        noise = noise_at(system, tau * z, step.known, noise)
        if after_each is not None:
            after_each(number + 1, _ROUNDS)
        same = np.all(np.abs(np.log(noise.noise / before)) < _SAME_NOISE)
        told = np.tensordot(step.scale, lines.information, 1)
        if number + 1 >= _FEWEST and same and step.moved < _SETTLED:
            break
    return Posterior(tau * z, tau * width, used, noise.squares, system, noise, told)


class _Lines(NamedTuple):
    """Weighted equations of each channel about a point: S (C, n, n), J^T r (C, n), r^2 (C,).

    values (C,): how many there are; stated (C,): share of their variance that was stated; tails
    (C,) what tails leave of information.
    """

    information: Array
    gradient: Array
    squares: Array
    values: Array
    stated: Array
    tails: Array


class _Step(NamedTuple):
    """Unknowns z (n,), widths (n,), and how many values of rows they took up, known (C,).

    scale (C,) of information, by which noise has become smaller; moved: root mean square change of
    predictions, over their standard deviation.
    """

    z: Array
    width: Array
    known: Array
    scale: Array
    moved: float


def _step(lines: _Lines, old: Array, width: Array, groups: Integers) -> _Step:
    """Unknowns, widths and noise for which the evidence of straight lines is greatest."""
    S, g = lines.information, lines.gradient
    # How much smaller the variance of each channel is than it was when the lines were weighted.
    scale = np.ones(len(S))
    most = 1.0 / np.maximum(lines.stated, _SMALLEST)
    z, known, moved = old, np.zeros(len(S)), 0.0
    for number in range(_WIDTHS):
        total = np.tensordot(scale, S, 1)
        root = cholesky(total + np.diag(width**-2.0), lower=True)
        z = cho_solve((root, True), total @ old - scale @ g)
        half = _inverse(root)
        off = z - old
        gamma = np.clip(1.0 - np.einsum("ij,ij->j", half, half) / width**2, 0.0, 1.0)
        known = _known(half, scale, S, gamma if number + 1 < _WIDTHS else None)
        left = np.array([lines.squares[c] + (2.0 * g[c] + S[c] @ off) @ off for c in range(len(S))])
        free = np.maximum(lines.values - known, 1.0)
        scale = np.minimum(free / np.maximum(left / lines.tails, _SMALLEST * free), most)
        moved = float(np.sqrt(off @ total @ off / max(gamma.sum(), 1.0)))
        width = _widths(groups, z, gamma, width)
    return _Step(z, width, known, scale, moved)


def _whitened(rows: Rows, tau: Array, noise: Noise, used: Booleans) -> tuple[Array, Array]:
    """Residuals (M, k) and slopes (M, k, n) of used unknowns in tolerances, weighted."""
    inside = slice(rows.first, rows.first + len(rows.residuals))
    weights = noise.weights()[inside][:, rows.channels]
    scale = np.sqrt(weights / (rows.std**2 + noise.noise[rows.channels] ** 2))
    slopes = rows.slopes if used.all() else rows.slopes[:, :, used]
    return rows.residuals * scale, slopes * (scale[..., np.newaxis] * tau[used])


def _lines(system: System, x: Array, noise: Noise, used: Booleans) -> _Lines:
    """All equations, linearised at x (n,), by channel."""
    n, C = int(used.sum()), system.n_channels
    sums, g = [np.zeros((n, n), order="F") for _ in range(C)], np.zeros((C, n))
    squares, values, stated = np.zeros(C), np.zeros(C), np.zeros(C)
    for rows in system.rows(x):
        r, J = _whitened(rows, system.tolerance, noise, used)
        for c in np.unique(rows.channels):
            own = rows.channels == c
            flat = np.ascontiguousarray(J[:, own]).reshape(-1, n)
            wanted = r[:, own].reshape(-1)
            sums[c] = dsyrk(1.0, flat.T, beta=1.0, c=sums[c], overwrite_c=1, lower=True)
            g[c] += flat.T @ wanted
            squares[c] += wanted @ wanted
            values[c] += len(wanted)
            variance = rows.std[:, own] ** 2
            stated[c] += np.sum(variance / (variance + noise.noise[c] ** 2))
    S = np.array([part + np.tril(part, -1).T for part in sums])
    return _Lines(S, g, squares, values, stated / np.maximum(values, 1.0), noise.tails)


def _inverse(root: Array) -> Array:
    inverse, failed = dtrtri(root, lower=True)
    assert failed == 0
    return inverse


def _known(half: Array, scale: Array, S: Array, gamma: Array | None) -> Array:
    """tr(A^-1 S_c) (C,) of each channel, with A^-1 = half^T half.

    With gamma (n,) about that, which is quicker: what is known of an unknown is divided among the
    channels by how much each says of it.
    """
    if gamma is None:
        inverse, failed = dlauum(half, lower=True)
        assert failed == 0
        inverse = inverse + np.tril(inverse, -1).T
        return np.array([scale[c] * np.sum(inverse * S[c]) for c in range(len(S))])
    says = scale[:, np.newaxis] * np.diagonal(S, axis1=1, axis2=2)
    return (says / np.maximum(says.sum(axis=0), _SMALLEST)) @ gamma


def _widths(groups: Integers, z: Array, gamma: Array, width: Array) -> Array:
    """Widths (n,) for which the evidence is greatest; of group -1 they stay."""
    free = groups >= 0
    squares = np.bincount(groups[free], weights=z[free] ** 2)
    known = np.bincount(groups[free], weights=gamma[free])
    found = np.sqrt(squares / np.maximum(known, _SMALLEST))
    out = width.copy()
    out[free] = np.clip(found, _LEAST, _MOST)[groups[free]]
    return out
