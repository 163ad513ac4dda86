"""The thesis's practice and tests of catching, as measures for experiments (sections 4.5 to 4.8).

Quantities that end in `_20` are those of the thesis's own sequence of twenty throws; the others are
of fresh throws, many more.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import NamedTuple, cast

import numpy as np

from handeye.arrays import Array
from handeye.catching.learner import Learner
from handeye.catching.play import Controller, Recording, play
from handeye.catching.practice import train
from handeye.catching.settings import THESIS, CatcherSettings
from handeye.catching.throws import Throws, draw_throws
from handeye.catching.world import World
from handeye.randomness import stream
from handeye.thesis.experiment import Curve, Effort, Quantities

LIGHT, HEAVY = 0, 1
"""Identities of arms and balls."""
BALLS: Mapping[str, int] = {"light": LIGHT, "heavy": HEAVY}
"""By name; arms have the same names."""

SEQUENCE, FRESH = 20, 200
"""Throws of the thesis's test, and of the larger one."""
AFTERWARDS = 0.5
"""How long things are watched after a trial's end [s]."""
NEAR = 0.03
"""How far from where it ends an arm has arrived [m]."""


@dataclass(frozen=True)
class School:
    """What a learner practises.

    marks     pursuits of the heavy arm, which is tested after each of them
    light     pursuits of the light arm, before
    tosses    of each ball
    mentored  throws of each ball to the heavy arm, with the mentor's advice
    """

    settings: CatcherSettings = THESIS
    marks: tuple[int, ...] = (10, 100, 500, 1000)
    light: int = 500
    tosses: int = 200
    mentored: int = 100

    def stages(self, effort: Effort) -> dict[int, int]:
        """By mark, the pursuits that are made until then in a run of this effort."""
        return {mark: effort.of(mark, least=i) for i, mark in enumerate(self.marks, start=1)}


class ThrowSet(NamedTuple):
    """Throws to test with: the first `sequence` are the thesis's sequence, the others fresh."""

    throws: Throws
    sequence: int


def throws_for(ball: int, arm: int, replicate: int, effort: Effort) -> ThrowSet:
    """Throws that are the same, but for ball and arm, whoever is tested in a replicate."""
    sequence = effort.of(SEQUENCE)
    rng = stream("catching: test throws", replicate)
    n = sequence + effort.of(FRESH)
    return ThrowSet(draw_throws(n, rng, balls=(ball,), arms=(arm,)), sequence)


def pursue(
    school: School,
    learner: Learner,
    tests: ThrowSet,
    replicate: int,
    effort: Effort,
    *,
    light: int = 0,
) -> dict[str, float | Curve]:
    """Practise with the heavy arm, and test after every stage with one pursuit and with more.

    Gives what `performance` measures, as `pursuits_<quantity>` and `repeated_<quantity>`, curves
    over the pursuits, and in the first replicate an `example` of each stage.

    light: pursuits that were made with the light arm before.
    """
    world, stages = World(), school.stages(effort)
    found: dict[str, list[float]] = {}
    examples: dict[str, float | Curve] = {}
    for mark, made in stages.items():
        train(learner, world, replicate, pursuits=(light, made), tosses=0, mentored=0)
        for way, repeated in (("pursuits", False), ("repeated", True)):
            catcher = learner.catcher(arm=HEAVY, ball=HEAVY, repeated=repeated)
            for name, value in performance(world, tests, catcher).items():
                found.setdefault(f"{way}_{name}", []).append(value)
        if replicate == 0:
            examples |= example(str(mark), world, learner, tests)
    at = np.array(list(stages.values()), np.float64)
    return {**{name: Curve(at, np.array(values)) for name, values in found.items()}, **examples}


def performance(world: World, tests: ThrowSet, controller: Controller) -> dict[str, float]:
    """How a controller does.

    caught     share of throws
    rms, mean  of the arm's position error when the undisturbed ball would cross [m]
    early      mean time from the arm's arrival to the crossing [s]
    roughness  mean change of the command voltage from one tick to the next [V]
    """
    return summary(play(world, tests.throws, controller), tests.sequence)


def summary(recording: Recording, sequence: int) -> dict[str, float]:
    """The quantities of `performance`, of the first throws with `_20` and of the others without."""
    measured: dict[str, float] = {}
    for suffix, part in (("_20", recording[:sequence]), ("", recording[sequence:])):
        error, steps = part.position_error, np.abs(np.diff(part.voltage, axis=0))
        measured |= {
            f"caught{suffix}": float(part.caught.mean()),
            f"rms{suffix}": float(np.sqrt(np.mean(error**2))),
            f"mean{suffix}": float(error.mean()),
            f"early{suffix}": float(np.mean(part.throws.crossing_time - arrived(part))),
            f"roughness{suffix}": float(np.nanmean(steps)),
        }
    return measured


def arrived(recording: Recording) -> Array:
    """The first tick from which on each arm stays NEAR its end, or the trial's end (N,) [s]."""
    time, final = recording.sensed.time, recording.final
    away = np.abs(recording.sensed.arm_x - final.arm_x) > NEAR
    later = time > np.where(away, time, -np.inf).max(axis=0)
    return np.minimum(np.where(later, time, np.inf).min(axis=0), final.time)


def example(
    stage: str, world: World, learner: Learner, tests: ThrowSet
) -> dict[str, float | Curve]:
    """The first throw, watched until some time after its end.

    <stage>_<stream>       voltage, and arm_x, arm_v, ball_x and ball_z as they are sensed, over
                           time [s]
    <stage>_end            when the throw was over [s]
    <stage>_crossing_time  when the undisturbed ball would cross [s]
    """
    throw = tests.throws[:1]
    played = play(world, throw, learner.catcher(arm=throw.arm, ball=throw.ball), after=AFTERWARDS)
    at, sensed = played.sensed.time[:, 0], played.sensed
    streams = {name: getattr(sensed, name) for name in ("arm_x", "arm_v", "ball_x", "ball_z")}
    streams["voltage"] = played.voltage
    return {
        **{f"{stage}_{name}": Curve(at, values[:, 0]) for name, values in streams.items()},
        f"{stage}_end": float(played.final.time[0]),
        f"{stage}_crossing_time": float(throw.crossing_time[0]),
    }


def over(measured: Quantities, names: Iterable[str]) -> float:
    """The mean of some measured numbers."""
    return float(np.mean([float(cast("float", measured[name])) for name in names]))
