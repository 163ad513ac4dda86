"""Damped motion under a constant pull: of the arm between ticks and of the ball in flight.

    v' = a - k v

The arm has k = 1 / tau and a = (terminal velocity) / tau, the ball k = 6 pi eta r / m and a = 0
across, a = -g upwards. All is in closed form and keeps its digits when k t is small: the heavy
ball's k is 2e-4 per second. Numbers are scalars here: these kernels are called in loops.
"""

import numpy as np

from handeye._compiled import compiled

_SERIES_BELOW = 0.05


@compiled
def mean_decay(u: float) -> float:
    """(1 - exp(-u)) / u, and 1 at u = 0."""
    if u == 0.0:
        return 1.0
    return -np.expm1(-u) / u


@compiled
def mean_pull(u: float) -> float:
    """(u - 1 + exp(-u)) / u^2, and 1/2 at u = 0."""
    if abs(u) < _SERIES_BELOW:
        # 1/2! - u/3! + u^2/4! - ...; the next term, u^8 / 10!, is below the rounding of the sum.
        high = 1 / 720 - u * (1 / 5040 - u * (1 / 40320 - u / 362880))
        return 1 / 2 - u * (1 / 6 - u * (1 / 24 - u * (1 / 120 - u * high)))
    return (u + np.expm1(-u)) / (u * u)


@compiled
def position_after(x: float, v: float, a: float, k: float, t: float) -> float:
    """Position [m] after t seconds from x, v under the pull a [m/s^2] and damping k [1/s]."""
    u = k * t
    return x + t * (v * mean_decay(u) + a * t * mean_pull(u))


@compiled
def velocity_after(v: float, a: float, k: float, t: float) -> float:
    """Velocity [m/s] after t seconds."""
    u = k * t
    return v * np.exp(-u) + a * t * mean_decay(u)


@compiled
def state_after(x: float, v: float, a: float, k: float, t: float) -> tuple[float, float]:
    """Position and velocity after t seconds, for one exponential instead of two."""
    u = k * t
    if u < _SERIES_BELOW:
        pull = mean_pull(u)
        decay = 1.0 - u * pull
        return x + t * (v * decay + a * t * pull), v * (1.0 - u * decay) + a * t * decay
    grown = np.expm1(-u)
    decay = -grown / u
    return (
        x + t * (v * decay + a * t * (u + grown) / (u * u)),
        v * (1.0 + grown) + a * t * decay,
    )


@compiled
def standstill_time(v: float, a: float, k: float) -> float:
    """Seconds until the velocity is zero, inf if the pull does not turn the motion round.

    t = ln(1 - k v / a) / k
    """
    if v == 0.0:
        return 0.0
    if v * a >= 0.0:
        return np.inf
    return -v / a if k == 0.0 else np.log1p(-k * v / a) / k


@compiled
def arrival_time(
    x: float, v: float, a: float, k: float, goal: float, start: float, end: float
) -> float:
    """When the position is `goal`, given that it goes one way from `start` to `end` and passes it.

    Newton's method inside a shrinking bracket, to the last digits; times are seconds from the state
    x, v. The caller knows that start and end lie on different sides of the goal.
    """
    rising = position_after(x, v, a, k, end) > position_after(x, v, a, k, start)
    low, high = start, end
    t = 0.5 * (low + high)
    for _ in range(100):
        gap = position_after(x, v, a, k, t) - goal
        if (gap > 0.0) == rising:
            high = t
        else:
            low = t
        step = t - gap / velocity_after(v, a, k, t)
        if abs(step - t) <= 4e-16 * abs(t):
            return step
        t = step if low < step < high else 0.5 * (low + high)
    return t
