"""Throws: which ball, which arm, from where to where; and whether the arm can be there in time."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from handeye._compiled import compiled
from handeye.arrays import Array, Booleans, Integers, count, finite
from handeye.catching.arm import ARMS
from handeye.catching.ball import BALLS, speed_to_reach, time_down_to
from handeye.catching.layout import Interval, Layout
from handeye.catching.motion import mean_decay, position_after, velocity_after
from handeye.errors import InvalidInput

# Redraws before a layout is said to have no throw that the arm could catch.
_ROUNDS = 200


@dataclass(frozen=True, eq=False)
class Throws:
    """N throws, each field (N,); `throws[i]` with a slice, mask or index array picks some.

    ball, arm                              identities: places in BALLS and ARMS
    arm_x                                  where the arm waits, at rest [m]
    x, z, vx, vz                           launch of the ball's centre [m], [m/s]
    crossing_time, crossing_x, crossing_vx  of the flight if nothing disturbs it: when the centre
                                           descends through z = r, so that the ball touches z = 0
    """

    ball: Integers
    arm: Integers
    arm_x: Array
    x: Array
    z: Array
    vx: Array
    vz: Array
    crossing_time: Array
    crossing_x: Array
    crossing_vx: Array

    def __post_init__(self) -> None:
        for field in fields(self):
            value = finite(getattr(self, field.name), field.name)
            if value.ndim != 1 or len(value) != len(np.atleast_1d(self.ball)):
                raise InvalidInput(
                    f"{field.name} must have one value for each throw, got {value.shape}"
                )
            if field.name in {"ball", "arm"}:
                value = np.asarray(getattr(self, field.name), np.int64)
            object.__setattr__(self, field.name, value)

    def __len__(self) -> int:
        return len(self.ball)

    def __getitem__(self, index: Any) -> Self:
        return type(self)(**{f.name: getattr(self, f.name)[index] for f in fields(self)})


def draw_throws(
    n: int,
    rng: np.random.Generator,
    *,
    layout: Layout = Layout(),
    balls: Sequence[int] = (0, 1),
    arms: Sequence[int] = (0, 1),
    catchable: bool = True,
) -> Throws:
    """n random throws in a layout.

    Ball, arm, the arm's start, the place of launch, the apex and the place of the crossing are
    independent and uniform; the launch velocity follows from them exactly. With `catchable`, those
    that the arm cannot reach in time (footnote 8) are drawn anew; in the default layout it reaches
    all. Seven numbers are drawn for each throw.

    Raises InvalidInput if hardly any throw in the layout is catchable.
    """
    count(n, "n", least=0)
    for identities, known, name in ((balls, BALLS, "balls"), (arms, ARMS, "arms")):
        if not identities or not all(0 <= i < len(known) for i in identities):
            raise InvalidInput(f"{name} must be identities below {len(known)}, got {identities}")
    kept: list[Throws] = []
    missing = n
    for _ in range(_ROUNDS):
        drawn = _drawn(rng.random((missing, 7)).T, layout, balls, arms)
        if catchable:
            drawn = drawn[can_be_caught(drawn, layout=layout)]
        kept.append(drawn)
        missing -= len(drawn)
        if missing == 0:
            return _joined(kept)
    raise InvalidInput(f"hardly any throw in {layout} can be caught")


def launch(
    ball: ArrayLike,
    arm: ArrayLike,
    arm_x: ArrayLike,
    x: ArrayLike,
    z: ArrayLike,
    vx: ArrayLike,
    vz: ArrayLike,
) -> Throws:
    """Throws with these launch states, see `Throws`; a number stands for all N.

    Raises InvalidInput for balls launched in the ground.
    """
    given = (arm_x, x, z, vx, vz)
    columns = np.broadcast_arrays(ball, arm, *(np.asarray(c, np.float64) for c in given))
    thrown, moved = (np.atleast_1d(c).astype(np.int64) for c in columns[:2])
    arm_x, x, z, vx, vz = (np.atleast_1d(c).astype(np.float64) for c in columns[2:])
    decay, radius = _decay_and_radius(thrown)
    if np.any(z < radius):
        raise InvalidInput(f"every ball must be launched above the ground: z >= {radius.max()}")
    out = np.empty((len(x), 3))
    _follow(x, z, vx, vz, decay, radius, out)
    return Throws(thrown, moved, arm_x, x, z, vx, vz, *out.T.copy())


def can_be_caught(throws: Throws, *, layout: Layout = Layout(), spare: float = 0.0) -> Booleans:
    """Which throws (N,) the arm can meet: its centre at crossing_x by crossing_time (footnote 8).

    With full effort from the launch on, at any final speed. `spare` [s] asks to be there earlier.
    """
    least = np.empty(len(throws))
    for identity, arm in enumerate(ARMS):
        mine = throws.arm == identity
        least[mine] = arm.minimum_time(throws.crossing_x[mine] - throws.arm_x[mine])
    low, high = layout.arm_travel
    in_travel = (throws.crossing_x >= low) & (throws.crossing_x <= high)
    return in_travel & (least + spare <= throws.crossing_time)


def _drawn(u: Array, layout: Layout, balls: Sequence[int], arms: Sequence[int]) -> Throws:
    """Throws from uniform numbers u (7, N)."""
    ball = np.asarray(balls, np.int64)[(u[0] * len(balls)).astype(np.int64)]
    arm = np.asarray(arms, np.int64)[(u[1] * len(arms)).astype(np.int64)]
    x, z = _between(layout.launch_x, u[3]), _between(layout.launch_z, u[4])
    crossing_x = _between(layout.crossing_x, u[6])
    decay, radius = _decay_and_radius(ball)
    out = np.empty((len(ball), 4))
    _aim(x, z, _between(layout.apex, u[5]), crossing_x, decay, radius, out)
    return Throws(
        ball=ball,
        arm=arm,
        arm_x=_between(layout.arm_start, u[2]),
        x=x,
        z=z,
        vx=out[:, 0].copy(),
        vz=out[:, 1].copy(),
        crossing_time=out[:, 2].copy(),
        crossing_x=crossing_x,
        crossing_vx=out[:, 3].copy(),
    )


def _between(interval: Interval, u: Array) -> Array:
    low, high = interval
    return low + u * (high - low)


def _decay_and_radius(ball: Integers) -> tuple[Array, Array]:
    decay = np.array([each.decay for each in BALLS])
    radius = np.array([each.radius for each in BALLS])
    return decay[ball], radius[ball]


@compiled
def _follow(
    x: Array, z: Array, vx: Array, vz: Array, decay: Array, radius: Array, out: Array
) -> None:
    """Time of the crossing, and x and vx then, into out (N, 3); the others (N,)."""
    for i in range(len(x)):
        t = time_down_to(z[i], vz[i], decay[i], radius[i])
        out[i, 0] = t
        out[i, 1] = position_after(x[i], vx[i], 0.0, decay[i], t)
        out[i, 2] = velocity_after(vx[i], 0.0, decay[i], t)


@compiled
def _aim(
    x: Array, z: Array, apex: Array, crossing_x: Array, decay: Array, radius: Array, out: Array
) -> None:
    """Launch velocities that reach the apex and the crossing; all (N,).

    out (N, 4) is overwritten with vx, vz, the time of the crossing and vx then.
    """
    for i in range(len(x)):
        k = decay[i]
        vz = speed_to_reach(apex[i] - z[i], k)
        t = time_down_to(z[i], vz, k, radius[i])
        vx = (crossing_x[i] - x[i]) / (t * mean_decay(k * t))
        out[i, 0] = vx
        out[i, 1] = vz
        out[i, 2] = t
        out[i, 3] = velocity_after(vx, 0.0, k, t)


def _joined(parts: list[Throws]) -> Throws:
    if len(parts) == 1:
        return parts[0]
    return Throws(
        **{f.name: np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(Throws)}
    )
