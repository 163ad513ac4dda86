"""Neurons that no longer matter."""

import numpy as np

from handeye.arrays import Array, Integers
from handeye.networks.recursive.linear import back_substituted, symmetric, upper_factor, whitened
from handeye.networks.recursive.posterior import Posterior


def prune_block(posterior: Posterior, b: int, allowance: float) -> int:
    """Remove as many neurons of a block as the allowance lets; returns how many.

    Setting the weights W_J of neurons J to zero and the others to what is then best raises the
    regularised sum of squared errors by `W_J^T (P_JJ)^-1 W_J`, P the inverse of A (Hassibi and
    Stork 1993). With one block that bounds the sum of squared changes of the outputs at the samples
    learned since the last neuron came; several blocks know less of them than they saw.
    Neurons are taken in the order of what each would cost alone until their joint cost is above
    the allowance. The information about the rest, were those weights known to be zero, is what is
    left of A without their rows and columns: nothing is subtracted.
    """
    units = posterior.units
    n = int(units.counts[b])
    if n == 0:
        return 0
    factor = units.factor[b, :n, :n]
    covariance = symmetric(back_substituted(factor, whitened(factor, np.eye(n))))
    weights = units.weights[b, :, :n]
    alone = (weights**2).sum(axis=0) / np.diag(covariance)
    candidates = np.argsort(alone, kind="stable")
    candidates = candidates[: np.searchsorted(alone[candidates], allowance)]
    joint = upper_factor(covariance[np.ix_(candidates, candidates)]) if len(candidates) else None
    if joint is None:
        return 0
    costs = np.cumsum((whitened(joint, weights[:, candidates].T) ** 2).sum(axis=1))
    gone = candidates[: np.searchsorted(costs, allowance)]
    if len(gone):
        _remove(posterior, b, gone, covariance)
    return len(gone)


def _remove(posterior: Posterior, b: int, gone: Integers, covariance: Array) -> None:
    units = posterior.units
    n = int(units.counts[b])
    rest = np.setdiff1d(np.arange(n), gone)
    weights = units.weights[b, :, :n]
    among = upper_factor(covariance[np.ix_(gone, gone)])
    pull = back_substituted(among, whitened(among, weights[:, gone].T))
    kept = weights[:, rest] - (covariance[np.ix_(rest, gone)] @ pull).T
    units.weights[b, :, : len(rest)] = kept
    units.centers[b, :, : len(rest)] = units.centers[b][:, rest]
    for matrix in (posterior.information[b], posterior.prior[b]):
        matrix[: len(rest), : len(rest)] = matrix[np.ix_(rest, rest)]
    units.counts[b] = len(rest)
