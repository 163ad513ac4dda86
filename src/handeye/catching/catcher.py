"""The catching mode: from what is sensed at a tick to the command of the next (section 4.4.2)."""

import numpy as np

from handeye.arrays import Array, Booleans, Integers
from handeye.catching.commands import StepwiseCommands, TriggeredProfiles
from handeye.catching.memory import ShortTermMemory
from handeye.catching.recognition import UNKNOWN
from handeye.catching.repertoire import Repertoire
from handeye.catching.settings import CatcherSettings
from handeye.catching.signals import GOALS, SENSES
from handeye.catching.skills import ask
from handeye.catching.understanding import Understanding, discrepancy_streams
from handeye.catching.world import Sensed

_DEPTH = 12
"""Ticks remembered: the comparators look back ten, the recognition nets six."""


class Catcher:
    """Watches N throws and commands N arms with what was learned; learns nothing itself.

    A controller in the sense of `handeye.catching.play`.

    Args:
        repertoire: the learned networks; they must not change during a trial.
        settings: of the learner.
        arm: identities believed at the start, one for all throws or (N,); UNKNOWN (-1).
        ball: the same of balls.
        repeated: pursuits may follow each other.
    """

    def __init__(
        self,
        repertoire: Repertoire,
        settings: CatcherSettings,
        arm: int | Integers,
        ball: int | Integers,
        *,
        repeated: bool,
    ) -> None:
        self._repertoire = repertoire
        self._settings = settings
        self._believed = (arm, ball)
        self._repeated = repeated
        self.begin(1 if np.ndim(arm) == np.ndim(ball) == 0 else max(np.size(arm), np.size(ball)))

    def begin(self, n: int) -> None:
        """Forget the last trials and expect n throws."""
        own, settings = self._repertoire, self._settings
        arm, ball = (np.broadcast_to(np.asarray(b, np.int64), n) for b in self._believed)
        streams = (
            *SENSES, "voltage", "command", *GOALS,
            *discrepancy_streams("ball", len(own.ball_states)),
            *discrepancy_streams("arm", len(own.arm_states)),
        )  # fmt: skip
        self._memory = ShortTermMemory(streams, _DEPTH, n, settings.delays)
        self._ball = Understanding(
            "ball", own.ball_states, own.ball_recogniser, settings.ball_comparator, ball,
            try_all=settings.try_all,
        )  # fmt: skip
        self._arm = Understanding(
            "arm", own.arm_states, own.arm_recogniser, settings.arm_comparator, arm,
            try_all=settings.try_all,
        )  # fmt: skip
        kind = TriggeredProfiles if settings.profiles else StepwiseCommands
        self._commands = kind(own.motors, settings, n, repeated=self._repeated)
        self._ticks = 0
        self._confirmed: Booleans = np.zeros(n, np.bool_)

    def act(self, sensed: Sensed) -> Array:
        """Commands (N,) for the step that begins now.

        0, the damped safe state, where there is nothing to do or nothing is understood.
        """
        memory = self._memory
        memory.tick()
        for stream in SENSES:
            memory.record(stream, np.where(sensed.active, getattr(sensed, stream), np.nan))
        self._ball.judge(memory)
        self._arm.judge(memory)
        self._aim()
        command = self._commands.command(memory, self._commanded(), self._ball.comprehended)
        command = np.where(sensed.active, self._excite(command), 0.0)
        memory.record("voltage", command)
        memory.record("command", command)
        self._ball.expect(memory)
        self._arm.expect(memory)
        return command

    def traces(self) -> dict[str, Array]:
        """What it thinks at the last tick, name -> (N,).

        ball, arm                          believed identities, -1 unknown
        ball_comprehended, arm_comprehended  flags
        ball_surprise, arm_surprise        1 and more is surprised; NaN without enough data
        crossing_x, crossing_time          where and when the ball is expected to cross [m], [s]
        correction_x, correction_time      of target and arrival [m], [s]
        stop_x, stop_time                  where and when the arm is to arrive [m], [s]
        pursuing                           whether a pursuit is under way
        """
        memory = self._memory
        return {
            "ball": self._ball.identity.astype(float),
            "arm": self._arm.identity.astype(float),
            "ball_comprehended": self._ball.comprehended.astype(float),
            "arm_comprehended": self._arm.comprehended.astype(float),
            "ball_surprise": self._ball.surprise.copy(),
            "arm_surprise": self._arm.surprise.copy(),
            **{name: memory.at(name).copy() for name in GOALS if name != "crossing_vx"},
            "pursuing": self._commands.pursuing.astype(float),
        }

    def _aim(self) -> None:
        """Predict the crossing, correct it, and make it the arm's goal (figure 4.6)."""
        memory, own = self._memory, self._repertoire
        crossing = ask(own.crossings, self._ball.identity, memory)
        memory.record("crossing_vx", crossing[:, 0])
        memory.record("crossing_time", memory.at("time") + crossing[:, 1])
        memory.record("crossing_x", memory.at("ball_x") + crossing[:, 2])
        correction = ask(own.corrections, self._commanded(), memory)
        memory.record("correction_x", correction[:, 0])
        memory.record("correction_time", correction[:, 1])
        memory.record("stop_x", memory.at("crossing_x") + correction[:, 0])
        arrival = memory.at("crossing_time") + correction[:, 1] - self._settings.lead
        if self._repeated:
            # Who is there early may pursue once more, until the ball comes.
            arrival = np.where(arrival > memory.at("time"), arrival, memory.at("crossing_time"))
        memory.record("stop_time", arrival)

    def _commanded(self) -> Integers:
        """Whose nets move each arm (N,): of who it is or was last taken for, else the first.

        An arm that is not moved is never recognised (footnote 10).
        """
        return np.where(self._arm.latest == UNKNOWN, 0, self._arm.latest)

    def _excite(self, command: Array) -> Array:
        """Move each arm to and fro, and once more where the response did not show which it is.

        Two ticks towards the ball and two back, which leave it nearly at rest: an arm that is not
        moved can be neither recognised nor found to be another than believed. Who has never
        practised with any arm has nothing to find out.
        """
        practised = any(motor.network.n_neurons for motor in self._repertoire.motors)
        if self._settings.excitation == 0.0 or not practised or self._ticks == 8:
            return command
        if self._ticks == 4:
            self._confirmed |= self._arm.comprehended
        sign = 1.0 if self._ticks % 4 < 2 else -1.0
        self._ticks += 1
        toward = np.sign(self._memory.at("ball_x") - self._memory.at("arm_x"))
        shake = sign * self._settings.excitation * np.nan_to_num(toward)
        return np.where(self._confirmed, command, shake)
