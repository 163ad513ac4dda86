"""Since when a robot has been as it is, and what it was before."""

from typing import NamedTuple

import numpy as np

from handeye.arrays import Integers
from handeye.calibration.arm.log_system import Jump
from handeye.calibration.combined import Combined, Event
from handeye.calibration.hindsight import look_back
from handeye.calibration.placed_arm import PlacedArm
from handeye.calibration.session import AnyCalibrator
from handeye.observations import Observation, PointObservation

# How much farther the robot as it is now errs on rows from before a change that matters.
_MATTERS = 2.0
# Changes of the past that are told apart, the latest.
_MOST = 8


class History(NamedTuple):
    """What became of a robot during a log.

    since  the first row since the last change that matters; 0 if there is none
    first  the first row that tells anything of the robot as it is now
    jumps  parts that were others before a row, from `first` on
    events the same for a person
    """

    since: int = 0
    first: int = 0
    jumps: tuple[Jump, ...] = ()
    events: tuple[Event, ...] = ()

    def of(self, rows: Integers) -> tuple[Jump, ...]:
        """The jumps where rows (M,), rising and none before `first`, are all there is."""
        return tuple(
            Jump(at, jump.places)
            for jump in self.jumps
            if 0 < (at := int(np.searchsorted(rows, jump.at))) < len(rows)
        )


def history(calibrator: AnyCalibrator, seen: Observation) -> History:
    """What a calibrator has noticed while it learned rows in the order of time.

    A change matters if the robot as it was learned errs more than twice as far before it as after.
    """
    told = calibrator.events if isinstance(calibrator, Combined) else ()
    events = tuple(e for e in told if e.kind in {"change", "lost"})
    since = max((e.observation for e in events), default=0)
    if not since or not isinstance(calibrator, Combined):
        return History()
    lengths = np.linalg.norm(calibrator.errors(seen), axis=1)
    if np.median(lengths[:since]) <= _MATTERS * np.median(lengths[since:]):
        return History()
    first = max((e.observation for e in events if e.kind == "lost"), default=0)
    places = {change.words: change.places for change in calibrator.engine.chain.changes}
    jumps = [
        Jump(e.observation, places[e.part])
        for e in events
        if e.kind == "change" and e.observation > first and e.part in places
    ]
    return History(since, first, tuple(jumps[-_MOST:]), events)


def in_hindsight(live: History, model: PlacedArm, seen: PointObservation) -> History:
    """What became of an arm as all its rows show it, or, if they show nothing, as it was noticed.

    Only all rows tell of a change in the first ones, and where exactly a change was.
    """
    found = look_back(model, seen)
    if not found.jumps:
        return live
    return History(found.jumps[-1].at, 0, found.jumps, found.events)


def drifts(calibrator: AnyCalibrator) -> bool:
    """Whether the robot is believed to change all the time."""
    return isinstance(calibrator, Combined) and calibrator.engine.drifting
