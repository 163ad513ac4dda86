"""A calibrator at work: test, then train, over a simulated world or a log."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from handeye.arrays import Array, Booleans, Integers, count
from handeye.calibration.calibrator import Calibrator, Feedback
from handeye.calibration.world import PlanarWorld
from handeye.errors import InvalidInput
from handeye.observations import Observation
from handeye.randomness import stream

AnyCalibrator = Calibrator[Any, Any]

AfterEach = Callable[[int], None]
"""Called between steps with the observations learned so far: shows progress, saves a checkpoint."""


def ignore(done: int) -> None:
    """Neither shows nor saves anything."""


@dataclass(frozen=True)
class WorldStreams:
    """Where a session's poses and noise come from, training and testing apart.

    Every method that is given the streams of the same replicate meets the same world.
    """

    train_poses: np.random.Generator
    train_noise: np.random.Generator
    test_poses: np.random.Generator
    test_noise: np.random.Generator

    @classmethod
    def of(cls, replicate: int) -> Self:
        """The streams of a replicate, from their beginning."""
        names = ("train poses", "train noise", "test poses", "test noise")
        return cls(*(stream(f"world: {name}", replicate) for name in names))


@dataclass(frozen=True)
class LearningCurve:
    """Performance after so many training trials, each measured on fresh poses (section 3.4.6).

    trials (M,), mean (M,) of the position error [m] (eq 3.43), std (M,) its sample standard
    deviation (eq 3.44), uncorrected (M,) the mean error of `baseline` on the same poses,
    neurons (M,) allocated since the first mark.
    """

    trials: Integers
    mean: Array
    std: Array
    uncorrected: Array
    neurons: Integers


def position_errors(
    world: PlanarWorld, calibrators: list[AnyCalibrator], trial: int, streams: WorldStreams, n: int
) -> list[Array]:
    """Error vectors (n, 2) [m] of the hand sent to where it was seen, for each calibrator.

    Where it really was minus where the command really brings it, at n random poses that are the
    same for all, with the plant as it is at `trial`.
    """
    trials = np.full(n, trial)
    seen = world.observe(trials, streams.test_poses, streams.test_noise)
    was = world.tips(seen.joints, trials)
    return [was - world.tips(c.command(seen.target), trials) for c in calibrators]


def learn_in_world(
    world: PlanarWorld,
    calibrator: AnyCalibrator,
    baseline: AnyCalibrator,
    streams: WorldStreams,
    *,
    trials: int = 5000,
    every: int = 100,
    tests: int = 1000,
    start: int = 0,
    after_each: AfterEach = ignore,
) -> LearningCurve:
    """Alternate training and measurement (section 3.4.6): the thesis's performance test.

    Measures at trial `start`, then after every `every` training trials, with the plant as it was
    in the last of them. Learning is off while `tests` fresh poses are measured. The baseline,
    usually Nominal, is measured on the same poses.
    A session goes on where another ended when it is given its streams and its last trial: it learns
    what one long session would, but where they meet both measure, so that later tests fall on
    other poses.
    """
    count(tests, "tests", least=2)  # a sample standard deviation needs two
    marks = [*range(start, start + count(trials, "trials"), count(every, "every")), start + trials]
    rows: list[tuple[int, float, float, float, int]] = []
    neurons = 0
    for now, following in zip(marks, [*marks[1:], None], strict=True):
        corrected, uncorrected = position_errors(
            world, [calibrator, baseline], max(now - 1, start), streams, tests
        )
        lengths = np.linalg.norm(corrected, axis=1)
        nominal = np.linalg.norm(uncorrected, axis=1)
        rows.append((now, lengths.mean(), lengths.std(ddof=1), nominal.mean(), neurons))
        if following is not None:
            seen = world.observe(
                np.arange(now, following), streams.train_poses, streams.train_noise
            )
            neurons += int(calibrator.observe_many(seen).allocated.sum())
            after_each(following)
    columns = [np.array(column) for column in zip(*rows, strict=True)]
    return LearningCurve(*columns)


def learn_from_log(
    calibrator: AnyCalibrator,
    observations: Observation,
    *,
    every: int = 100,
    after_each: AfterEach = ignore,
) -> Feedback:
    """Run over recorded observations in order, each tested before it is learned.

    Returns the error (N, k) [m] before learning and what was allocated, for all N.

    Raises:
        InvalidInput: no observations.
    """
    if len(observations) == 0:
        raise InvalidInput("there are no observations to learn from")
    errors: list[Array] = []
    allocated: list[Booleans] = []
    for first in range(0, len(observations), count(every, "every")):
        part = observations[first : first + every]
        feedback = calibrator.observe_many(part)
        errors.append(feedback.error)
        allocated.append(feedback.allocated)
        after_each(first + len(part))
    return Feedback(np.concatenate(errors), np.concatenate(allocated))
