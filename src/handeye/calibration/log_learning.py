"""What learns a log, all of it or some of its rows, and which of it is used in the end."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from handeye.arrays import Array, Booleans, Integers
from handeye.calibration.changes import History
from handeye.calibration.combined import Combined
from handeye.calibration.combined.settling import settle
from handeye.calibration.placed import Method, Robot, calibrator_for, place
from handeye.calibration.plant import PlanarPlant
from handeye.calibration.results import ErrorSummary, HeldOut
from handeye.calibration.session import learn_from_log
from handeye.calibration.validation import Learned
from handeye.observations import Observation

# With fewer rows since a change, frames are placed with the help of what was seen before.
_FEWEST_SINCE = 25
# Online errors of so large a part of the log, its end, are compared with held-out ones.
_LATE = 3
# Mean over standard error beyond which a difference is not chance.
_CHANCE = 2.0


class LogLearner:
    """Learns rows of a log, in order or all at once, as the method has it.

    settles: whether the method fits all rows at once in the end. history: what became of the robot,
    once that is known.
    """

    def __init__(self, robot: Robot, method: Method, seen: Observation) -> None:
        self._robot: Robot = robot
        self._method: Method = method
        self._seen: Any = seen
        self.settles = method == "combined" and not isinstance(robot, PlanarPlant)
        self.history = History()

    def learn(
        self, rows: Integers, after_each: Callable[[int], None]
    ) -> tuple[Learned, Booleans | None]:
        """Rows (M,), rising: what learned them; and which of all rows it believed, if it knows."""
        if not self.settles:
            some = self._seen[rows]
            model, _ = place(self._robot, some)
            learner = calibrator_for(model, self._method)
            learn_from_log(learner, some, after_each=after_each)
            return Learned(calibrator_for(model, "nominal"), None, learner), None
        rows = rows[rows >= self.history.first]
        now = rows[rows >= self.history.since]
        placing = self._seen[now if len(now) >= _FEWEST_SINCE else rows]
        model: Any = place(self._robot, placing)[0]
        found = settle(
            model, self._seen[rows], jumps=self.history.of(rows),
            after_each=lambda k, of: after_each(k * len(rows) // of),
        )  # fmt: skip
        after_each(len(rows))
        believed = np.ones(len(self._seen), np.bool_)
        believed[rows] = found.believed
        return Learned(calibrator_for(model, "nominal"), found.rigid, found.calibrator), believed


class Chosen(NamedTuple):
    """What is used in the end, and errors on held-out rows of what is used."""

    calibrator: Combined
    held: HeldOut | None


def chosen(found: Learned, held: HeldOut | None) -> Chosen:
    """What rows that were held out do not speak against.

    Error curves are left away where they do worse than none, beyond chance over the blocks; and
    where all does worse than the nominal robot, commands stay nominal.
    """
    whole: Any = found.whole
    if held is None or not len(held.rows) or held.rigid is None:
        return Chosen(whole, held)
    if _worse(held.after, held.rigid, held.alike):
        whole = found.rigid
        held = replace(held, after=held.rigid, turns_after=held.turns_rigid)
    if ErrorSummary.of(held.after).mean > ErrorSummary.of(held.before).mean:
        whole.falling_back = True
        held = replace(held, after=held.before, turns_after=held.turns_before)
    return Chosen(whole, held)


def follows_better(
    online: Array, held: HeldOut | None, since: int, fitted: Callable[[Integers], Array]
) -> bool:
    """Whether a robot that drifts is known better by who follows it than by a fit to all rows.

    online (N, k): errors before each row was learned, of which the late ones count; fitted: rows
    (M,) to errors (M, k) of the fit. These stand for the held-out ones where there are none, and
    flatter the fit: only a drift that no fit can hide is followed then.
    """
    late = np.arange(max(since, len(online) - len(online) // _LATE), len(online))
    others = held.after if held is not None and len(held.rows) else fitted(late)
    return ErrorSummary.of(online[late]).mean < ErrorSummary.of(others).mean


def _worse(errors: Array, others: Array, alike: Integers) -> bool:
    """Whether errors (M, k) are larger than others beyond chance, by what depends on each other."""
    more = np.linalg.norm(errors, axis=1) - np.linalg.norm(others, axis=1)
    means = np.bincount(alike, weights=more) / np.maximum(np.bincount(alike), 1)
    spread = float(means.std(ddof=1)) / np.sqrt(len(means)) if len(means) > 1 else np.inf
    return bool(means.mean() > _CHANCE * spread)
