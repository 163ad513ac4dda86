"""Pursuit movements: a square pulse that drives the arm, and its mirror image that stops it.

The stereotype of figure 4.9. The arm learns from pursuits without a ball, and the smooth variant
of the catcher triggers them.
"""

from dataclasses import dataclass, fields
from typing import Any, Self

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array, Booleans, Integers, count, scalar, shaped
from handeye.catching.arm import Arm, Drives, drives, pushes_stop, stop_contact
from handeye.catching.layout import Layout
from handeye.catching.motion import position_after, standstill_time, velocity_after
from handeye.catching.profile import AntisymmetricProfile
from handeye.errors import InvalidInput

EPSILON = 0.1
"""Least amplitude that is drawn [V].

With it the slowest pursuit, of the heavy arm across its travel, lasts 0.92 s, about as long as a
flight: none is glacial, and there is practice for all that a throw may ask for (note E10).
"""

# No pursuit within the layout takes longer unless its voltage is next to nothing.
_LONGEST = 20.0
_ROUNDS = 200


@dataclass(frozen=True, eq=False)
class Pulses:
    """N pursuits to be made, each field (N,): start, target [m] and amplitude |V_c| [V]."""

    start: Array
    target: Array
    amplitude: Array

    def __post_init__(self) -> None:
        for field in fields(self):
            value = shaped(getattr(self, field.name), (len(np.atleast_1d(self.start)),), field.name)
            object.__setattr__(self, field.name, value)
        if np.any(self.amplitude <= 0.0):
            raise InvalidInput("every amplitude must be positive")

    def __len__(self) -> int:
        return len(self.start)

    def __getitem__(self, index: Any) -> Self:
        return type(self)(self.start[index], self.target[index], self.amplitude[index])


@dataclass(frozen=True, eq=False)
class Movements:
    """N pursuits as the arm made them: fields (T, N) hold one row per tick until it stopped.

    time, arm_x, arm_v, arm_force  sensed at the tick; NaN from the tick after the stop on
    voltage      V_c from the tick on [V]; 0 from the stop on, which falls within the last tick
    n_ticks      rows before the stop (N,)
    stop_x       where it came to rest, exactly (N,) [m]
    stop_time    when (N,) [s]
    hit_stop     it ran into the end of its travel (N,)
    """

    time: Array
    arm_x: Array
    arm_v: Array
    arm_force: Array
    voltage: Array
    n_ticks: Integers
    stop_x: Array
    stop_time: Array
    hit_stop: Booleans

    def __len__(self) -> int:
        return len(self.n_ticks)

    def __getitem__(self, index: Any) -> Self:
        """Some of the movements; a slice, mask or index array."""
        return type(self)(**{f.name: getattr(self, f.name)[..., index] for f in fields(self)})


def draw_pursuits(
    n: int,
    rng: np.random.Generator,
    arm: Arm,
    *,
    layout: Layout = Layout(),
    epsilon: float = EPSILON,
) -> Pulses:
    """n random pursuits: start and target uniform in the travel, amplitude in [epsilon, 1].

    Those that would end at a stop of the travel instead of where the pulses bring them are drawn
    anew: they would teach the arm about the stop.
    """
    count(n, "n", least=0)
    if not 0.0 < scalar(epsilon, "epsilon") <= 1.0:
        raise InvalidInput(f"epsilon must be above 0 and at most 1, got {epsilon}")
    low, high = layout.arm_travel
    least = np.array([low, low, epsilon])
    span = np.array([high - low, high - low, 1.0 - epsilon])
    kept = np.empty((0, 3))
    for _ in range(_ROUNDS):
        drawn = least + span * rng.random((n - len(kept), 3))
        hit = execute(arm, Pulses(*drawn.T), layout=layout).hit_stop
        kept = np.concatenate([kept, drawn[~hit]])
        if len(kept) == n:
            return Pulses(*kept.T)
    raise InvalidInput(f"hardly any pursuit in the travel {layout.arm_travel} misses its stops")


def execute(arm: Arm, pulses: Pulses, *, layout: Layout = Layout()) -> Movements:
    """The movements that an arm makes: commands change at ticks, the stop is found exactly.

    Raises InvalidInput for starts outside the travel, or if an arm is still moving after 20 s.
    """
    low, high = layout.arm_travel
    if np.any((pulses.start < low) | (pulses.start > high)):
        raise InvalidInput(f"every start must lie in the travel {layout.arm_travel}")
    n = len(pulses)
    profile = AntisymmetricProfile(n)
    profile.trigger(np.ones(n, np.bool_), pulses.start, pulses.target, pulses.amplitude)
    # x, v, force, stop time, hit
    state = np.zeros((n, 5))
    state[:, 0] = pulses.start
    state[:, 3] = np.where(profile.active, np.inf, 0.0)
    numbers = drives((arm,))
    rows: list[Array] = []
    tick = 0
    while np.any(moving := state[:, 3] == np.inf):
        time = tick * layout.tick
        if time > _LONGEST:
            raise InvalidInput("a pursuit took longer than 20 s: use larger amplitudes")
        voltage = np.where(moving, profile.command(state[:, 0], state[:, 1]), 0.0)
        seen = np.where(moving[:, None], state[:, :3], np.nan)
        clock = np.where(moving, time, np.nan)
        rows.append(np.column_stack([clock, seen, voltage]))
        _advance(state, voltage, time, layout.tick, low, high, numbers)
        tick += 1
    table = np.array(rows).reshape(-1, n, 5)
    return Movements(
        *(np.ascontiguousarray(table[:, :, j]) for j in range(5)),
        n_ticks=np.isfinite(table[:, :, 0]).sum(axis=0),
        stop_x=state[:, 0].copy(),
        stop_time=state[:, 3].copy(),
        hit_stop=state[:, 4] > 0.0,
    )


@compiled
def _advance(
    state: Array, voltage: Array, time: float, tick: float, low: float, high: float, arm: Drives
) -> None:
    """One tick, in place, for the rows of state (N, 5) that have not stopped: stop time inf."""
    k = arm.rate[0]
    for i in range(len(state)):
        x, v = state[i, 0], state[i, 1]
        if state[i, 3] < np.inf:
            continue
        motor = arm.supply[0] * np.tanh(arm.input_gain[0] * voltage[i])
        pull = arm.pull_per_volt[0] * motor
        rest = standstill_time(v, pull, k) if v != 0.0 else np.inf
        if pushes_stop(x, v, pull, low, high):
            rest, hit = 0.0, 0.0
        else:
            hit = stop_contact(x, v, pull, k, low, high, min(rest, tick))
        span = min(rest, hit, tick)
        if span in {hit, rest}:
            state[i, 3] = time + span
            state[i, 4] = 1.0 if hit == span else 0.0
        state[i, 0] = min(max(position_after(x, v, pull, k, span), low), high)
        state[i, 1] = 0.0 if span < tick else velocity_after(v, pull, k, span)
        state[i, 2] = arm.force_per_volt[0] * (motor - arm.back_emf[0] * state[i, 1])
