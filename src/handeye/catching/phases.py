"""When an arm may move: one pursuit per throw, or one after the other (section 4.4.2)."""

import numpy as np

from handeye.arrays import Array, Booleans, Integers

WAITING, MOVING, DONE = 0, 1, 2

REST = 4
"""Ticks of slowness that are rest; an arm that turns round is slow for one or two."""
FAST = 10.0
"""Times as fast as slow is a pursuit; an arm that creeps while there is much time makes none."""


class PursuitPhases:
    """The phase of the pursuit in each of n throws.

    A pursuit begins when there is something to pursue. It ends when the arm, having been fast, has
    come to rest, wherever that is, or when the arrival is due. Losing comprehension breaks it off,
    so that another may begin once the situation is understood again. After an end there is no
    second one unless `repeated`.

    Args:
        n: throws.
        slow: speed below which an arm may be at rest [m/s]; it is after REST ticks of that.
        repeated: a pursuit may follow a completed one.
    """

    def __init__(self, n: int, slow: float, *, repeated: bool) -> None:
        self.phase: Integers = np.full(n, WAITING)
        self._was_fast: Booleans = np.zeros(n, np.bool_)
        self._slow_ticks: Integers = np.zeros(n, np.int64)
        self._slow = slow
        self._repeated = repeated

    def advance(
        self, understood: Booleans, may_begin: Booleans, arm_v: Array, remaining: Array
    ) -> Booleans:
        """One tick: which throws (N,) are in a pursuit now.

        Args:
            understood: there is a situation that is understood, and a command for it.
            may_begin: a pursuit may begin there.
            arm_v: velocity of the arm [m/s].
            remaining: time until the arm should be there [s].
        """
        slow = np.abs(arm_v) <= self._slow
        self._slow_ticks = np.where(slow, self._slow_ticks + 1, 0)
        self._was_fast |= np.abs(arm_v) > FAST * self._slow
        ended = (remaining <= 0.0) | (self._was_fast & (self._slow_ticks >= REST))
        moving = self.phase == MOVING
        self.phase[moving & ended] = DONE
        self.phase[moving & ~ended & ~understood] = WAITING
        if self._repeated:
            self.phase[self.phase == DONE] = WAITING
        begins = (self.phase == WAITING) & understood & may_begin & (remaining > 0.0)
        self.phase[begins] = MOVING
        self._was_fast[begins] = False
        return self.phase == MOVING
