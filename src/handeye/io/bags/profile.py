"""How well positions fit joint angles at another time."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from handeye.arrays import Array
from handeye.io.bags.features import Features
from handeye.io.bags.matching import JointMotion

HALF = 0.01
"""Time on both sides of a moment for derivatives [s]."""

_LARGEST_STEP = 0.02  # [s]
_STEPS = 8
_ARRIVED = 1e-6  # [s]
_SETTLED = 0.1  # of the standard deviation
_REWEIGHTINGS = 4
_OUTLIER = 3.0  # of the median
_DIRECTIONS = 1e-12  # of the largest, squared
_BLOCKS = 20


class _Fit(NamedTuple):
    """Residuals (N, 3), root weights (N, 1), B (k, 3), basis of the weighted features (N, r)."""

    residuals: Array
    root: Array
    B: Array
    basis: Array


@dataclass(frozen=True)
class Profile:
    """The problem p_i = B phi(q(t_i - d)) + e_i with the best B for each delay d.

    Rows that fit badly count less: w = 1 / (1 + (|e| / c)^2) with c three medians (Cauchy).

    moments    t (N,) [s], around which the joints' motion is known
    positions  p (N, 3) [m]
    """

    moments: Array
    positions: Array
    motion: JointMotion
    features: Features

    def thinned(self, rows: int) -> "Profile":
        """About `rows` rows from all over the record."""
        every = max(1, len(self.moments) // rows)
        return self._only(np.arange(0, len(self.moments), every))

    def spread(self, delay: float) -> float:
        """Median distance that the best B leaves [m]."""
        return float(np.median(np.linalg.norm(self._fit(delay).residuals, axis=1)))

    def refined(self, delay: float, largest: float) -> tuple[float, float]:
        """The delay from which a Gauss-Newton step leads nowhere, and its standard deviation.

        What the kinematics leave unexplained is alike in neighbouring rows, so the deviation is
        the jackknife's over blocks of time (Kuensch 1989): one step without each block. It is inf
        where no such delay is found.
        """
        for _ in range(_STEPS):
            step = self._step(delay)
            if not np.isfinite(step):
                return delay, np.inf
            step = float(np.clip(step, -_LARGEST_STEP, _LARGEST_STEP))
            delay = float(np.clip(delay + step, -largest, largest))
            if abs(step) < _ARRIVED:
                break
        rows = np.arange(len(self.moments))
        steps = [
            self._only(np.setdiff1d(rows, block))._step(delay)
            for block in np.array_split(rows, _BLOCKS)
        ]
        if not np.isfinite(steps).all():
            return delay, np.inf
        std = float(np.sqrt((_BLOCKS - 1) * np.var(steps)))
        settled = abs(self._step(delay)) <= max(_ARRIVED, _SETTLED * std)
        return delay, std if settled else np.inf

    def _step(self, delay: float) -> float:
        """-sum u r / sum u^2; inf where nothing moves.

        u is the change of the residuals r per second of delay, less what another B would undo
        (Kaufman 1975).
        """
        fit = self._fit(delay)
        ahead, behind = (self._phi(self.moments - delay + half) for half in (HALF, -HALF))
        change = fit.root * ((ahead - behind) @ fit.B) / (2.0 * HALF)
        u = change - fit.basis @ (fit.basis.T @ change)
        information = float(np.sum(u * u))
        if not information > 0.0:
            return np.inf
        return -float(np.sum(u * fit.root * fit.residuals)) / information

    def _only(self, rows: NDArray[np.integer]) -> "Profile":
        return Profile(self.moments[rows], self.positions[rows], self.motion, self.features)

    def _phi(self, moments: Array) -> Array:
        return self.features(self.motion.at(moments).angles)

    def _fit(self, delay: float) -> _Fit:
        phi = self._phi(self.moments - delay)
        fit = _weighted(phi, self.positions, np.ones((len(phi), 1)))
        for _ in range(_REWEIGHTINGS):
            away = np.linalg.norm(fit.residuals, axis=1, keepdims=True)
            scale = _OUTLIER * float(np.median(away)) + 1e-12
            fit = _weighted(phi, self.positions, 1.0 / np.sqrt(1.0 + (away / scale) ** 2))
        return fit


def _weighted(phi: Array, positions: Array, root: Array) -> _Fit:
    """Least squares through the normal equations: k is small, and N and the tries are many."""
    weighted = root * phi
    sizes, turns = np.linalg.eigh(weighted.T @ weighted)
    kept = sizes > _DIRECTIONS * sizes[-1]
    scaled = turns[:, kept] / np.sqrt(sizes[kept])
    basis = weighted @ scaled
    B = scaled @ (basis.T @ (root * positions))
    return _Fit(positions - phi @ B, root, B, basis)
