"""When an arm may move: one pursuit per throw, or one after the other (section 4.4.2)."""

import numpy as np

from handeye.arrays import Array, Booleans, Integers

WAITING, MOVING, DONE = 0, 1, 2


class Pursuits:
    """The state of the pursuit in each of n throws.

    A pursuit begins when there is something to pursue. It ends when the arm, having moved, comes
    to rest or turns back within reach of its target, or when the arrival is due; an arm that stops
    elsewhere is still on its way. Losing comprehension breaks it off, so that
    another may begin once the situation is understood again. After an end there is no second one
    unless `repeated`.

    Args:
        n: throws.
        rest: speed below which the arm is at rest [m/s].
        reach: distance within which it is at its target [m].
        repeated: a pursuit may follow a completed one.
    """

    def __init__(self, n: int, rest: float, reach: float, *, repeated: bool) -> None:
        self.state: Integers = np.full(n, WAITING)
        self._direction = np.zeros(n)
        self._has_moved: Booleans = np.zeros(n, np.bool_)
        self._rest = rest
        self._reach = reach
        self._repeated = repeated

    def advance(
        self,
        understood: Booleans,
        may_begin: Booleans,
        arm_v: Array,
        distance: Array,
        remaining: Array,
    ) -> Booleans:
        """One tick: which throws (N,) are in a pursuit now.

        Args:
            understood: there is a situation that is understood, and a command for it.
            may_begin: a pursuit may begin there.
            arm_v: velocity of the arm [m/s].
            distance: to the target, signed [m].
            remaining: time until the arm should be there [s].
        """
        along = arm_v * self._direction
        self._has_moved |= along > self._rest
        stopped = self._has_moved & (along <= self._rest) & (np.abs(distance) <= self._reach)
        ended = (remaining <= 0.0) | stopped
        moving = self.state == MOVING
        self.state[moving & ended] = DONE
        self.state[moving & ~ended & ~understood] = WAITING
        if self._repeated:
            self.state[self.state == DONE] = WAITING
        begins = (self.state == WAITING) & understood & may_begin & (remaining > 0.0)
        self.state[begins] = MOVING
        self._direction[begins] = np.sign(distance[begins])
        self._has_moved[begins] = False
        return self.state == MOVING
