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
from typing import NamedTuple

import numpy as np
from scipy.linalg import cho_solve
from scipy.linalg.lapack import dlauum, dtrtri

from handeye.arrays import Array, Integers
from handeye.calibration.arm.lines import Lines, lines_at, root_of
from handeye.calibration.arm.posterior import Posterior
from handeye.calibration.arm.student import first_noise, least_noise, noise_at
from handeye.calibration.arm.system import System

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
    least = least_noise(system, tau * z)
    noise, told = first_noise(system, tau * z, least), np.empty((0, 0))
    for number in range(_ROUNDS):
        if number > _UNDECIDED:
            used = used & (width >= _OFF)
            z[~used] = 0.0
        lines = lines_at(system, tau * z, noise, used)
        groups = system.groups[used] if number >= _STATED else np.full(int(used.sum()), -1)
        step = _step(lines, z[used], width[used], groups)
        z[used], width[used] = step.z, step.width
        before = noise.noise
        noise = noise_at(system, tau * z, step.known, noise, least)
        if after_each is not None:
            after_each(number + 1, _ROUNDS)
        same = np.all(np.abs(np.log(noise.noise / before)) < _SAME_NOISE)
        told = np.tensordot(step.scale, lines.information, 1)
        if number + 1 >= _FEWEST and same and step.moved < _SETTLED:
            break
    return Posterior(tau * z, tau * width, used, system, noise, told)


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


def _step(lines: Lines, old: Array, width: Array, groups: Integers) -> _Step:
    """Unknowns, widths and noise for which the evidence of straight lines is greatest."""
    S, g = lines.information, lines.gradient
    # How much smaller the variance of each channel is than it was when the lines were weighted.
    scale = np.ones(len(S))
    most = 1.0 / np.maximum(lines.stated, _SMALLEST)
    z, known, moved = old, np.zeros(len(S)), 0.0
    for number in range(_WIDTHS):
        total = np.tensordot(scale, S, 1)
        root = root_of(total, width)
        z = cho_solve((root, True), total @ old - scale @ g)
        half = _inverse(root)
        off = z - old
        gamma = np.clip(1.0 - np.einsum("ij,ij->j", half, half) / width**2, 0.0, 1.0)
        known = _known(half, scale, S, gamma if number + 1 < _WIDTHS else None)
        left = np.array([lines.squares[c] + (2.0 * g[c] + S[c] @ off) @ off for c in range(len(S))])
        free = np.maximum(lines.values - known, 1.0)
        scale = np.minimum(free / np.maximum(left / lines.tails, _SMALLEST * free), most)
        # Where nothing moves rounding may make it negative.
        moved = float(np.sqrt(max(off @ total @ off, 0.0) / max(gamma.sum(), 1.0)))
        width = _widths(groups, z, gamma, width)
    return _Step(z, width, known, scale, moved)


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
