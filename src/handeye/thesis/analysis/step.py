"""The time constant of a first-order step response."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq, minimize_scalar
from scipy.special import stdtrit

from handeye.arrays import Array, shaped
from handeye.errors import InvalidInput

_STARTS = 60
_PARAMETERS = 3


class StepFit(NamedTuple):
    """`floor + (start - floor) exp(-t / tau)` as fitted; tau between low and high with 95 %."""

    start: float
    floor: float
    tau: float
    low: float
    high: float

    def at(self, t: Array) -> Array:
        """The fitted response after t (N,)."""
        return self.floor + (self.start - self.floor) * np.exp(-t / self.tau)


def fit_step(t: ArrayLike, response: ArrayLike, std: ArrayLike | None = None) -> StepFit:
    """Fit a first-order step response by weighted least squares.

    For a given tau start and floor are linear, so only tau is searched, over all that N points can
    show: from a quarter of their smallest spacing to 100 times their span. The interval holds every
    tau that an F test at 5 % does not reject. Where the points do not tell tau, as when nothing
    was disturbed, it reaches the ends of that range.

    Args:
        t: times since the step (N,), N >= 4, increasing.
        response: (N,).
        std: standard deviations of response (N,) up to a common factor; by default all alike.
    """
    times = shaped(t, (None,), "t")
    if len(times) <= _PARAMETERS or np.any(np.diff(times) <= 0.0):
        raise InvalidInput("t must be increasing and have at least 4 entries")
    y = shaped(response, times.shape, "response")
    deviations = np.ones_like(y) if std is None else shaped(std, times.shape, "std")
    if np.any(deviations <= 0.0):
        raise InvalidInput("std must be positive")
    problem = _Decay(times - times[0], y, deviations**-2.0)
    least = math.log(0.25 * float(np.diff(times).min()))
    most = math.log(100.0 * float(times[-1] - times[0]))
    grid = np.linspace(least, most, _STARTS)
    best = int(np.argmin([problem.misfit(x) for x in grid]))
    around = (grid[max(best - 1, 0)], grid[min(best + 1, _STARTS - 1)])
    found = minimize_scalar(
        problem.misfit, bounds=around, method="bounded", options={"xatol": 1e-10}
    )
    x, freedom = float(found.x), len(y) - _PARAMETERS
    bound = problem.misfit(x) * (1.0 + float(stdtrit(freedom, 0.975)) ** 2 / freedom)

    def end(limit: float) -> float:
        """Where the misfit passes the bound between x and a limit."""
        if problem.misfit(limit) <= bound:
            return limit
        if problem.misfit(x) >= bound:
            return x
        return float(brentq(lambda other: problem.misfit(other) - bound, x, limit))

    slope, floor = problem.line(x)
    tau, low, high = np.exp([x, end(least), end(most)]).tolist()
    # The time of the first point may differ from the time of the step.
    start = floor + slope * float(np.exp(times[0] / tau))
    return StepFit(start, floor, tau, low, high)


class _Decay(NamedTuple):
    """Weighted data of a decay; x = ln tau."""

    t: Array
    y: Array
    weights: Array

    def misfit(self, x: float) -> float:
        """Weighted sum of squared residuals of the best line in exp(-t / tau)."""
        slope, floor = self.line(x)
        residual = self.y - floor - slope * np.exp(-self.t / np.exp(x))
        return float(self.weights @ residual**2)

    def line(self, x: float) -> tuple[float, float]:
        """Slope and intercept of that line."""
        decay = np.exp(-self.t / np.exp(x))
        mean = np.average(decay, weights=self.weights)
        level = np.average(self.y, weights=self.weights)
        centered = self.weights * (decay - mean)
        slope = float(centered @ (self.y - level) / (centered @ (decay - mean)))
        return slope, float(level - slope * mean)
