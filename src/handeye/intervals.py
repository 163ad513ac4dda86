"""How far a measured share or mean may be from the true one."""

import math
from collections.abc import Sequence
from statistics import stdev

from scipy.special import ndtri, stdtrit

CONFIDENCE = 0.95


def wilson_interval(successes: int, n: int) -> tuple[float, float]:
    """Wilson's 95 % interval of a probability after `successes` in n >= 1 tries.

    (k + z^2 / 2 +- z sqrt(k (n - k) / n + z^2 / 4)) / (n + z^2), z = 1.96.
    """
    z2 = float(ndtri(0.5 + CONFIDENCE / 2.0)) ** 2
    middle = (successes + z2 / 2.0) / (n + z2)
    half = math.sqrt(z2 * (successes * (n - successes) / n + z2 / 4.0)) / (n + z2)
    # Rounding must not take a share of 0 or 1 out of its own interval.
    share = successes / n
    return min(max(middle - half, 0.0), share), max(min(middle + half, 1.0), share)


def mean_interval(mean: float, parts: Sequence[float]) -> tuple[float, float]:
    """95 % interval of the mean of a quantity that is never negative.

    mean -+ t s / sqrt(B) with Student's t of B - 1 degrees of freedom, from the means of B >= 2
    parts of about the same size, of which only whole parts are independent of each other, and
    their sample standard deviation s.
    """
    t = float(stdtrit(len(parts) - 1, 0.5 + CONFIDENCE / 2.0))
    half = t * stdev(parts) / math.sqrt(len(parts))
    return max(mean - half, 0.0), mean + half
