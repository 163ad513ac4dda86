"""What happens next between ball, cup, ground, stops and bounds, and exactly when."""

from typing import NamedTuple

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array
from handeye.catching.arm import stop_contact
from handeye.catching.contact import Meeting, first_touch, push_end
from handeye.catching.motion import arrival_time, position_after, standstill_time

NONE, GROUND, OUT, ARM_STOP, RELEASE, LEFT_WALL, RIGHT_WALL = range(7)
"""No event; the ball meets ground or floor; goes out of bounds; the arm runs into a stop; a wall
pushes the ball no more; the ball meets a wall of the cup."""


class Place(NamedTuple):
    """What the kernels need to know of the layout, and of each ball (n,)."""

    tick: float
    low: float  # arm travel [m]
    high: float
    left: float  # bounds [m]
    right: float
    ceiling: float
    half_width: float  # of the cup [m]
    height: float
    restitution: float
    collisions: bool  # False: the arm is out of the way
    decay: Array  # of each ball [1/s]
    radius: Array  # [m]


@compiled
def next_event(
    meeting: Meeting, pushed: float, flying: bool, radius: float, span: float, place: Place
) -> tuple[float, int]:
    """Seconds until the first event within span, and which; the whole span if there is none."""
    found, event = span, NONE
    time = _landing(meeting, radius, span)
    if time < found:
        found, event = time, GROUND
    if flying:
        time = _leaving(meeting, pushed, place, span)
        if time < found:
            found, event = time, OUT
    time = _arm_stop(meeting, place, span)
    if time < found:
        found, event = time, ARM_STOP
    if pushed != 0.0:
        time = _release(meeting, pushed, meeting.decay_z, place.height)
        if time < found:
            found, event = time, RELEASE
    elif place.collisions and _is_low(meeting, place.height + radius, found):
        time = first_touch(meeting, -place.half_width, place.height, radius, found)
        if time < found:
            found, event = time, LEFT_WALL
        time = first_touch(meeting, place.half_width, place.height, radius, found)
        if time < found:
            found, event = time, RIGHT_WALL
    return found, event


@compiled
def _height(meeting: Meeting, t: float) -> float:
    return position_after(meeting.z, meeting.vz, meeting.pull_z, meeting.decay_z, t)


@compiled
def _is_low(meeting: Meeting, least: float, span: float) -> bool:
    """Whether the ball is below a height at some time: then it is so at one of the ends."""
    return min(meeting.z, _height(meeting, span)) < least


@compiled
def _apex_time(meeting: Meeting, span: float) -> float:
    if meeting.vz <= 0.0 or meeting.pull_z == 0.0:
        return 0.0
    return min(standstill_time(meeting.vz, meeting.pull_z, meeting.decay_z), span)


@compiled
def _landing(meeting: Meeting, radius: float, span: float) -> float:
    """When the ball comes down on the ground or the floor within span, else inf."""
    if meeting.pull_z == 0.0 or _height(meeting, span) >= radius:
        return np.inf
    z, vz, pull, decay = meeting.z, meeting.vz, meeting.pull_z, meeting.decay_z
    return arrival_time(z, vz, pull, decay, radius, _apex_time(meeting, span), span)


@compiled
def _leaving(meeting: Meeting, pushed: float, place: Place, span: float) -> float:
    """When the ball goes out of bounds within span, else inf; the arm cannot push it there."""
    time = np.inf
    z, vz = meeting.z, meeting.vz
    # Without the pull it would rise farther, without the decay it would go farther.
    if z + vz * span > place.ceiling:
        rising = _apex_time(meeting, span)
        if _height(meeting, rising) > place.ceiling:
            pull, decay = meeting.pull_z, meeting.decay_z
            time = arrival_time(z, vz, pull, decay, place.ceiling, 0.0, rising)
    x, vx, decay = meeting.x, meeting.vx, meeting.decay_x
    farthest = x + vx * span
    if pushed != 0.0 or place.left <= farthest <= place.right:
        return time
    later = position_after(x, vx, 0.0, decay, span)
    if later > place.right:
        return min(time, arrival_time(x, vx, 0.0, decay, place.right, 0.0, span))
    if later < place.left:
        return min(time, arrival_time(x, vx, 0.0, decay, place.left, 0.0, span))
    return time


@compiled
def _arm_stop(meeting: Meeting, place: Place, span: float) -> float:
    """When the arm runs into a stop within span, else inf."""
    x, v, pull, decay = meeting.arm, meeting.arm_v, meeting.arm_pull, meeting.arm_decay
    farthest = (abs(v) + abs(pull) * span) * span
    if place.low + farthest < x < place.high - farthest:
        return np.inf
    return stop_contact(x, v, pull, decay, place.low, place.high, span)


@compiled
def _release(meeting: Meeting, way: float, ball_decay: float, height: float) -> float:
    """When the wall that pushes the ball does so no more, or the ball rises above it."""
    pull, decay = meeting.arm_pull, meeting.arm_decay
    time = push_end(way, meeting.arm_v, pull, decay, ball_decay)
    rising = _apex_time(meeting, np.inf)
    if rising > 0.0 and _height(meeting, rising) > height:
        z, vz = meeting.z, meeting.vz
        above = arrival_time(z, vz, meeting.pull_z, meeting.decay_z, height, 0.0, rising)
        time = min(time, above)
    return time
