"""What a batch of trials consists of at one moment."""

from typing import Any, NamedTuple

import numpy as np

from handeye.arrays import Array, Booleans, Integers
from handeye.catching.throws import Throws

FLYING, CAUGHT, MISSED, KNOCKED_OUT = 0, 1, 2, 3
"""Outcomes: not over yet; on the cup's floor; on the ground; out of bounds."""


class State(NamedTuple):
    """N trials at the end of a tick, or where they stopped; every field (N,) but `final`.

    A trial is over at `end_time`; until then `outcome` is FLYING.
    """

    ball: Integers
    arm: Integers
    crossing_time: Array  # of the undisturbed flight [s]
    ticks: Integers  # that have passed
    time: Array  # since launch [s]
    arm_x: Array
    arm_v: Array
    motor: Array  # voltage V_m that was in force just before [V]
    x: Array
    z: Array
    vx: Array
    vz: Array
    lying: Booleans  # the ball rests on ground or floor
    pushed: Array  # the way a wall of the cup pushes the ball: -1, 0 or 1
    outcome: Integers
    end_time: Array  # inf until the trial is over
    contact_time: Array  # of the first contact with the cup, inf until then
    arm_at_crossing: Array  # where it was at crossing_time or an earlier end, NaN until then [m]
    final: Array  # (N, 7): x, z, vx, vz, arm_x, arm_v, motor at end_time; NaN until then


def launched(throws: Throws) -> State:
    """The trials at launch."""
    n = len(throws)
    nothing = np.zeros(n)
    return State(
        ball=throws.ball.copy(),
        arm=throws.arm.copy(),
        crossing_time=throws.crossing_time.copy(),
        ticks=np.zeros(n, np.int64),
        time=nothing.copy(),
        arm_x=throws.arm_x.copy(),
        arm_v=nothing.copy(),
        motor=nothing.copy(),
        x=throws.x.copy(),
        z=throws.z.copy(),
        vx=throws.vx.copy(),
        vz=throws.vz.copy(),
        lying=np.zeros(n, np.bool_),
        pushed=nothing.copy(),
        outcome=np.full(n, FLYING, np.int64),
        end_time=np.full(n, np.inf),
        contact_time=np.full(n, np.inf),
        arm_at_crossing=np.full(n, np.nan),
        final=np.full((n, 7), np.nan),
    )


def copied(state: State) -> State:
    """The same in arrays of its own."""
    fields: list[Any] = [field.copy() for field in state]
    return State(*fields)
