"""Balls: damped ballistic flight (eq 4.4)."""

from dataclasses import dataclass

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array, scalar
from handeye.catching.layout import GRAVITY
from handeye.catching.motion import arrival_time, position_after, standstill_time, velocity_after


@dataclass(frozen=True)
class Ball:
    """A sphere in viscous air.

    density    [kg/m^3]
    radius     [m]
    viscosity  eta of eq 4.4 [kg/(m s)]
    """

    density: float
    radius: float = 0.03
    viscosity: float = 1.81e-5

    def __post_init__(self) -> None:
        scalar(self.density, "density", above=0.0)
        scalar(self.radius, "radius", above=0.0)
        scalar(self.viscosity, "viscosity", least=0.0)

    @property
    def mass(self) -> float:
        """In kilograms."""
        return self.density * 4.0 / 3.0 * np.pi * self.radius**3

    @property
    def decay(self) -> float:
        """k = 6 pi eta r / m of v' = -k v - g [1/s] (eq 4.4)."""
        return 6.0 * np.pi * self.viscosity * self.radius / self.mass


LIGHT_BALL = Ball(density=0.03)
HEAVY_BALL = Ball(density=500.0)
BALLS = (LIGHT_BALL, HEAVY_BALL)
"""Identity 0 is the light ball, 1 the heavy one."""


@compiled
def time_down_to(z: float, vz: float, k: float, height: float) -> float:
    """Seconds until the centre descends through `height` [m], inf if that was before now.

    Exact to rounding: the flight is monotone after its apex.
    """
    apex = standstill_time(vz, -GRAVITY, k) if vz > 0.0 else 0.0
    if position_after(z, vz, -GRAVITY, k, apex) < height:
        return np.inf
    late = apex + 0.1
    while position_after(z, vz, -GRAVITY, k, late) > height:
        late = apex + 2.0 * (late - apex)
    return arrival_time(z, vz, -GRAVITY, k, height, apex, late)


@compiled
def apex_of(z: float, vz: float, k: float) -> float:
    """The greatest height [m] of a flight from z with vz upwards."""
    return position_after(z, vz, -GRAVITY, k, standstill_time(vz, -GRAVITY, k))


@compiled
def speed_to_reach(rise: float, k: float) -> float:
    """Upward speed [m/s] that lifts a ball by `rise` [m].

    With u = k v / g the rise is (u - ln(1 + u)) g / k^2, solved by Newton's method: it is convex in
    v, so from the speed without drag, which is too low, the second step onwards comes from above.
    """
    v = np.sqrt(2.0 * GRAVITY * rise)
    for _ in range(60):
        # d rise / d v = v / (g + k v)
        step = (apex_of(0.0, v, k) - rise) * (GRAVITY + k * v) / v
        v -= step
        if abs(step) <= 4e-16 * v:
            break
    return v


@compiled
def flight(x: Array, z: Array, vx: Array, vz: Array, k: Array, t: Array, out: Array) -> None:
    """States of N balls after t (N,) seconds of free flight.

        v' = -k v - g e_z   (eq 4.4 over the mass)

    out (N, 4) is overwritten with x, z [m], vx, vz [m/s].
    """
    for i in range(len(x)):
        out[i, 0] = position_after(x[i], vx[i], 0.0, k[i], t[i])
        out[i, 1] = position_after(z[i], vz[i], -GRAVITY, k[i], t[i])
        out[i, 2] = velocity_after(vx[i], 0.0, k[i], t[i])
        out[i, 3] = velocity_after(vz[i], -GRAVITY, k[i], t[i])
