"""How well a calibrator does on rows that it has not learned."""

from collections.abc import Callable
from typing import Any

import numpy as np

from handeye.arrays import Array, Integers
from handeye.calibration.arm.residuals import misfit
from handeye.calibration.arm.robot import ArmRobot
from handeye.calibration.combined import Combined
from handeye.calibration.placed_arm import PlacedArm
from handeye.calibration.results import HeldOut, Validation
from handeye.calibration.session import AnyCalibrator
from handeye.errors import InvalidInput
from handeye.observations import Observation, PointObservation
from handeye.randomness import stream

BLOCKS = 5
"""Contiguous blocks in time, each left out once."""

Learn = Callable[[Observation, Callable[[int], None]], tuple[AnyCalibrator, AnyCalibrator]]
"""Observations, and what to call with the number learned so far; returns a calibrator with nothing
but frames placed, and one that learned."""


def left_out(n: int, how: Validation, *, replicate: int = 0, since: int = 0) -> list[Integers]:
    """The rows (M,) of 0 ... n - 1 that are left out at a time, none before `since`.

    blocks: five contiguous fifths, each once. random: a third, which `replicate` chooses. none:
    nothing.

    Raises:
        InvalidInput: another word.
    """
    rows = np.arange(since, n)
    match how:
        case "blocks":
            return [part for part in np.array_split(rows, BLOCKS) if len(part)]
        case "random":
            order = stream("held out", replicate).permutation(len(rows))
            return [rows[np.sort(order[: len(rows) // 3])]]
        case "none":
            return []
    raise InvalidInput(f"validation must be blocks, random or none, got {how!r}")


def to_learn(n: int, parts: list[Integers]) -> int:
    """Rows learned in all when each part is left out once."""
    return sum(n - len(part) for part in parts)


def held_out(
    seen: Observation,
    parts: list[Integers],
    how: Validation,
    learn: Learn,
    whole: AnyCalibrator,
    *,
    since: int = 0,
    after_each: Callable[[int], None],
) -> HeldOut | None:
    """Leave out each part of the rows in turn, learn the others in order, and test on the part.

    whole is the calibrator that has learned everything: by how much its predictions differ, at the
    rows from `since` on, from those of the calibrators that lack a part, says how much hangs on
    the part.
    """
    if not parts:
        return None
    n, done = len(seen), 0
    everything: Any = seen
    error = whole.errors(everything[since:])
    errors: list[tuple[Array, Array]] = []
    turns: list[tuple[Array | None, Array | None]] = []
    moves: list[float] = []
    for part in parts:
        others = np.setdiff1d(np.arange(n), part)
        start = done
        bare, learner = learn(everything[others], lambda k, start=start: after_each(start + k))
        done += len(others)
        test = everything[part]
        errors.append((bare.errors(test), learner.errors(test)))
        turns.append((turn_errors(bare, test), turn_errors(learner, test)))
        apart = learner.errors(everything[since:]) - error
        moves.append(float(np.linalg.norm(apart, axis=1).mean()))
    rows = np.concatenate(parts)
    order = np.argsort(rows)
    before, after = (np.concatenate(each)[order] for each in zip(*errors, strict=True))
    turned = [
        np.concatenate([t for t in each if t is not None])[order] if each[0] is not None else None
        for each in zip(*turns, strict=True)
    ]
    which = np.repeat(np.arange(len(parts)), [len(part) for part in parts])
    return HeldOut(
        rows[order], before, after, which[order], how, turned[0], turned[1], np.array(moves)
    )


def turn_errors(calibrator: AnyCalibrator, seen: Observation) -> Array | None:
    """Turns (N, 3) [rad] from predicted to measured orientations; None where there are none."""
    model: Any = getattr(calibrator, "model", None)
    if not isinstance(model, PlacedArm) or not isinstance(seen, PointObservation):
        return None
    if not isinstance(calibrator, Combined) or not isinstance(calibrator.robot, ArmRobot):
        return model.turn_errors(seen)
    kernel, x = calibrator.robot.kernel, calibrator.engine.x
    if not kernel.oriented or seen.orientation is None:
        return None
    x = np.zeros_like(x) if calibrator.falling_back else x
    values, slopes = np.empty((len(seen), 6)), np.empty((6, len(x)))
    for row, value in zip(calibrator.robot.seen_rows(seen), values, strict=True):
        misfit(kernel, x, row, value, slopes)
    return values[:, 3:]
