"""One tick of N trials, from event to event."""

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array
from handeye.catching.arm import Drives, pushes_stop
from handeye.catching.contact import SHORTEST_HOP, Meeting, rebound
from handeye.catching.events import (
    ARM_STOP,
    GROUND,
    LEFT_WALL,
    NONE,
    OUT,
    RELEASE,
    Place,
    next_event,
)
from handeye.catching.layout import GRAVITY
from handeye.catching.motion import position_after, state_after
from handeye.catching.state import CAUGHT, FLYING, KNOCKED_OUT, MISSED, State

# Far more than any tick has; a tick that had more would end early for its ball.
_MOST_EVENTS = 2000


@compiled
def advance(state: State, voltage: Array, after: float, drives: Drives, place: Place) -> None:
    """Let one tick pass, in place; voltage (N,) are the commands V_c held over it.

    Trials stop `after` seconds after their end.
    """
    # Passing the state to a function costs more than a tick of flight, so this loop is flat.
    for i in range(len(state.time)):
        if state.time[i] >= state.end_time[i] + after:
            continue
        arm = int(state.arm[i])
        state.motor[i] = drives.supply[arm] * np.tanh(drives.input_gain[arm] * voltage[i])
        state.ticks[i] += 1
        tick_end = state.ticks[i] * place.tick
        end = tick_end
        for _ in range(_MOST_EVENTS):
            end = min(tick_end, state.end_time[i] + after)
            if state.time[i] >= end:
                break
            meeting = _meeting(state, i, drives, place)
            flying, radius = state.outcome[i] == FLYING, place.radius[int(state.ball[i])]
            span, event = next_event(
                meeting, state.pushed[i], flying, radius, end - state.time[i], place
            )
            wait = state.crossing_time[i] - state.time[i]
            if 0.0 <= wait <= span:
                state.arm_at_crossing[i] = _arm_after(meeting, wait)
            moved = _moved(meeting, span)
            state.x[i], state.vx[i], state.z[i], state.vz[i] = moved[:4]
            state.arm_x[i], state.arm_v[i] = moved[4:]
            state.time[i] = end if event == NONE else state.time[i] + span
            if event != NONE:
                _happen(event, state, i, drives, place)
        state.time[i] = end


@compiled
def _happen(event: int, state: State, i: int, drives: Drives, place: Place) -> None:
    """What an event changes."""
    if event == GROUND:
        _land(state, i, place)
    elif event == OUT:
        _finish(state, i, KNOCKED_OUT)
    elif event == ARM_STOP:
        is_left = state.arm_x[i] < 0.5 * (place.low + place.high)
        state.arm_x[i] = place.low if is_left else place.high
        state.arm_v[i] = 0.0
        state.pushed[i] = 0.0
    elif event == RELEASE:
        state.pushed[i] = 0.0
    else:
        _touch(state, i, event, drives, place)


@compiled
def _meeting(state: State, i: int, drives: Drives, place: Place) -> Meeting:
    """Ball and arm of trial i, and what acts on them now."""
    d, k = int(state.arm[i]), place.decay[int(state.ball[i])]
    pull, rate = drives.pull_per_volt[d] * state.motor[i], drives.rate[d]
    if pushes_stop(state.arm_x[i], state.arm_v[i], pull, place.low, place.high):
        pull = 0.0
    vx, pull_x, decay_x = state.vx[i], 0.0, k
    if state.pushed[i] != 0.0:
        vx, pull_x, decay_x = state.arm_v[i], pull, rate
    return Meeting(
        state.x[i],
        vx,
        pull_x,
        decay_x,
        state.z[i],
        state.vz[i],
        0.0 if state.lying[i] else -GRAVITY,
        k,
        state.arm_x[i],
        state.arm_v[i],
        pull,
        rate,
    )


@compiled
def _arm_after(meeting: Meeting, t: float) -> float:
    return position_after(meeting.arm, meeting.arm_v, meeting.arm_pull, meeting.arm_decay, t)


@compiled
def _moved(meeting: Meeting, span: float) -> tuple[float, float, float, float, float, float]:
    """x, vx, z, vz of the ball and x, v of the arm after span seconds without an event."""
    x, vx = state_after(meeting.x, meeting.vx, meeting.pull_x, meeting.decay_x, span)
    z, vz = state_after(meeting.z, meeting.vz, meeting.pull_z, meeting.decay_z, span)
    arm, v = state_after(meeting.arm, meeting.arm_v, meeting.arm_pull, meeting.arm_decay, span)
    return x, vx, z, vz, arm, v


@compiled
def _land(state: State, i: int, place: Place) -> None:
    """The ball meets the ground, which is hard, or the cup's floor, which is not."""
    state.z[i] = place.radius[int(state.ball[i])]
    inside = place.collisions and abs(state.x[i] - state.arm_x[i]) < place.half_width
    if inside:
        state.contact_time[i] = min(state.contact_time[i], state.time[i])
    if state.outcome[i] == FLYING:
        _finish(state, i, CAUGHT if inside else MISSED)
    parting = -place.restitution * state.vz[i]
    if inside or parting < 0.5 * SHORTEST_HOP * GRAVITY:
        state.lying[i] = True
        parting = 0.0
    state.vz[i] = parting


@compiled
def _touch(state: State, i: int, event: int, drives: Drives, place: Place) -> None:
    """The ball meets a wall of the cup."""
    state.contact_time[i] = min(state.contact_time[i], state.time[i])
    side = -place.half_width if event == LEFT_WALL else place.half_width
    meeting = _meeting(state, i, drives, place)
    vx, vz, pushed = rebound(meeting, side, place.height, place.restitution)
    state.vx[i], state.vz[i], state.pushed[i] = vx, vz, pushed


@compiled
def _finish(state: State, i: int, outcome: int) -> None:
    """The trial is over; its last moment is kept as it was before any rebound."""
    state.outcome[i] = outcome
    state.end_time[i] = state.time[i]
    if np.isnan(state.arm_at_crossing[i]):
        # Undisturbed, the end is the crossing, but for rounding.
        state.arm_at_crossing[i] = state.arm_x[i]
    state.final[i, 0] = state.x[i]
    state.final[i, 1] = state.z[i]
    state.final[i, 2] = state.vx[i]
    state.final[i, 3] = state.vz[i]
    state.final[i, 4] = state.arm_x[i]
    state.final[i, 5] = state.arm_v[i]
    state.final[i, 6] = state.motor[i]
