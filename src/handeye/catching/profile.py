"""The generator of antisymmetric voltage profiles (figure 4.9)."""

import numpy as np

from handeye.arrays import Array, Booleans

IDLE, DRIVING, BRAKING = 0, 1, 2


class AntisymmetricProfile:
    """Makes the commands of one pursuit in each of n trials, tick by tick.

    The arm is driven until it is past the midpoint between start and target, then braked with the
    same amplitude until it stands still, then left alone. Commands change at ticks only, so the arm
    passes the midpoint a little, and damping makes it stop short: it need not stop at the target.

    Args:
        n: trials.
        input_gain: G_i of the amplifier (eq 4.3). If given, the last pulse is made weaker so that
            the arm stands still at the next tick instead of turning back before it: the voltage is
            scaled by the ratio of the speed left to the speed lost over the last tick.
    """

    def __init__(self, n: int, *, input_gain: float | None = None) -> None:
        self.phase = np.full(n, IDLE)
        self._gain = input_gain
        self._midpoint = np.zeros(n)
        self._direction = np.zeros(n)
        self._amplitude = np.zeros(n)
        self._last_v = np.zeros(n)

    @property
    def active(self) -> Booleans:
        """Which trials (N,) are in a pursuit."""
        return self.phase != IDLE

    def trigger(self, which: Booleans, start: Array, target: Array, amplitude: Array) -> None:
        """Begin a pursuit in the trials `which` (N,), from start to target [m], all (N,).

        amplitude [V] is that of the command. A target at the start asks for nothing.
        """
        direction = np.sign(target - start)
        self.phase = np.where(which, np.where(direction == 0.0, IDLE, DRIVING), self.phase)
        self._direction = np.where(which, direction, self._direction)
        self._midpoint = np.where(which, 0.5 * (start + target), self._midpoint)
        self._amplitude = np.where(which, amplitude, self._amplitude)

    def cancel(self, which: Booleans) -> None:
        """Leave the arm alone in the trials `which` (N,)."""
        self.phase = np.where(which, IDLE, self.phase)

    def command(self, arm_x: Array, arm_v: Array) -> Array:
        """Command voltages V_c (N,) at this tick, for the arm sensed at arm_x, arm_v (N,)."""
        past = self._direction * (arm_x - self._midpoint) >= 0.0
        self.phase = np.where((self.phase == DRIVING) & past, BRAKING, self.phase)
        speed = self._direction * arm_v
        self.phase = np.where((self.phase == BRAKING) & (speed <= 0.0), IDLE, self.phase)
        braking = self.phase == BRAKING
        strength = self._amplitude
        if self._gain is not None:
            lost = self._direction * (self._last_v - arm_v)
            ends = braking & (lost > speed)
            share = np.where(ends, speed / np.where(ends, lost, 1.0), 1.0)
            weak = np.arctanh(share * np.tanh(self._gain * strength)) / self._gain
            strength = np.where(ends, weak, strength)
        self._last_v = arm_v.copy()
        sign = np.where(braking, -self._direction, self._direction)
        return np.where(self.active, sign * strength, 0.0)
