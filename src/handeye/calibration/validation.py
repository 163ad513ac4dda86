"""How well a calibrator does on rows that it has not learned."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from handeye.arrays import Array, Integers
from handeye.calibration.arm.residuals import misfit
from handeye.calibration.arm.robot import ArmRobot
from handeye.calibration.combined import Combined
from handeye.calibration.expected import expected_at_rows
from handeye.calibration.placed_arm import PlacedArm
from handeye.calibration.results import HeldOut, Validation
from handeye.calibration.session import AnyCalibrator
from handeye.errors import InvalidInput
from handeye.observations import Observation, PointObservation
from handeye.randomness import stream

BLOCKS = 5
"""Contiguous blocks in time, each left out once."""


class Learned(NamedTuple):
    """Calibrators from the same rows: with frames placed, without error curves, and with all.

    The second is None where there are no curves that it could lack.
    """

    placed: AnyCalibrator
    rigid: AnyCalibrator | None
    whole: AnyCalibrator


Learn = Callable[[Integers, Callable[[int], None]], Learned]
"""Rows to learn, rising, and what to call with the number learned so far."""


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
    tried: list[tuple[AnyCalibrator, ...]] = []
    moves: list[float] = []
    for part in parts:
        others = np.setdiff1d(np.arange(n), part)
        start = done
        learned = learn(others, lambda k, start=start: after_each(start + k))
        done += len(others)
        tried.append(tuple(c for c in learned if c is not None))
        apart = learned.whole.errors(everything[since:]) - error
        moves.append(float(np.linalg.norm(apart, axis=1).mean()))
    rows = np.concatenate(parts)
    order = np.argsort(rows)
    stages = [
        _judged(calibrators, everything, parts, order) for calibrators in zip(*tried, strict=True)
    ]
    which = np.repeat(np.arange(len(parts)), [len(part) for part in parts])
    before, after = stages[0], stages[-1]
    rigid = stages[1] if len(stages) > 2 else (None, None)
    return HeldOut(
        rows[order], before[0], after[0], which[order], how, before[1], after[1],
        np.array(moves), rigid[0], rigid[1], _expected([t[-1] for t in tried], seen, parts, order),
    )  # fmt: skip


def _expected(
    calibrators: list[AnyCalibrator], seen: Any, parts: list[Integers], order: Integers
) -> Array | None:
    """How far each row of all parts was expected to be off, by its own calibrator."""
    pairs = zip(calibrators, parts, strict=True)
    sizes = [expected_at_rows(calibrator, seen[part]) for calibrator, part in pairs]
    known = [size for size in sizes if size is not None]
    return np.concatenate(known)[order] if len(known) == len(sizes) else None


def _judged(
    calibrators: tuple[AnyCalibrator, ...], seen: Any, parts: list[Integers], order: Integers
) -> tuple[Array, Array | None]:
    """Errors and turns of the rows of all parts, each by its own calibrator."""
    pairs = list(zip(calibrators, parts, strict=True))
    errors = [calibrator.errors(seen[part]) for calibrator, part in pairs]
    turns = [turn_errors(calibrator, seen[part]) for calibrator, part in pairs]
    known = [turn for turn in turns if turn is not None]
    turned = np.concatenate(known)[order] if len(known) == len(turns) else None
    return np.concatenate(errors)[order], turned


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
