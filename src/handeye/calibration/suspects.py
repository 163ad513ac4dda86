"""What is wrong with a log that its arm cannot explain: mistakes that many logs have, tried out.

A mistake, mended, gives other poses of the flange. If base and marker, placed anew with these,
leave several times less than without, and than an arm that was fitted to the log as it is, it is
named.
Most are first tried by a relaxation of the placement that is linear in what is unknown:

    p_i = A t_i + B vec(R_i) + t    with any A (3, 3) and B (3, 9)
"""

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import minimize_scalar

from handeye.arrays import Array
from handeye.calibration.placement import placement_size
from handeye.geometry import invert
from handeye.observations import PointObservation
from handeye.robots.urdf import UrdfArm

# A log is looked into if half of what placement leaves exceeds this share of the marker's motion.
_POOR = 0.02
# Mistakes are named if mending them leaves so many times less; each one of several, so many times.
_CLEARLY, _EACH, _MOST = 3.0, 1.5, 3
_ROWS, _TRIED = 60, 4
# Mistakes that leave no more than so many times the least come to the same.
_SAME = 1.1
# With fewer rows, one mistake of so many might fit by chance.
_FEWEST = 20
# Offsets of a joint that are tried [rad]; less than the least is for calibration to find.
_STEP, _LEAST = np.radians(15.0), np.radians(3.0)

Poses = Callable[[Array], Array]


class _Reading(NamedTuple):
    """A log read in one way: readings (N, m), and what they make of the flange (N, 4, 4)."""

    words: str
    joints: Array
    poses_of: Poses


def suspects(arm: UrdfArm, seen: PointObservation, left: float) -> tuple[str, ...]:
    """The mistakes that clearly explain why an arm does not fit what was seen, in words.

    left: half of the errors of the arm as it was fitted exceed this [m].
    """
    if len(seen) < _FEWEST:
        return ()
    some = seen[:: -(-len(seen) // _ROWS)]
    position = some.position
    now = _Reading("", some.joints, arm.poses)
    first = best = placement_size(arm.poses(some.joints), position, arm.reach)
    poor = _POOR * float(np.linalg.norm(position.std(axis=0)))
    named: list[str] = []
    while best > poor and len(named) < _MOST:
        mended = list(_mended(arm, now, position))
        order: list[int] = np.argsort([_relaxed(one, position) for one in mended]).tolist()
        tried = [mended[i] for i in sorted(order[:_TRIED])]
        sizes = np.array(
            [placement_size(one.poses_of(one.joints), position, arm.reach) for one in tried]
        )
        most = int(np.argmin(sizes))
        if sizes[most] * _EACH > best:
            break
        best, now = float(sizes[most]), tried[most]
        same = [one.words for one, size in zip(tried, sizes, strict=True) if size < _SAME * best]
        named.append(", or ".join(same))
    return tuple(named) if best * _CLEARLY < min(first, left) else ()


def _mended(arm: UrdfArm, now: _Reading, position: Array) -> Iterator[_Reading]:
    """The log with one more mistake mended."""
    q, of = now.joints, arm.readings.of.tolist()
    for j, name in enumerate(arm.joint_names):
        if np.ptp(q[:, j]) == 0.0:
            continue
        if arm.sliding[j]:
            yield _with(now, f"joint {name} seems to be in millimetres", j, q[:, j] / 1e3)
            yield _with(now, f"joint {name} seems to have the other sign", j, -q[:, j])
            continue
        yield _with(now, f"joint {name} seems to be in degrees", j, np.radians(q[:, j]))
        again = f"joint {name} seems to have been converted to radians twice"
        yield _with(now, again, j, np.degrees(q[:, j]))
        yield from _turned(now, name, j, 1.0, position)
        yield from _turned(now, name, j, -1.0, position)
        for i, other in enumerate(arm.joint_names[:j]):
            words = f"the columns of joints {other} and {name} seem to be exchanged"
            yield _with(now, words, [i, j], q[:, [j, i]])
            words = f"joints {other} and {name} seem to have the other sign"
            yield _with(now, words, [i, j], -q[:, [i, j]])
    for stage in range(1, len(of)):
        held = [j for j in range(q.shape[1]) if j not in of[:stage]]
        words = (
            f"the marker seems to sit before joint {arm.stage_names[stage]}: give its link as --tip"
        )
        yield _with(now, words, held, q[0, held])
    side = f"the sensor seems to ride on the hand: give its link as --eye, such as {arm.tip}"
    if arm.eye is not None:
        side = "the sensor seems to stand beside the robot: leave out --eye"

    def from_there(joints: Array) -> Array:
        return invert(now.poses_of(joints))

    yield _Reading(side, q, from_there)


def _with(now: _Reading, words: str, j: int | list[int], values: Array) -> _Reading:
    joints = now.joints.copy()
    joints[:, j] = values
    return _Reading(words, joints, now.poses_of)


def _turned(now: _Reading, name: str, j: int, sign: float, position: Array) -> Iterator[_Reading]:
    """Joint j with a sign, and with the offset that fits best."""

    def with_offset(offset: float) -> _Reading:
        return _with(now, "", j, sign * now.joints[:, j] + offset)

    def size(offset: float) -> float:
        return _relaxed(with_offset(offset), position)

    grid = np.arange(-np.pi, np.pi, _STEP)
    near = float(grid[np.argmin([size(offset) for offset in grid])])
    found: Any = minimize_scalar(size, bounds=(near - _STEP, near + _STEP), method="bounded")
    offset = float(found.x)
    other = "the other sign" if sign < 0.0 else "another zero"
    if abs(offset) > _LEAST:
        words = (
            f"joint {name} seems to have {other} ({np.degrees(offset):+.0f} degrees to be added)"
        )
        yield with_offset(offset)._replace(words=words)
    elif sign < 0.0:
        yield with_offset(0.0)._replace(words=f"joint {name} seems to have {other}")


def _relaxed(reading: _Reading, position: Array) -> float:
    """Half of what the relaxed placement of base and marker leaves exceeds this [m]."""
    poses = reading.poses_of(reading.joints)
    terms = np.hstack([poses[:, :3].reshape(len(poses), 12), np.ones((len(poses), 1))])
    left = position - terms @ np.linalg.lstsq(terms, position)[0]
    return float(np.median(np.linalg.norm(left, axis=1)))
