"""How far each sample is to be believed.

A sample is good with probability 1 - e, and then its residuals follow a multivariate Student t with
f degrees of freedom, or it is gross: any orientation, anywhere in the room. Good ones with tails
count less the farther out they are; gross ones do not count. f and e come from the samples.
"""

from typing import NamedTuple

import numpy as np
from scipy.special import gammaln

from handeye.arrays import Array

_SIZE = 6
# From heavy tails to nearly normal. Few samples cannot tell, and are taken to be in between.
_FREEDOMS = (3.0, 5.0, 10.0, 30.0, 200.0)
_BETWEEN = 10.0
_FEW = 15
# Share of gross samples: as if one in twenty of this many samples had been gross before.
_GROSS, _BEFORE = 0.05, 10.0
_MOST_GROSS = 0.5


class Belief(NamedTuple):
    """weights (N,) of the squared residuals; good (N,) probability; freedom f; gross share e."""

    weights: Array
    good: Array
    freedom: float
    gross: float


def believe(squares: Array, log_dets: Array, room: float, gross: float) -> Belief:
    """Belief in samples with squared normalised residuals (N,) and log det of covariance (N,).

    room [m^3 rad^3] is the volume over which gross residuals spread.
    """
    freedom, density = _BETWEEN, _density(squares, log_dets, _BETWEEN)
    good = _good(density, room, gross)
    if len(squares) >= _FEW:
        each = [_density(squares, log_dets, f) for f in _FREEDOMS]
        best = int(np.argmax([float(good @ one) for one in each]))
        freedom, density = _FREEDOMS[best], each[best]
        good = _good(density, room, gross)
    share = (np.sum(1.0 - good) + _GROSS * _BEFORE) / (len(good) + _BEFORE)
    return Belief(
        good * (freedom + _SIZE) / (freedom + squares),
        good,
        freedom,
        float(min(share, _MOST_GROSS)),
    )


def log_likelihood(squares: Array, log_dets: Array, room: float, belief: Belief) -> float:
    """Of all samples together."""
    gross = belief.gross
    good = np.log1p(-gross) + _density(squares, log_dets, belief.freedom)
    return float(np.logaddexp(good, np.log(gross) - np.log(room)).sum())


def sharpness(freedom: float) -> float:
    """Information of a t-distributed residual over that of a normal one with its covariance."""
    return (freedom + _SIZE) / (freedom + _SIZE + 2.0)


def room_of(distance: float) -> float:
    """Volume of all turns times a ball of twice the distance."""
    return 8.0 * np.pi**2 * 4.0 / 3.0 * np.pi * (2.0 * distance) ** 3


def _density(squares: Array, log_dets: Array, freedom: float) -> Array:
    half = 0.5 * (freedom + _SIZE)
    constant = gammaln(half) - gammaln(0.5 * freedom) - 0.5 * _SIZE * np.log(freedom * np.pi)
    return constant - 0.5 * log_dets - half * np.log1p(squares / freedom)


def _good(density: Array, room: float, gross: float) -> Array:
    odds = np.log1p(-gross) - np.log(gross) + density + np.log(room)
    return 1.0 / (1.0 + np.exp(-np.clip(odds, -500.0, 500.0)))
