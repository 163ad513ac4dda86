"""What a recursive network knows about its weights, and how that changes between samples."""

from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dpstrf

from handeye._compiled import compiled
from handeye.arrays import Array, Integers
from handeye.networks.kernels import squared_distances
from handeye.networks.recursive.linear import (
    add_squares,
    back_substituted,
    factorize,
    symmetric_product,
    upper_factor,
    whitened,
)
from handeye.networks.recursive.units import (
    Pending,
    Settings,
    Units,
    allocate_pending,
    allocate_units,
)
from handeye.networks.responses import Gaussian, respond

NUGGET = 1e-6
"""Added to a neuron's own overlap: neighbours may then be as close as they like."""

_ROUNDING = 1e-16  # of the largest information times the neurons: below lies only rounding


class Posterior(NamedTuple):
    """Units with the information about their weights, of which the upper triangles count.

    information (blocks, size, size): `sum o o^T / r` of the samples, forgotten ones less;
    prior (blocks, size, size): `rho (K + nugget)`, K the responses of the neurons to each other's
    centers, rho the noise ratio. In variances of the noise, `A = prior + information`.
    """

    units: Units
    pending: Pending
    information: Array
    prior: Array


def current_weights(posterior: Posterior, known: int) -> Array:
    """Weights (blocks, m, size) with the pending samples learned."""
    units, pending = posterior.units, posterior.pending
    weights = units.weights.copy()
    if known == 0:
        return weights
    step = back_substituted(pending.coupling[:known, :known], pending.innovations[:known])
    for b, n in enumerate(units.counts):
        if n:
            change = pending.solved[b, :n, :known] @ step
            weights[b, :, :n] += back_substituted(units.factor[b, :n, :n], change).T
    return weights


def consolidate(posterior: Posterior, settings: Settings, known: int) -> None:
    """Make the pending samples part of weights and information; the factors are left behind.

    Information is only ever added: `A_b <- f^q (A_b + O_b^T M_b^-1 O_b)` with q samples, their
    responses O_b, and M_b the covariance of their errors were the weights of block b known; f is
    the forgetting. With one block this is recursive least squares; several know nothing of the
    covariances between them, as in the decoupled extended Kalman filter (Puskorius and Feldkamp
    1994), but only from one consolidation to the next.
    """
    if known == 0:
        return
    units, pending = posterior.units, posterior.pending
    units.weights[:] = current_weights(posterior, known)
    own = settings.forgetting ** np.arange(1.0, known + 1.0)
    solved = [pending.solved[b, :n, :known] for b, n in enumerate(units.counts)]
    squares = [v.T @ v for v in solved] if len(solved) > 1 else []
    for b, n in enumerate(units.counts):
        o = pending.responses[b, :known, :n]
        if squares:
            others = np.diag(own) + sum(s for c, s in enumerate(squares) if c != b)
            rows = whitened(upper_factor(others), o)
        else:
            rows = o if settings.forgetting == 1.0 else o / np.sqrt(own)[:, np.newaxis]
        if n:
            keep = settings.forgetting**known
            faded = rows if keep == 1.0 else np.sqrt(keep) * rows
            add_squares(posterior.information[b, :n, :n], faded, keep)


def refactor(posterior: Posterior) -> None:
    """Factors of prior plus information, which is positive whatever was forgotten."""
    units = posterior.units
    for b, n in enumerate(units.counts):
        total = units.factor[b, :n, :n]
        # After very many samples the prior is lost in rounding; then it counts as this much, and
        # as more if that does not suffice.
        for rounding in _ROUNDING * n * 10.0 ** np.arange(12):
            np.add(posterior.prior[b, :n, :n], posterior.information[b, :n, :n], out=total)
            diagonal = np.einsum("ii->i", total)
            diagonal += rounding * diagonal.max(initial=0.0)
            if factorize(total):
                break


def prior_factor(posterior: Posterior, b: int) -> Array:
    """U of block b's prior, `prior = U^T U`; what is below the diagonal is anything."""
    n = posterior.units.counts[b]
    factor = posterior.prior[b, :n, :n].copy()
    if n:
        factorize(factor)
    return factor


def novel(
    posterior: Posterior, settings: Settings, b: int, points: Array, factor: Array
) -> Integers:
    """Which of the points (N, d) neither the neurons of block b nor each other represent.

    That of which most is missing, `1 - k^T K^-1 k`, is taken first, until no more than the novelty
    times the noise ratio is missing of any: what a neuron there could add to the outputs is then
    far below the noise (Csato and Opper 2002; Engel, Mannor and Meir 2004). Returned in order.
    Factor is that of the block's prior.
    """
    n = len(factor)
    left = np.empty((len(points), len(points)))
    overlap_stream(np.ascontiguousarray(points.T), points, left)
    np.einsum("ii->i", left)[...] += NUGGET
    if n:
        overlaps = np.empty((len(points), n))
        overlap_stream(posterior.units.centers[b, :, :n], points, overlaps)
        known = whitened(factor, overlaps.T)
        left -= settings.noise_ratio * (known.T @ known)
    least = NUGGET + settings.novelty * settings.noise_ratio
    if left.diagonal().max() <= least:
        return np.empty(0, np.int64)
    # LAPACK's factor with the largest pivot first, until that is no more than this.
    _, order, rank, _ = dpstrf(left, tol=least)
    return np.sort(order[:rank]) - 1


def add_neurons(
    posterior: Posterior, settings: Settings, b: int, points: Array, factor: Array
) -> None:
    """Add neurons of weight zero at points (N, d) to block b, which has room for them.

    What was learned before they came is known of the old neurons alone. A new one answers old
    samples as the old neurons together best imitate it, `a = K^-1 k`, so its information is that of
    its imitation (Csato and Opper 2002, eq 11); without it the old neurons would be certain of
    having explained alone what the new one is for. Factor is that of the block's prior before.
    """
    if len(points) == 0:
        return
    units = posterior.units
    old, new = units.counts[b], units.counts[b] + len(points)
    units.centers[b, :, old:new] = points.T
    units.weights[b, :, old:new] = 0.0
    overlaps = np.empty((new - old, new))
    overlap_stream(units.centers[b, :, :new], points, overlaps)
    posterior.prior[b, :new, old:new] = settings.noise_ratio * overlaps.T
    diagonal = np.einsum("ii->i", posterior.prior[b, old:new, old:new])
    diagonal += settings.noise_ratio * NUGGET
    information = posterior.information[b]
    information[:new, old:new] = 0.0
    if old:
        columns = posterior.prior[b, :old, old:new]
        imitation = back_substituted(factor, whitened(factor, columns))
        seen = symmetric_product(information[:old, :old], imitation)
        information[:old, old:new] = seen
        information[old:new, old:new] = imitation.T @ seen
    units.counts[b] = new


@compiled
def overlap_stream(centers: Array, points: Array, overlaps: Array) -> None:
    """Responses (N, n), overwritten, of neurons at centers (d, n) to points (N, d)."""
    n = centers.shape[1]
    z = np.empty(n)
    widths = np.full(n, 2.0)
    for i in range(len(points)):
        squared_distances(centers, 0, n, points[i], z)
        respond(Gaussian(), z, widths, overlaps[i])


def unrepresented(posterior: Posterior, inputs: Array) -> Array:
    """`1 - k^T K^-1 k` at scaled inputs (N, d): the part of the prior that no neuron covers."""
    least = np.ones(len(inputs))
    units = posterior.units
    for b, n in enumerate(units.counts):
        if n:
            overlaps = np.empty((len(inputs), n))
            overlap_stream(units.centers[b, :, :n], inputs, overlaps)
            factor = prior_factor(posterior, b)
            ratio = posterior.prior[b, 0, 0] / (1.0 + NUGGET)
            covered = ratio * (whitened(factor, overlaps.T) ** 2).sum(axis=0)
            least = np.minimum(least, 1.0 - covered)
    return np.clip(least, 0.0, 1.0)


def empty_posterior(n_inputs: int, n_outputs: int, size: int) -> Posterior:
    """One block without neurons, with room for `size`."""
    return Posterior(
        allocate_units(n_inputs, n_outputs, 1, size),
        allocate_pending(n_outputs, 1, size),
        np.zeros((1, size, size)),
        np.zeros((1, size, size)),
    )


def with_block(posterior: Posterior) -> Posterior:
    """The same with one more block without neurons; no sample may be pending."""
    units = posterior.units
    blocks, size = units.counts.size, units.factor.shape[1]
    more = allocate_units(units.centers.shape[1], units.weights.shape[1], blocks + 1, size)
    square = np.zeros((1, size, size))
    for old, new in zip(units, more, strict=True):
        new[:blocks] = old
    return Posterior(
        more,
        allocate_pending(units.weights.shape[1], blocks + 1, size),
        np.concatenate([posterior.information, square]),
        np.concatenate([posterior.prior, square]),
    )
