"""Small learned functions of one stage's own variable, as sums of fixed terms with priors."""

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array


def curve_std(n: int, half: float, parts: tuple[tuple[float, float], ...]) -> Array:
    """Prior standard deviations (n,) of the sine terms of a smooth random curve.

    A Gaussian process with kernel `sum_i a_i^2 exp(-(x - y)^2 / 2 l_i^2)`, parts (a_i, l_i), is on
    an interval of half-length `half` nearly `sum_k w_k sin(k pi (x + half) / 2 half)` with
    independent w_k whose variances follow the kernel's spectral density at k pi / 2 half (Solin and
    Sarkka 2020, eq 13 and 20). Amplitudes in the curve's unit, lengths in the variable's.
    """
    frequency = np.arange(1, n + 1) * np.pi / (2.0 * half)
    variance = np.zeros(n)
    for amplitude, length in parts:
        density = np.sqrt(2.0 * np.pi) * length * np.exp(-0.5 * (length * frequency) ** 2)
        variance += amplitude**2 * density / half
    return np.sqrt(variance)


@compiled
def sine_terms(x: float, half: float, terms: Array) -> None:
    """terms (n,), overwritten: sin(k pi (x + half) / 2 half) for k = 1 to n."""
    angle = np.pi * (x + half) / (2.0 * half)
    twice = 2.0 * np.cos(angle)
    before, now = 0.0, np.sin(angle)
    for k in range(len(terms)):
        terms[k] = now
        # sin((k + 1) a) = 2 cos(a) sin(k a) - sin((k - 1) a)
        before, now = now, twice * now - before


@compiled
def sine_slope(x: float, half: float, weights: Array) -> tuple[float, float]:
    """Value and derivative by x of `sum_k weights_k sin(k pi (x + half) / 2 half)`."""
    step = np.pi / (2.0 * half)
    angle = step * (x + half)
    value, slope = 0.0, 0.0
    for k in range(len(weights)):
        value += weights[k] * np.sin((k + 1) * angle)
        slope += weights[k] * (k + 1) * step * np.cos((k + 1) * angle)
    return value, slope


@compiled
def legendre(x: float, value: Array, slope: Array) -> None:
    """Legendre polynomials at x, degrees 0 to n - 1, and their derivatives; both (n,) overwritten.

    Beyond +-1 by more than a fifth they stay as they are there, so that a sighting from far outside
    the calibrated field is not multiplied by powers of its distance.
    """
    inside = min(max(x, -1.2), 1.2)
    value[0], slope[0] = 1.0, 0.0
    if len(value) > 1:
        value[1], slope[1] = inside, 1.0
    for k in range(1, len(value) - 1):
        value[k + 1] = ((2 * k + 1) * inside * value[k] - k * value[k - 1]) / (k + 1)
        slope[k + 1] = slope[k - 1] + (2 * k + 1) * value[k]
    if inside != x:
        slope[:] = 0.0
