"""Response functions: how strongly a neuron answers an input at a distance from its center.

A kind is a NamedTuple class with three compiled functions, registered below; a new one needs
nothing else (docs/how-to/extend-networks.md).
"""

from typing import NamedTuple

import numpy as np

from handeye._compiled import by_kind, compiled
from handeye.arrays import Array


class Gaussian(NamedTuple):
    """`o = exp(-z / R)`, z the squared distance; R = (half-maximum distance)^2 / ln 2 (eq 3.45)."""


class Cosine(NamedTuple):
    """`o = (1 + cos(pi d / R)) / 2` inside d < R, else 0 (eq 3.107); R is two half distances."""


class Parabolic(NamedTuple):
    """Two parabolas joined at d = R/2, 0 outside R (eq 3.108); R is two half distances."""


@by_kind
def respond(response: NamedTuple, z: Array, widths: Array, out: Array) -> None:
    """Responses to squared distances: z, widths, out (n,); out is overwritten."""


@by_kind
def width(response: NamedTuple, half_distance: float) -> float:
    """Width parameter R of a neuron whose response falls to one half at that distance (note E7)."""
    return half_distance


@by_kind
def slopes(response: NamedTuple, z: Array, widths: Array, by_z: Array, by_width: Array) -> None:
    """Derivatives of the response by z and by R, all (n,); the last two are overwritten."""


# exp(x) = 2^k e^f with x = k ln 2 + f. Adding 1.5 * 2^52 rounds to a whole number and leaves it in
# the low bits, from where a shift by 52 makes it the exponent: no branch and no call, so the loop
# fills the vector units.
_LOG2_E = 1.4426950408889634
_LN2_HIGH = 0.693147180369123816490
_LN2_LOW = 1.90821492927058770002e-10
_NO_BITS = 6755399441055744.0  # 1.5 * 2^52: shifted, its bits are those of zero
_ROUND = _NO_BITS + 1023.0  # and the bias of the exponent
_SMALLEST_EXPONENT = -708.0  # below exp(-708) a double is denormal: the response is 0
_EXPONENT_SHIFT = np.int64(52)


@compiled
def _exp_series(f: float) -> float:
    """e^f for |f| <= ln(2) / 2, to the last place."""
    series = 1.0 / 6227020800.0
    series = series * f + 1.0 / 479001600.0
    series = series * f + 1.0 / 39916800.0
    series = series * f + 1.0 / 3628800.0
    series = series * f + 1.0 / 362880.0
    series = series * f + 1.0 / 40320.0
    series = series * f + 1.0 / 5040.0
    series = series * f + 1.0 / 720.0
    series = series * f + 1.0 / 120.0
    series = series * f + 1.0 / 24.0
    series = series * f + 1.0 / 6.0
    series = series * f + 0.5
    series = series * f + 1.0
    return series * f + 1.0


@respond.of(Gaussian)
def gaussian(response: Gaussian, z: Array, widths: Array, out: Array) -> None:
    """Eq 3.45, within 2 units in the last place of exp(-z/R); 0 from exp(-708) down."""
    remainders = np.empty(z.size)
    bits = out.view(np.int64)
    for j in range(z.size):
        x = max(-z[j] / widths[j], _SMALLEST_EXPONENT)
        rounded = x * _LOG2_E + _ROUND
        k = rounded - _ROUND
        remainders[j] = (x - k * _LN2_HIGH) - k * _LN2_LOW
        out[j] = rounded if x > _SMALLEST_EXPONENT else _NO_BITS
    for j in range(z.size):
        bits[j] = bits[j] << _EXPONENT_SHIFT
    for j in range(z.size):
        out[j] = _exp_series(remainders[j]) * out[j]


@width.of(Gaussian)
def gaussian_width(response: Gaussian, half_distance: float) -> float:
    """exp(-h^2 / R) = 1/2."""
    return half_distance * half_distance / np.log(2.0)


@slopes.of(Gaussian)
def gaussian_slopes(
    response: Gaussian, z: Array, widths: Array, by_z: Array, by_width: Array
) -> None:
    """Eq 3.62 and 3.63."""
    for j in range(z.size):
        o = np.exp(-z[j] / widths[j])
        by_z[j] = -o / widths[j]
        by_width[j] = z[j] * o / (widths[j] * widths[j])


@respond.of(Cosine)
def cosine(response: Cosine, z: Array, widths: Array, out: Array) -> None:
    """Eq 3.107."""
    for j in range(z.size):
        d = np.sqrt(z[j])
        out[j] = 0.5 * (1.0 + np.cos(np.pi * d / widths[j])) if d < widths[j] else 0.0


@width.of(Cosine)
def cosine_width(response: Cosine, half_distance: float) -> float:
    """cos(pi h / R) = 0."""
    return 2.0 * half_distance


@slopes.of(Cosine)
def cosine_slopes(response: Cosine, z: Array, widths: Array, by_z: Array, by_width: Array) -> None:
    """Eq 3.109 and 3.110; at d = 0 the limit of eq 3.109, -(pi / 2R)^2."""
    for j in range(z.size):
        d = np.sqrt(z[j])
        R = widths[j]
        by_z[j] = 0.0
        by_width[j] = 0.0
        if d < R:
            s = np.sin(np.pi * d / R)
            by_z[j] = -np.pi * s / (4.0 * R * d) if d > 0.0 else -((0.5 * np.pi / R) ** 2)
            by_width[j] = np.pi * d * s / (2.0 * R * R)


@respond.of(Parabolic)
def parabolic(response: Parabolic, z: Array, widths: Array, out: Array) -> None:
    """Eq 3.108."""
    for j in range(z.size):
        ratio = np.sqrt(z[j]) / widths[j]
        if ratio <= 0.5:
            out[j] = 1.0 - 2.0 * ratio * ratio
        elif ratio <= 1.0:
            out[j] = 2.0 * (1.0 - ratio) * (1.0 - ratio)
        else:
            out[j] = 0.0


@width.of(Parabolic)
def parabolic_width(response: Parabolic, half_distance: float) -> float:
    """The two parabolas meet at one half, at d = R/2."""
    return 2.0 * half_distance


@slopes.of(Parabolic)
def parabolic_slopes(
    response: Parabolic, z: Array, widths: Array, by_z: Array, by_width: Array
) -> None:
    """Eq 3.111 and 3.112."""
    for j in range(z.size):
        d = np.sqrt(z[j])
        R = widths[j]
        if d < 0.5 * R:
            by_z[j] = -2.0 / (R * R)
            by_width[j] = 4.0 * d * d / (R * R * R)
        elif d <= R:
            by_z[j] = -2.0 * (R - d) / (d * R * R)
            by_width[j] = 4.0 * (R - d) * d / (R * R * R)
        else:
            by_z[j] = 0.0
            by_width[j] = 0.0


RESPONSES: dict[str, type] = {kind.__name__: kind for kind in (Gaussian, Cosine, Parabolic)}
"""Every response function by name; a stored network finds its own here. Add yours."""
