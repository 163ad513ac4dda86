"""How far a measured share may be from the true one."""

import math

from scipy.special import ndtri

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
