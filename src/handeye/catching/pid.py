"""The conventional rival: a PID controller tuned by Internal Model Control (section 4.8)."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal, Self

import numpy as np

from handeye.arrays import Array, Booleans, Integers, scalar, shaped
from handeye.catching.arm import Arm
from handeye.catching.layout import Layout
from handeye.catching.play import Controller
from handeye.catching.throws import Throws
from handeye.catching.world import Sensed
from handeye.errors import InvalidInput

Reference = Literal["ball", "crossing"]
Derivative = Literal["sensed", "differences", "none"]

_LINEAR = 1e6


@dataclass(frozen=True)
class Gains:
    """c(s) = kappa_p (1 + T_d s + 1 / (T_i s)), from metres to motor volts (eq 4.7).

    proportional     kappa_p [V/m]
    integral_time    T_i [s]
    derivative_time  T_d [s]
    """

    proportional: float
    integral_time: float
    derivative_time: float

    @classmethod
    def imc(cls, arm: Arm, closed_loop: float) -> Self:
        """Gains for ramps, from an arm and the one number lambda (eq 4.8 to 4.10).

            kappa_p = (2 lambda + tau) / lambda^2 * alpha R M / (k_m tau)
            T_i = 2 lambda + tau
            T_d = 2 lambda tau / (2 lambda + tau)

        The loop then is (2 lambda s + 1) / (lambda s)^2: the controller's zero at -1 / tau cancels
        the arm's pole, and eq 4.12 is (2 lambda s + 1) / (lambda s + 1)^2 whatever the arm.

        Args:
            arm: M, tau and the motor's constants.
            closed_loop: lambda, the time constant that the closed loop shall have [s].
        """
        slow = scalar(closed_loop, "closed_loop", above=0.0)
        tau = arm.time_constant
        speed_per_volt = arm.force_per_volt * tau / arm.mass
        both = 2.0 * slow + tau
        return cls(both / slow**2 / speed_per_volt, both, 2.0 * slow * tau / both)


def linear_amplifier(arm: Arm) -> Arm:
    """The same arm with V_m = A G_i V_c for all voltages that matter (footnote 14).

    The supply is a million times larger and the input gain smaller by as much, so that tanh is a
    straight line to the eleventh digit up to a hundred volts.
    """
    return replace(arm, supply=arm.supply * _LINEAR, input_gain=arm.input_gain / _LINEAR)


class PIDController:
    """Follows the ball across, or goes to where it will come down, with Euler's method.

    At tick k, dt apart, with e the reference minus the arm's position:

        V_m = kappa_p (e_k + T_d e'_k + I_k / T_i),  I_{k+1} = I_k + e_k dt

    and the command is V_c = V_m / (A G_i), which the linear amplifier of footnote 14 turns back
    into V_m; the saturating one gives less.

    It is told which arm it moves. Ball and crossing it is told with `throws`, or it asks an
    `observer`, such as a catcher that has learned: one that is shown everything and whose traces
    "ball" and "crossing_x" are used while its own commands are not. While the observer has no
    answer, the gentlest gains are used, and there is no crossing to go to: the arm is braked.

    Args:
        arm: the arm that the gains are made for.
        closed_loop: lambda of eq 4.8 to 4.10 [s]; one for each ball is gain scheduling (section
            4.9).
        reference: "ball", the ball's horizontal position, or "crossing", the place where it comes
            down (the two modes of section 4.8.3).
        throws: what is about to be thrown, if it is told.
        observer: who is asked otherwise.
        tick: of the clock [s].
        derivative: of the error: from the velocity sensors, from differences between ticks, or
            none.
        integral: False leaves the integral term out.

    Raises:
        InvalidInput: nobody, or two, say which ball it is or where it comes down; a ball without a
            lambda.
    """

    def __init__(
        self,
        arm: Arm,
        closed_loop: float | Sequence[float],
        *,
        reference: Reference = "ball",
        throws: Throws | None = None,
        observer: Controller | None = None,
        tick: float = Layout.tick,
        derivative: Derivative = "sensed",
        integral: bool = True,
    ) -> None:
        lambdas = shaped(np.atleast_1d(closed_loop), (None,), "closed_loop")
        by_ball = [Gains.imc(arm, each) for each in lambdas]
        if throws is not None and observer is not None:
            raise InvalidInput("give throws or an observer, not both")
        if throws is None and observer is None and (reference == "crossing" or len(by_ball) > 1):
            raise InvalidInput(
                "throws or an observer must say which ball it is and where it comes down"
            )
        if throws is not None and 1 < len(by_ball) <= throws.ball.max(initial=0):
            raise InvalidInput(f"closed_loop must be one lambda for each ball, got {lambdas}")
        self._kp = np.array([gains.proportional for gains in by_ball])
        self._ti = np.array([gains.integral_time for gains in by_ball])
        self._td = np.array([gains.derivative_time for gains in by_ball])
        self._gentlest = int(np.argmax(lambdas))
        self._per_volt = 1.0 / (arm.supply * arm.input_gain)
        self._reference: Reference = reference
        self._throws = throws
        self._observer = observer
        self._tick = scalar(tick, "tick", above=0.0)
        self._derivative: Derivative = derivative
        self._integral = integral
        self.begin(0 if throws is None else len(throws))

    def begin(self, n: int) -> None:
        """Empty the integral for n throws."""
        if self._throws is not None and len(self._throws) != n:
            raise InvalidInput(f"told of {len(self._throws)} throws, but {n} begin")
        if self._observer is not None:
            self._observer.begin(n)
        self._sum = np.zeros(n)
        self._last = np.full(n, np.nan)
        self._error = np.zeros(n)
        self._aim = np.full(n, np.nan)

    def act(self, sensed: Sensed) -> Array:
        """Command voltages V_c (N,)."""
        if self._observer is not None:
            self._observer.act(sensed)
        self._aim, aim_v = self._target(sensed)
        known = sensed.active & ~np.isnan(self._aim)
        self._error = np.where(known, self._aim - sensed.arm_x, 0.0)
        rate = self._rate(np.where(known, aim_v, 0.0) - np.where(known, sensed.arm_v, 0.0), known)
        rate = np.where(sensed.active & ~known, -sensed.arm_v, rate)
        row = self._rows(len(self._error))
        volts = self._error + self._td[row] * rate
        if self._integral:
            volts += self._sum / self._ti[row]
        self._sum += self._error * self._tick
        return self._kp[row] * volts * self._per_volt

    def traces(self) -> dict[str, Array]:
        """The reference [m], and what the observer thinks if there is one."""
        seen = {} if self._observer is None else self._observer.traces()
        return {**seen, "reference": self._aim}

    def _target(self, sensed: Sensed) -> tuple[Array, Array]:
        """Where the arm should be (N,) [m], NaN if unknown, and how fast that moves [m/s]."""
        if self._reference == "ball":
            return sensed.ball_x, sensed.ball_vx
        if self._throws is not None:
            crossing = self._throws.crossing_x
        else:
            crossing = self._asked("crossing_x")
        return crossing, np.zeros_like(crossing)

    def _rate(self, sensed: Array, known: Booleans) -> Array:
        """The derivative of the error (N,) [m/s]; differences begin with the second error."""
        if self._derivative == "sensed":
            return sensed
        if self._derivative == "none":
            return np.zeros_like(sensed)
        change = (self._error - self._last) / self._tick
        self._last = np.where(known, self._error, np.nan)
        return np.nan_to_num(change)

    def _rows(self, n: int) -> Integers:
        """Which gains each throw gets (N,)."""
        if len(self._kp) == 1:
            return np.zeros(n, np.int64)
        if self._throws is not None:
            return self._throws.ball
        ball = self._asked("ball")
        return np.where(ball >= 0.0, ball, self._gentlest).astype(np.int64)

    def _asked(self, name: str) -> Array:
        assert self._observer is not None
        return self._observer.traces()[name]
