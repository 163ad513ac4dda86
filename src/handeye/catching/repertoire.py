"""All networks of a learner: per ball two, per arm three, and two that recognise."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Self

from handeye.catching import signals
from handeye.catching.recognition import Recogniser
from handeye.catching.settings import CatcherSettings, Tuning
from handeye.catching.skills import Skill


@dataclass(frozen=True)
class Repertoire:
    """What a learner can do; lists are indexed by identity."""

    ball_recogniser: Recogniser
    ball_states: list[Skill]
    crossings: list[Skill]
    arm_recogniser: Recogniser
    arm_states: list[Skill]
    motors: list[Skill]
    corrections: list[Skill]

    @classmethod
    def empty(cls, settings: CatcherSettings, n_balls: int, n_arms: int) -> Self:
        """Nothing learned yet."""

        def each(table: signals.Table, tuning: Tuning, number: int) -> list[Skill]:
            return [Skill(table, tuning) for _ in range(number)]

        motor = signals.PROFILE if settings.profiles else signals.MOTOR_COMMAND
        return cls(
            Recogniser(
                signals.BALL_RECOGNITION,
                settings.ball_recognition,
                settings.ball_threshold,
                n_balls,
            ),
            each(signals.BALL_STATE, settings.ball_state, n_balls),
            each(signals.BALL_CROSSING, settings.ball_crossing, n_balls),
            Recogniser(
                signals.ARM_RECOGNITION, settings.arm_recognition, settings.arm_threshold, n_arms
            ),
            each(signals.ARM_STATE, settings.arm_state, n_arms),
            each(motor, settings.motor_command, n_arms),
            each(signals.CATCH_CORRECTION, settings.catch_correction, n_arms),
        )

    def skills(self) -> Iterator[tuple[str, Skill]]:
        """Every skill with a name: "ball_states.0", "motors.1", "ball_recogniser"."""
        yield "ball_recogniser", self.ball_recogniser.skill
        yield "arm_recogniser", self.arm_recogniser.skill
        for name in ("ball_states", "crossings", "arm_states", "motors", "corrections"):
            for identity, skill in enumerate(getattr(self, name)):
                yield f"{name}.{identity}", skill
