"""The loop of figure 4.17 by itself: an arm that tracks a reference, no cup, no collisions.

`handeye.catching.play` moves the arm exactly between ticks. Section 4.8.2 says that the whole
loop, arm and controller, was simulated with Euler's method; that is another loop when lambda
comes near the tick.
"""

import itertools
from dataclasses import dataclass
from typing import Literal

import numpy as np

from handeye.arrays import Array, Booleans
from handeye.catching.arm import Arm
from handeye.catching.ball import BALLS, flight
from handeye.catching.layout import Layout
from handeye.catching.play import Controller
from handeye.catching.throws import Throws
from handeye.catching.world import Sensed

Motion = Literal["euler", "exact"]


@dataclass(frozen=True, eq=False)
class Tracking:
    """N throws over T ticks, each (T, N) but the last; NaN from a throw's crossing on.

    time            since launch [s]
    ball_x, arm_x   [m]
    position_error  arm minus ball when it crosses (N,) [m]
    """

    time: Array
    ball_x: Array
    arm_x: Array
    position_error: Array

    def caught(self, layout: Layout = Layout()) -> Booleans:
        """Whether the whole ball is between the walls of the cup when it crosses (N,)."""
        radius = max(ball.radius for ball in BALLS)
        return np.abs(self.position_error) <= 0.5 * layout.cup.width - radius


def track(
    controller: Controller,
    throws: Throws,
    arm: Arm,
    *,
    motion: Motion = "euler",
    layout: Layout = Layout(),
    stops: bool = False,
) -> Tracking:
    """Let a controller move one arm under flying balls until they cross.

    With "euler", position and velocity follow eq 4.1 from tick to tick as

        x_{k+1} = x_k + v_k dt,  v_{k+1} = v_k + (pull_k - v_k / tau) dt

    With "exact", they are those of the held voltage. The first multiplies a mode exp(-t / lambda)
    by 1 - dt / lambda a tick, so the IMC design is stable for lambda > dt / 2; the second is not.

    Args:
        controller: what commands the arm.
        throws: balls, where the arm starts, and when they cross; the arm's identity is not used.
        arm: that is moved, the same in all throws.
        motion: how the arm moves between ticks.
        layout: for the clock and the travel.
        stops: whether the arm stops dead at the ends of its travel.
    """
    dt, tau = layout.tick, arm.time_constant
    n, decay = len(throws), np.array([ball.decay for ball in BALLS])[throws.ball]
    x, v, motor = throws.arm_x.copy(), np.zeros(n), np.zeros(n)
    at_crossing = np.full(n, np.nan)
    rows: list[list[Array]] = []
    controller.begin(n)
    for tick in itertools.count():
        time = np.full(n, tick * dt)
        active = time < throws.crossing_time
        if not active.any():
            break
        ball = np.empty((n, 4))
        flight(throws.x, throws.z, throws.vx, throws.vz, decay, time, ball)
        seen = (ball[:, i].copy() for i in range(4))
        force = arm.force(motor, v)
        command = controller.act(
            Sensed(time, *seen, arm_x=x, arm_v=v, arm_force=force, active=active)
        )
        motor = arm.motor_voltage(np.where(active, command, 0.0))
        rows.append([np.where(active, each, np.nan) for each in (time, ball[:, 0], x)])
        pull = motor * arm.force_per_volt / arm.mass
        at_end = _moved(x, v, pull, tau, throws.crossing_time - time, motion)[0]
        at_crossing = np.where(active, at_end, at_crossing)
        x, v = _moved(x, v, pull, tau, np.full(n, dt), motion)
        if stops:
            low, high = layout.arm_travel
            v = np.where(((x <= low) & (v < 0.0)) | ((x >= high) & (v > 0.0)), 0.0, v)
            x = np.clip(x, low, high)
    stacked = np.array(rows).reshape(len(rows), 3, n)
    return Tracking(stacked[:, 0], stacked[:, 1], stacked[:, 2], at_crossing - throws.crossing_x)


def _moved(
    x: Array, v: Array, pull: Array, tau: float, t: Array, motion: Motion
) -> tuple[Array, Array]:
    """Position and velocity (N,) after t (N,) seconds under a constant pull (N,) [m/s^2]."""
    if motion == "euler":
        return x + v * t, v + (pull - v / tau) * t
    end, kept = pull * tau, np.exp(-t / tau)
    return x + end * t + (v - end) * tau * (1.0 - kept), end + (v - end) * kept
