"""Ball against cup: when they touch, exactly, and what becomes of the ball (section 4.4.1).

The ball is a disc; each wall of the cup is a thin upright segment from the ground to its rim.
Nothing has friction, and the arm does not notice. Faces turned inward, and the floor, are
overdamped: the ball keeps no velocity across them relative to the cup. Faces turned outward, rims
and the ground are underdamped: it leaves them with the restitution of `Cup`.
"""

from typing import NamedTuple

import numpy as np

from handeye._compiled import compiled
from handeye.catching.motion import position_after, velocity_after

SHORTEST_HOP = 1e-3
"""Seconds. Where the ball is pressed on, hops shorter than this become lasting contact [s].

On the rims, which it must slide over, hops stay this long: 1 micrometre high under gravity.
"""

# Gaps below this are contact [m]; a ball that does not approach is looked at this much later [s].
_TOUCHING = 1e-12
_PATIENCE = 1e-6


class Meeting(NamedTuple):
    """Ball and arm at one moment, and the pulls and decay rates that act until the next event.

    Each coordinate obeys v' = pull - decay v (`handeye.catching.motion`).
    """

    x: float  # ball's centre [m], [m/s]
    vx: float
    pull_x: float
    decay_x: float
    z: float
    vz: float
    pull_z: float
    decay_z: float
    arm: float  # cup's centre [m], [m/s]
    arm_v: float
    arm_pull: float
    arm_decay: float


@compiled
def _most_press(meeting: Meeting, nx: float, nz: float, t: float, end: float) -> float:
    """A bound of the acceleration [m/s^2] of the ball towards a wall from t to end.

    (nx, nz) is the normal from the wall to the ball. Each of the three accelerations decays, so
    each is greatest at one of the ends.
    """
    ball_now = -nx * _decayed(meeting.vx, meeting.pull_x, meeting.decay_x, t)
    ball_then = -nx * _decayed(meeting.vx, meeting.pull_x, meeting.decay_x, end)
    arm_now = nx * _decayed(meeting.arm_v, meeting.arm_pull, meeting.arm_decay, t)
    arm_then = nx * _decayed(meeting.arm_v, meeting.arm_pull, meeting.arm_decay, end)
    fall_now = -nz * _decayed(meeting.vz, meeting.pull_z, meeting.decay_z, t)
    fall_then = -nz * _decayed(meeting.vz, meeting.pull_z, meeting.decay_z, end)
    return max(ball_now, ball_then) + max(arm_now, arm_then) + max(fall_now, fall_then)


@compiled
def _decayed(v: float, pull: float, decay: float, t: float) -> float:
    """Acceleration t seconds on: (pull - decay v) exp(-decay t)."""
    return (pull - decay * v) * np.exp(-decay * t)


@compiled
def _approach(
    meeting: Meeting, side: float, height: float, radius: float, t: float
) -> tuple[float, float, float, float]:
    """Gap to a wall at arm + side, its rate, and the normal from wall to ball, t seconds on."""
    x = position_after(meeting.x, meeting.vx, meeting.pull_x, meeting.decay_x, t)
    z = position_after(meeting.z, meeting.vz, meeting.pull_z, meeting.decay_z, t)
    arm = position_after(meeting.arm, meeting.arm_v, meeting.arm_pull, meeting.arm_decay, t)
    vx = velocity_after(meeting.vx, meeting.pull_x, meeting.decay_x, t)
    arm_v = velocity_after(meeting.arm_v, meeting.arm_pull, meeting.arm_decay, t)
    across = x - arm - side
    if z <= height:
        nx = 1.0 if across > 0.0 else -1.0
        return abs(across) - radius, nx * (vx - arm_v), nx, 0.0
    distance = np.hypot(across, z - height)
    nx, nz = across / distance, (z - height) / distance
    vz = velocity_after(meeting.vz, meeting.pull_z, meeting.decay_z, t)
    return distance - radius, nx * (vx - arm_v) + nz * vz, nx, nz


@compiled
def first_touch(meeting: Meeting, side: float, height: float, radius: float, span: float) -> float:
    """Seconds until the ball touches the wall at arm + side, inf if not within span.

    The distance d to a segment is convex in the ball's relative position p, so from any moment on
    d >= d_now + n . (p - p_now), n the normal now, and that falls by at most |d'| s + A s^2 / 2 in
    s seconds, A bounding the acceleration towards the wall. Going on by the s at which this bound
    meets the radius never steps past a contact, however short, and closes in on it quadratically.
    """
    t = 0.0
    while t < span:
        gap, rate, nx, nz = _approach(meeting, side, height, radius, t)
        if gap <= _TOUCHING and rate < 0.0:
            return t
        gap = max(gap, 0.0)
        press = _most_press(meeting, nx, nz, t, span)
        if press > 0.0:
            root = np.sqrt(rate * rate + 2.0 * press * gap)
            # Of the two forms of the same root, the one without a difference of equal numbers.
            step = (rate + root) / press if rate >= 0.0 else 2.0 * gap / (root - rate)
        else:
            step = gap / -rate if rate < 0.0 else np.inf
        if rate >= 0.0:
            step = max(step, _PATIENCE)
        t += step
    return np.inf


@compiled
def rebound(
    meeting: Meeting, side: float, height: float, restitution: float
) -> tuple[float, float, float]:
    """Velocity vx, vz [m/s] after touching the wall at arm + side, and how the wall then pushes.

    With n the normal and u the speed of approach along it, the ball gains (1 + e) u n; across n
    nothing changes. The wall goes on to push the ball, +1 to the right or -1 to the left, where the
    ball is pressed on and would hardly part; else the third number is 0.
    """
    _, rate, nx, nz = _approach(meeting, side, height, 0.0, 0.0)
    speed = -rate
    parting = restitution * speed
    if nz > 0.0:
        press = max(_most_press(meeting, nx, nz, 0.0, 0.0), 0.0)
        gained = speed + max(parting, 0.5 * SHORTEST_HOP * press)
        return meeting.vx + gained * nx, meeting.vz + gained * nz, 0.0
    press = nx * _push(meeting.arm_v, meeting.arm_pull, meeting.arm_decay, meeting.decay_x)
    inner = nx * side < 0.0
    if inner or parting < 0.5 * SHORTEST_HOP * press:
        return meeting.arm_v, meeting.vz, nx if press > 0.0 else 0.0
    return meeting.arm_v + nx * parting, meeting.vz, 0.0


@compiled
def _push(v: float, pull: float, decay: float, ball_decay: float) -> float:
    """Acceleration [m/s^2] of an arm over that of a ball as fast as the arm."""
    return pull - (decay - ball_decay) * v


@compiled
def push_end(way: float, v: float, pull: float, decay: float, ball_decay: float) -> float:
    """Seconds until a wall that pushes a ball to the side `way`, +1 or -1, does so no more.

    The push p = pull - (decay - k) v goes from its value p_0 to its limit p_inf with
    p = p_inf + (p_0 - p_inf) exp(-decay t); inf if it does not turn round.
    """
    now = way * _push(v, pull, decay, ball_decay)
    if now <= 0.0:
        return 0.0
    limit = way * _push(pull / decay, pull, decay, ball_decay)
    if limit >= 0.0:
        return np.inf
    return np.log1p(-now / limit) / decay
