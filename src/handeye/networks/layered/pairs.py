"""Networks built of paired sigmoids (section A.6.6): pulses, sinusoids and Gaussians.

Two hyperbolic tangents of opposite gain whose thresholds lie apart make a bump. With thresholds
pi apart it comes close to one period of 1 + cos, and also to a Gaussian: there the fourth cumulant
of the bump vanishes, as a Gaussian's does. Such pairs, side by side in one hidden layer, start a
network as a Fourier series or as a table of Gaussians; what they then learn is up to
back-propagation, which may change every weight and threshold.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, count, finite, scalar, shaped
from handeye.errors import InvalidInput
from handeye.networks.inputs import InputSpace
from handeye.networks.layered.activations import Linear, Tanh
from handeye.networks.layered.network import LayeredNetwork

APART = np.pi
"""Distance of the thresholds of a pair that resembles a sinusoid (figure A.7)."""

HALF_WIDTH = 0.5 * float(np.arccosh(2.0 + np.cosh(APART)))
"""Where a pair of unit gain has fallen to half its greatest value."""


class Pairs(NamedTuple):
    """Bumps `tanh(g (u - c) + apart/2) - tanh(g (u - c) - apart/2)` over u in [-1, 1].

    gains g, centers c, heights: what each adds to the output for 1 of its sum; all (n,).
    """

    gains: Array
    centers: Array
    heights: Array


def pair(x: ArrayLike, gain: float = 1.0, apart: float = APART) -> Array:
    """The sum of two hyperbolic tangents of gains +- `gain` with thresholds `apart` apart.

    `tanh(gain (x + apart/2)) - tanh(gain (x - apart/2))`, which is 2 between the thresholds and 0
    outside where the gain is large (figure A.6). With unit gain and thresholds pi apart it differs
    from 1 + cos(x) by at most 0.17 for |x| <= pi and is below 0.083 beyond (figure A.7).
    """
    at = finite(x, "x")
    g, half = scalar(gain, "gain", above=0.0), 0.5 * scalar(apart, "apart", above=0.0)
    return np.tanh(g * (at + half)) - np.tanh(g * (at - half))


def fourier_network(
    low: float,
    high: float,
    order: int,
    coefficients: ArrayLike | None = None,
    constant: float = 0.0,
    **settings: Any,
) -> LayeredNetwork:
    """A network of one input that begins as an approximate Fourier series (figure A.8).

    `constant + sum_n a_n cos(n xi) + b_n sin(n xi)`, where xi runs over [-pi, pi] as the input does
    from low to high. A harmonic is made of as many pairs as it takes to cover the interval, each
    n times as steep as those of the first.

    Args:
        low: where the interval begins.
        high: where it ends.
        order: the highest n.
        coefficients: a_n and b_n, (order, 2); by default 1/n, as in the thesis.
        constant: the mean.
        settings: of `LayeredNetwork`, such as the rate.
    """
    harmonics = np.arange(1, count(order, "order") + 1)
    if coefficients is None:
        given = np.repeat(1.0 / harmonics, 2).reshape(-1, 2)
    else:
        given = shaped(coefficients, (len(harmonics), 2), "coefficients")
    parts = [
        _harmonic(int(n), shift, height)
        for n, heights in zip(harmonics, given, strict=True)
        for shift, height in zip((0.0, 0.5 * np.pi), heights.tolist(), strict=True)
    ]
    bumps = Pairs(*(np.concatenate(column) for column in zip(*parts, strict=True)))
    # The bumps of a harmonic add up to 1 + cos: the ones are absorbed in the constant.
    return paired_network(low, high, bumps, scalar(constant, "constant") - given.sum(), **settings)


def gaussian_network(
    low: float, high: float, n_modules: int, half_max_fraction: float = 1.2, **settings: Any
) -> LayeredNetwork:
    """A network of one input that begins as evenly spread Gaussian modules of no weight.

    Args:
        low: where the interval begins, and the first module lies.
        high: where it ends, and the last one lies.
        n_modules: pairs, at least two.
        half_max_fraction: a module answers half as much as at its center at this multiple of the
            distance to its neighbour.
        settings: of `LayeredNetwork`, such as the rate.
    """
    n = count(n_modules, "n_modules", least=2)
    half = scalar(half_max_fraction, "half_max_fraction", above=0.0) * 2.0 / (n - 1)
    bumps = Pairs(np.full(n, HALF_WIDTH / half), np.linspace(-1.0, 1.0, n), np.zeros(n))
    return paired_network(low, high, bumps, **settings)


def paired_network(
    low: float, high: float, pairs: Pairs, constant: float = 0.0, **settings: Any
) -> LayeredNetwork:
    """A network of one input and one hidden layer of pairs, placed as `pairs` says.

    The interval from low to high is u from -1 to 1. Neurons 2 j and 2 j + 1 are pair j.
    """
    gains, centers, heights = (
        shaped(column, (len(pairs.gains),), name) for name, column in pairs._asdict().items()
    )
    network = LayeredNetwork(
        1, 1, (2 * len(gains),), inputs=InputSpace.box([low], [high]),
        activation=Tanh(), output=Linear(), **settings,
    )  # fmt: skip
    if not np.all(gains > 0.0):
        raise InvalidInput(f"gains must be positive, got {gains}")
    steep = np.stack([gains, -gains], axis=-1)
    # Both halves rise towards their center: -gain u + gain c + apart/2 is the falling one.
    shifts = 0.5 * APART - steep * centers[:, np.newaxis]
    above = np.repeat(heights, 2) / network.output_scale
    network.weights = [
        np.column_stack([steep.ravel(), shifts.ravel()]),
        np.append(above, constant / network.output_scale)[np.newaxis],
    ]
    return network


def _harmonic(n: int, shift: float, height: float) -> Pairs:
    """Bumps that add up to 1 + cos(n xi - shift) over the interval, xi = pi u."""
    peaks = 2.0 * np.pi * np.arange(-n, n + 1) + shift
    reaching = peaks[np.abs(peaks) < (n + 1 - 1e-9) * np.pi]
    steep = np.full(len(reaching), n * np.pi)
    return Pairs(steep, reaching / steep, np.full(len(reaching), height))
