"""The arrays of a recursive network: neurons in blocks, and samples not yet consolidated."""

from typing import NamedTuple

import numpy as np

from handeye.arrays import Array, Integers
from handeye.networks.recursive.linear import DEPTH, PANEL

LONGEST = 512
"""Most samples between two consolidations."""

_STRIDE = LONGEST + DEPTH  # a power of two would send a column's entries to the same place in cache


NOISE_WINDOW = 1000.0
"""Samples over which the noise is averaged."""


class Units(NamedTuple):
    """Neurons in blocks: neuron j of block b is entry [b, ..., j]; entries past counts[b] are free.

    centers (blocks, d, size) in scaled inputs, weights (blocks, m, size), counts (blocks,),
    factor (blocks, size, size): U with `A = U^T U`, A the information about the block's weights.
    """

    centers: Array
    weights: Array
    counts: Integers
    factor: Array


class Pending(NamedTuple):
    """Samples since the last consolidation, sample q of them at index q.

    responses (blocks, LONGEST, size), solved (blocks, size, > LONGEST): `U^-T o`; coupling
    (LONGEST, > LONGEST): the upper factor of the covariance of their errors; innovations
    (LONGEST, m): their errors in standard deviations.
    """

    responses: Array
    solved: Array
    coupling: Array
    innovations: Array


class Settings(NamedTuple):
    """The numbers of a network that never change.

    block               most neurons whose weights know their covariances
    noise_ratio         variance of the noise over the prior variance of the function
    forgetting          weight of the past at each new sample
    distance_threshold  theta_d: a neuron is added only farther than this from every other
    novelty             a neuron is added only where more is missing, over the noise ratio
    error_threshold     theta_e: a neuron is added only for a larger error
    prune_tolerance     root mean square by which one pruning may change past outputs; 0: none
    relevance_samples   samples from which the scales are estimated; 0: the given ones stay
    """

    block: int
    noise_ratio: float
    forgetting: float
    distance_threshold: float
    novelty: float
    error_threshold: float
    prune_tolerance: float
    relevance_samples: int


class Scratch(NamedTuple):
    """Room for one panel: distances and widths (size,), solved (PANEL, size), and so on."""

    z: Array
    widths: Array
    solved: Array
    coupled: Array
    nearest: Array


class Arrays(NamedTuple):
    """Everything that a sample changes or needs.

    noise (m,): estimated variances of the noise; waiting (LONGEST, d): points that become neurons
    at the next consolidation.
    """

    units: Units
    pending: Pending
    scratch: Scratch
    noise: Array
    waiting: Array


class Progress(NamedTuple):
    """Samples pending, points waiting, all samples so far, and how many neurons may be added."""

    known: int
    waits: int
    trials: int
    room: int


def allocate_units(n_inputs: int, n_outputs: int, blocks: int, size: int) -> Units:
    """Room for so many blocks of so many neurons; memory that is not used is not touched."""
    return Units(
        np.zeros((blocks, n_inputs, size)),
        np.zeros((blocks, n_outputs, size)),
        np.zeros(blocks, np.int64),
        np.zeros((blocks, size, size)),
    )


def allocate_pending(n_outputs: int, blocks: int, size: int) -> Pending:
    """Room for LONGEST samples."""
    return Pending(
        np.zeros((blocks, LONGEST, size)),
        np.zeros((blocks, size, _STRIDE)),
        np.zeros((LONGEST, _STRIDE)),
        np.zeros((LONGEST, n_outputs)),
    )


def allocate_scratch(size: int) -> Scratch:
    """Kept between samples, since asking for memory takes longer."""
    return Scratch(
        np.empty(size),
        np.full(size, 2.0),  # o = exp(-z / 2): one scale is one standard deviation
        np.empty((PANEL, size)),
        np.empty((PANEL, _STRIDE)),
        np.empty(PANEL),
    )
