"""What an output learns that is always taught the same, at noisy inputs (eq 3.76 to 3.83).

The input of trial j misses x by dx_j, and nu_j = grad o_j(x) dx_j is what this does to the output.
"""

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, finite, scalar, shaped
from handeye.errors import InvalidInput


def outputs(start: ArrayLike, target: ArrayLike, noise: ArrayLike, rate: float) -> Array:
    """Outputs (N + 1, m) at x before and after each of N trials, the first being the start.

    `o_{j+1} = (1 - rate) o_j + rate (target - nu_j)` (eq 3.80), hence

        o_j = (1 - rate)^j o_0 + (1 - (1 - rate)^j) target
              - rate sum_{k<j} (1 - rate)^(j-1-k) nu_k

    which is eq 3.81 with the factor `rate` that its sum lacks in print.

    Args:
        start: o_0 (m,).
        target: (m,).
        noise: nu (N, m).
        rate: the learning rate lambda, 0 < rate < 1.
    """
    o = shaped(start, (None,), "start")
    aim, nu = shaped(target, o.shape, "target"), shaped(noise, (None, len(o)), "noise")
    keep = 1.0 - _checked(rate)
    rows = [o]
    for learned in (1.0 - keep) * (aim - nu):
        rows.append(keep * rows[-1] + learned)
    return np.array(rows)


def expected_output(
    trials: ArrayLike, start: float, target: float, mean_noise: float, rate: float
) -> Array:
    """Expected output after so many trials (...) (eq 3.82): in the end target - mean_noise (3.83).

    The sum of eq 3.82 is taken with the factor `rate`, as eq 3.83 needs.
    """
    left = (1.0 - _checked(rate)) ** finite(trials, "trials")
    return left * start + (1.0 - left) * (target - mean_noise)


def _checked(rate: float) -> float:
    if not 0.0 < scalar(rate, "rate") < 1.0:
        raise InvalidInput(f"rate must lie between 0 and 1, got {rate}")
    return float(rate)
