"""From a goal to commands: a voltage at each tick, or a profile that is triggered."""

from collections.abc import Sequence

import numpy as np

from handeye.arrays import Array, Booleans, Integers
from handeye.catching.memory import ShortTermMemory
from handeye.catching.phases import MOVING, PursuitPhases
from handeye.catching.profile import AntisymmetricProfile
from handeye.catching.settings import CatcherSettings
from handeye.catching.signals import MOTOR_COMMAND, read
from handeye.catching.skills import Skill, answers, ask, novelties

_AMPLIFIER_GAIN = 4.0
"""G_i of eq 4.3 [1/V]: the generator is innate, and knows the amplifier that it drives."""


_LEAVING = 0.05
"""Rise of the novelty, in scales, that is more than the wavering of a predicted crossing."""


class StepwiseCommands:
    """The motor command nets emit a voltage at every tick of a pursuit (figure 4.6).

    Args:
        motors: the motor command skill of each arm.
        settings: of the learner.
        n: throws.
        repeated: pursuits may follow each other.
    """

    def __init__(
        self, motors: Sequence[Skill], settings: CatcherSettings, n: int, *, repeated: bool
    ) -> None:
        self._motors = motors
        self._limits = settings.novelty_limits
        self._least_novelty = np.full(n, np.inf)
        self._phases = PursuitPhases(n, settings.rest_speed, repeated=repeated)

    @property
    def pursuing(self) -> Booleans:
        """Where (N,) a pursuit is under way."""
        return self._phases.phase == MOVING

    def command(self, memory: ShortTermMemory, arm: Integers, comprehended: Booleans) -> Array:
        """Voltages (N,) for the goal in memory; 0, the damped safe state, outside of pursuits.

        Args:
            memory: with the senses and the goal of this tick.
            arm: identities (N,), -1 unknown.
            comprehended: where the ball is (N,).
        """
        inputs = read(MOTOR_COMMAND.inputs, memory)
        voltage = answers(self._motors, arm, inputs)[:, 0]
        understood = comprehended & ~np.isnan(voltage)
        may_begin = understood
        if self._limits is not None:
            novelty = novelties(self._motors, arm, inputs)
            may_begin = self._familiar(novelty)
            understood = understood & (novelty <= self._limits[1])
        arm_v, _, remaining = inputs.T
        pursuing = self._phases.advance(understood, may_begin, arm_v, remaining)
        return np.where(pursuing, voltage, 0.0)

    def _familiar(self, novelty: Array) -> Booleans:
        """Where (N,) a pursuit is near what was practised, or is about to be ever less so."""
        leaving = novelty > self._least_novelty + _LEAVING
        self._least_novelty = np.minimum(self._least_novelty, novelty)
        near = self._limits[0] if self._limits is not None else np.inf
        return (novelty <= near) | leaving


class TriggeredProfiles:
    """The motor nets trigger the generator of pursuits, which makes the voltages (5.1.2, 3).

    A profile begins at rest, lasts until the arm stands, and is broken off if the ball is no longer
    comprehended. Repeated, another begins when the arm rests out of reach of its goal.

    Args: as of StepwiseCommands.
    """

    def __init__(
        self, motors: Sequence[Skill], settings: CatcherSettings, n: int, *, repeated: bool
    ) -> None:
        self._motors = motors
        self._settings = settings
        self._repeated = repeated
        self._profile = AntisymmetricProfile(n, input_gain=_AMPLIFIER_GAIN)
        self._done: Booleans = np.zeros(n, np.bool_)

    @property
    def pursuing(self) -> Booleans:
        """Where (N,) a pursuit is under way."""
        return self._profile.active

    def command(self, memory: ShortTermMemory, arm: Integers, comprehended: Booleans) -> Array:
        """As of StepwiseCommands."""
        profile = self._profile
        arm_x, arm_v, goal = memory.at("arm_x"), memory.at("arm_v"), memory.at("stop_x")
        wanted = ask(self._motors, arm, memory)
        understood = comprehended & ~np.isnan(wanted).any(axis=1)
        profile.cancel(profile.active & ~comprehended)
        far = np.abs(goal - arm_x) > self._settings.reach
        at_rest = np.abs(arm_v) < self._settings.rest_speed
        in_time = memory.at("stop_time") > memory.at("time")
        begins = understood & far & at_rest & in_time & ~profile.active
        begins &= ~self._done | self._repeated
        distance, amplitude = np.nan_to_num(wanted).T
        # Where there is time for a slower pursuit than was ever practised, the arm waits.
        begins &= (amplitude >= self._settings.least_amplitude) & (distance * (goal - arm_x) > 0.0)
        profile.trigger(begins, arm_x, arm_x + distance, np.minimum(amplitude, 1.0))
        self._done |= begins
        return np.nan_to_num(profile.command(arm_x, arm_v))


Commands = StepwiseCommands | TriggeredProfiles
