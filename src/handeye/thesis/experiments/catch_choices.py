"""How much hangs on what the thesis leaves open (note E10), and on how late the senses report?

Sections 4.4 and 4.4.1, conclusion 8 of 5.1.2.
"""

from dataclasses import dataclass, replace

from handeye.catching.comparator import Comparator
from handeye.catching.learner import Learner
from handeye.catching.practice import train
from handeye.catching.settings import IMPROVED, THESIS, CatcherSettings
from handeye.catching.world import World
from handeye.thesis.catching import HEAVY, performance, throws_for
from handeye.thesis.experiment import Effort, Experiment, Quantities


@dataclass(frozen=True)
class Practised:
    """A learner after little practice: pursuits of the light and heavy arm, tosses of each ball."""

    settings: CatcherSettings
    pursuits: tuple[int, int] = (100, 200)
    tosses: int = 60


def practised(setting: Practised, replicate: int, effort: Effort) -> Quantities:
    """What `performance` measures with the heavy arm and ball, both known."""
    world, learner = World(), Learner(setting.settings)
    light, heavy = (effort.of(n) for n in setting.pursuits)
    train(
        learner, world, replicate, pursuits=(light, heavy), tosses=effort.of(setting.tosses),
        mentored=0,
    )  # fmt: skip
    tests = throws_for(HEAVY, HEAVY, replicate, effort)
    return performance(world, tests, learner.catcher(arm=HEAVY, ball=HEAVY))


def threshold(value: float) -> CatcherSettings:
    """With another error threshold of the motor command net [V]."""
    return replace(THESIS, motor_command=replace(THESIS.motor_command, threshold=value))


def velocity(scale: float) -> CatcherSettings:
    """With another scale of velocities in the motor command net [m/s]."""
    _, x, t = THESIS.motor_command.input_scales
    return replace(THESIS, motor_command=replace(THESIS.motor_command, input_scales=(scale, x, t)))


def time(scale: float) -> CatcherSettings:
    """With another scale of times there [s]."""
    v, x, _ = THESIS.motor_command.input_scales
    return replace(THESIS, motor_command=replace(THESIS.motor_command, input_scales=(v, x, scale)))


def amplitude(epsilon: float) -> CatcherSettings:
    """With another least amplitude of practice [V]."""
    return replace(THESIS, least_amplitude=epsilon)


def limits(factor: float) -> CatcherSettings:
    """With limits of both comparators that many times as wide."""

    def wider(comparator: Comparator) -> Comparator:
        return replace(comparator, thresholds=tuple(factor * x for x in comparator.thresholds))

    return replace(
        THESIS,
        ball_comparator=wider(THESIS.ball_comparator),
        arm_comparator=wider(THESIS.arm_comparator),
    )


CHOICES = {
    "threshold": (threshold, (0.001, 0.02, 0.1, 0.4)),
    "velocity": (velocity, (1.0, 3.3, 5.0, 20.0)),
    "time": (time, (1.0, 2.0, 5.0, 20.0)),
    "amplitude": (amplitude, (0.01, 0.05, 0.15, 0.4)),
    "limits": (limits, (0.25, 1.0, 4.0)),
}
"""What is varied, and its values; one of them is that of the thesis's learner."""

DELAYS = (0, 1, 2, 4)
"""Ticks by which all senses are late."""
DELAYED = {"thesis": THESIS, "improved": IMPROVED}

CATCH_CHOICES = Experiment(
    id="catch-choices",
    settings={
        f"{name}-{value:g}": Practised(make(value))
        for name, (make, values) in CHOICES.items()
        for value in values
    },
    measure=practised,
    replicates=6,
)

CATCH_DELAY = Experiment(
    id="catch-delay",
    settings={
        f"{name}-{ticks}": Practised(replace(settings, perceptual_delay=ticks))
        for name, settings in DELAYED.items()
        for ticks in DELAYS
    },
    measure=practised,
    replicates=6,
)
