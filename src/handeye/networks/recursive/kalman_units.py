"""The arrays of a Kalman network: every neuron with the root of its own covariance."""

from typing import NamedTuple

import numpy as np

from handeye.arrays import Array, Integers

LEAST_WIDTH, MOST_WIDTH = 1e-3, 1e2
"""Of a neuron, in scales; a scale stays as near to what it was at first."""


class Units(NamedTuple):
    """All neurons; entries past the last neuron are free.

    centers (d, size) in inputs over their first scales; widths (size,): `R = 2 h^2`, h one standard
    deviation of the response; weights (m, size); roots (size, p, p): S, where `S S^T` is the
    covariance of the p = m + d + 1 numbers of a neuron (weights, center, log h); prior (size, p):
    their standard deviations when it came; use (size,): sum of its squared responses since; born
    (size,): trials then.
    """

    centers: Array
    widths: Array
    weights: Array
    roots: Array
    prior: Array
    use: Array
    born: Integers


class Shared(NamedTuple):
    """What all neurons share.

    precision (d,): (first scale over scale of now)^2; root (d, d) of the covariance of the
    logarithms of the scales; noise (m,): variances.
    """

    precision: Array
    root: Array
    noise: Array


class Settings(NamedTuple):
    """The numbers of a Kalman network that never change; KalmanNetwork says what they do."""

    neighbours: int
    overlap: float
    weight_deviation: float
    shape_deviation: float
    scale_deviation: float
    noise_deviation: float
    forgetting: float
    distance_threshold: float
    error_threshold: float
    prune_tolerance: float


class Work(NamedTuple):
    """Scratch for one sample.

    z and o (size,): squared distances and responses; for k neighbours which (k,), slopes (k, m, p),
    seen (k, p): `S^T h` for one output, and steps (k, p); for the scales by_scale (m, d),
    scale_seen and scale_step (d,).
    """

    z: Array
    o: Array
    which: Integers
    slopes: Array
    seen: Array
    steps: Array
    by_scale: Array
    scale_seen: Array
    scale_step: Array


def allocate_units(n_inputs: int, n_outputs: int, size: int) -> Units:
    """Room for `size` neurons."""
    p = n_outputs + n_inputs + 1
    return Units(
        np.zeros((n_inputs, size)),
        np.ones(size),
        np.zeros((n_outputs, size)),
        np.zeros((size, p, p)),
        np.zeros((size, p)),
        np.zeros(size),
        np.zeros(size, np.int64),
    )


def allocate_work(n_inputs: int, n_outputs: int, size: int, neighbours: int) -> Work:
    """Kept between samples, since asking for memory takes longer."""
    p, d, m = n_outputs + n_inputs + 1, n_inputs, n_outputs
    return Work(
        np.zeros(size),
        np.zeros(size),
        np.zeros(neighbours, np.int64),
        np.zeros((neighbours, m, p)),
        np.zeros((neighbours, p)),
        np.zeros((neighbours, p)),
        np.zeros((m, d)),
        np.zeros(d),
        np.zeros(d),
    )
