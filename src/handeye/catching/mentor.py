"""The mentor: says how much farther and earlier to go next time (sections 4.4.2, 4.7)."""

from typing import NamedTuple

import numpy as np

from handeye.arrays import Array


class Advice(NamedTuple):
    """Adjustments of N throws: delta_x (N,) [m] to the target, delta_t (N,) [s] to the arrival."""

    delta_x: Array
    delta_t: Array


def advise(
    crossing_x: Array, crossing_time: Array, stop_x: Array, stop_time: Array, early: float = 0.1
) -> Advice:
    """The rule "arrive at the crossing a tenth of a second before the ball" (eq 4.5, 4.6).

        delta_x = b_xc - a_xs,  delta_t = t_c - t_s - early

    Args:
        crossing_x: where the ball crosses if nothing deflects it [m].
        crossing_time: when [s].
        stop_x: where the arm came to rest [m].
        stop_time: when [s].
        early: how long before the ball the arm should arrive [s].
    """
    return Advice(crossing_x - stop_x, crossing_time - stop_time - early)


def arrival(
    time: Array, arm_x: Array, final_time: Array, final_x: Array, reach: float
) -> tuple[Array, Array]:
    """Where and when the arm came to rest: (N,) [m], (N,) [s].

    It has arrived at the first tick from which on it stays within `reach` [m] of where it is at
    the end. An arm that is still moving then has arrived at the last moment: it is late by at least
    as much as the mentor will say.

    Args:
        time: of the ticks (T, N), NaN once a trial is over [s].
        arm_x: where the arm was then (T, N) [m].
        final_time: end of each trial (N,) [s].
        final_x: where the arm was then (N,) [m].
        reach: how near is near enough [m].
    """
    ticks = np.arange(len(arm_x))[:, np.newaxis]
    away = np.abs(arm_x - final_x) > reach
    there = np.where(away, ticks + 1, 0).max(axis=0)
    with_end = np.vstack([np.where(np.isnan(time), final_time, time), final_time])
    return final_x, with_end[there, np.arange(there.size)]
