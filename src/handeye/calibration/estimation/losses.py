"""Robust losses: how much a residual of so many standard deviations counts.

With z = residual / scale, the cost of a residual is `scale^2 rho(z^2)`:

    squared  z^2                        every residual counts fully
    soft_l1  2 (sqrt(1 + z^2) - 1)      smooth; like |z| far out
    huber    z^2, beyond 1: 2 |z| - 1   like |z| far out
    cauchy   log(1 + z^2)               far out it hardly counts; several minima are possible
"""

from typing import Literal

import numpy as np

from handeye._compiled import compiled

Loss = Literal["squared", "soft_l1", "huber", "cauchy"]
LOSSES: tuple[Loss, ...] = ("squared", "soft_l1", "huber", "cauchy")


@compiled
def weight(loss: int, z: float) -> float:
    """rho'(z^2): 1 for small residuals; `loss` is a place in LOSSES."""
    if loss == 1:
        return 1.0 / np.sqrt(1.0 + z * z)
    if loss == 2:
        return 1.0 / max(abs(z), 1.0)
    if loss == 3:
        return 1.0 / (1.0 + z * z)
    return 1.0


@compiled
def rho(loss: int, z: float) -> float:
    """Cost of a residual, over scale^2."""
    if loss == 1:
        return 2.0 * z * z / (1.0 + np.sqrt(1.0 + z * z))  # keeps small z exact
    if loss == 2 and abs(z) > 1.0:
        return 2.0 * abs(z) - 1.0
    if loss == 3:
        return np.log1p(z * z)
    return z * z


@compiled
def curvature(loss: int, z: float) -> float:
    """rho'(z^2) + 2 z^2 rho''(z^2), at least a tenth of rho': half the second derivative by z."""
    w = weight(loss, z)
    if loss == 1:
        return w * max(w * w, 0.1)
    if loss == 2 and abs(z) > 1.0:
        return w * 0.1
    if loss == 3:
        return w * max(1.0 - 2.0 * z * z * w, 0.1)
    return w
