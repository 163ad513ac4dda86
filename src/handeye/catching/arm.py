"""Arms: a cup on a traction drive with one linear degree of freedom (eq 4.1 to 4.3)."""

from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array, scalar
from handeye.catching.layout import GRAVITY, Cup
from handeye.catching.motion import arrival_time, position_after, standstill_time


@dataclass(frozen=True)
class Arm:
    """M a'' = (k_m / alpha) i - b a', with the current i = (V_m - k_m a' / alpha) / R.

    mass             M, armature included [kg]
    wheel            alpha, radius of the drive wheel [m]
    torque_constant  k_m [N m / A]
    resistance       R of the motor's terminals [ohm]
    friction         mu of b = mu g M + nu d h
    drag             nu of the same; d and h are the cup's width and height
    cup              the cup it carries
    supply           A of V_m = A tanh(G_i V_c) [V] (eq 4.3)
    input_gain       G_i [1/V]
    """

    mass: float
    wheel: float = 0.08
    torque_constant: float = 0.125
    resistance: float = 3.3
    friction: float = 0.1
    drag: float = 0.1
    cup: Cup = Cup()
    supply: float = 20.0
    input_gain: float = 4.0

    def __post_init__(self) -> None:
        for field in fields(self):
            if field.name in {"friction", "drag"}:
                scalar(getattr(self, field.name), field.name, least=0.0)
            elif field.name != "cup":
                scalar(getattr(self, field.name), field.name, above=0.0)

    @property
    def damping(self) -> float:
        """b = mu g M + nu d h [N s / m]."""
        return self.friction * GRAVITY * self.mass + self.drag * self.cup.width * self.cup.height

    @property
    def time_constant(self) -> float:
        """tau [s] (eq 4.2)."""
        motor = self.torque_constant**2 / (self.wheel**2 * self.resistance)
        return self.mass / (self.damping + motor)

    @property
    def force_per_volt(self) -> float:
        """Force of the drive at standstill [N/V]."""
        return self.torque_constant / (self.wheel * self.resistance)

    @property
    def back_emf(self) -> float:
        """Voltage that the motor makes when it turns [V s / m]."""
        return self.torque_constant / self.wheel

    @property
    def terminal_velocity(self) -> float:
        """Speed that the full supply reaches in the end [m/s] (note E6)."""
        return self.supply * self.force_per_volt * self.time_constant / self.mass

    def motor_voltage(self, command: Array) -> Array:
        """V_m [V] for command voltages V_c (eq 4.3)."""
        return self.supply * np.tanh(self.input_gain * command)

    def force(self, motor_voltage: Array, velocity: Array) -> Array:
        """What the drive-force sensor reads [N]: (k_m / (alpha R)) (V_m - k_m v / alpha)."""
        return self.force_per_volt * (motor_voltage - self.back_emf * velocity)

    def minimum_time(self, distance: Array) -> Array:
        """Least time to be a distance [m] away, from rest, at any speed [s].

        The full supply all the way: d = v t - v tau (1 - exp(-t / tau)), v the terminal velocity.
        """
        away = np.abs(np.asarray(distance, np.float64)).ravel()
        pull, k = self.terminal_velocity / self.time_constant, 1.0 / self.time_constant
        times = np.empty_like(away)
        _times_to(away, pull, k, times)
        return times.reshape(np.shape(distance))

    def minimum_rest_time(self, distance: Array) -> Array:
        """Least time to come to rest a distance [m] away, from rest [s].

        Full supply, then reversed: with c = d / (v tau) the first part lasts tau ln y and all of it
        tau (2 ln y - c), where y = e^c + sqrt(e^2c - e^c).
        """
        c = np.abs(distance) / (self.terminal_velocity * self.time_constant)
        grown = np.expm1(c)
        # ln y = ln(1 + (e^c - 1) + sqrt((e^c - 1) e^c)) keeps its digits for short ways.
        ln_y = np.log1p(grown + np.sqrt(grown * (grown + 1.0)))
        return self.time_constant * (2.0 * ln_y - c)


LIGHT_ARM = Arm(mass=0.1)
HEAVY_ARM = Arm(mass=0.5)
ARMS = (LIGHT_ARM, HEAVY_ARM)
"""Identity 0 is the light arm, 1 the heavy one."""


class Drives(NamedTuple):
    """Several arms as arrays (n,), for kernels: index by identity."""

    rate: Array  # 1 / tau [1/s]
    pull_per_volt: Array  # acceleration at standstill [m/s^2/V]
    force_per_volt: Array
    back_emf: Array
    supply: Array
    input_gain: Array


def drives(arms: tuple[Arm, ...]) -> Drives:
    """The numbers of each arm."""
    return Drives(
        rate=np.array([1.0 / arm.time_constant for arm in arms]),
        pull_per_volt=np.array([arm.force_per_volt / arm.mass for arm in arms]),
        force_per_volt=np.array([arm.force_per_volt for arm in arms]),
        back_emf=np.array([arm.back_emf for arm in arms]),
        supply=np.array([arm.supply for arm in arms]),
        input_gain=np.array([arm.input_gain for arm in arms]),
    )


@compiled
def _times_to(distance: Array, pull: float, k: float, out: Array) -> None:
    """Seconds from rest to each distance (N,) under a constant pull; out (N,) is overwritten."""
    for i in range(len(distance)):
        # Never later than half of the distance at the terminal velocity, after a head start.
        late = distance[i] * k / pull + 1.0 / k
        out[i] = 0.0
        if distance[i] > 0.0:
            out[i] = arrival_time(0.0, 0.0, pull, k, distance[i], 0.0, late)


@compiled
def stop_contact(
    x: float, v: float, pull: float, k: float, low: float, high: float, span: float
) -> float:
    """When the arm runs into the stop at low or high within `span` seconds, else inf.

    The velocity turns at most once, so the way there and the way back are each monotone.
    """
    turn = min(standstill_time(v, pull, k), span) if v != 0.0 else 0.0
    there = position_after(x, v, pull, k, turn)
    if there > high:
        return arrival_time(x, v, pull, k, high, 0.0, turn)
    if there < low:
        return arrival_time(x, v, pull, k, low, 0.0, turn)
    back = position_after(x, v, pull, k, span)
    if back > high:
        return arrival_time(x, v, pull, k, high, turn, span)
    if back < low:
        return arrival_time(x, v, pull, k, low, turn, span)
    return np.inf


@compiled
def pushes_stop(x: float, v: float, pull: float, low: float, high: float) -> bool:
    """True while the arm rests against a stop and the motor holds it there."""
    return v == 0.0 and ((x >= high and pull >= 0.0) or (x <= low and pull <= 0.0))
