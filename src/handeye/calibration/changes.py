"""Since when a robot has been as it is."""

import numpy as np

from handeye.calibration.combined import Combined
from handeye.calibration.session import AnyCalibrator
from handeye.observations import Observation

# How much farther the robot as it is now errs on rows from before a change that matters.
_MATTERS = 2.0


def changed_at(calibrator: AnyCalibrator, seen: Observation) -> int:
    """The first row since the last change that was noticed and matters; 0 if there is none.

    A change matters if the robot as it was learned errs more than twice as far before it as after.
    """
    events = calibrator.events if isinstance(calibrator, Combined) else ()
    since = max((e.observation for e in events if e.kind in {"change", "lost"}), default=0)
    if not since:
        return 0
    lengths = np.linalg.norm(calibrator.errors(seen), axis=1)
    return since if np.mean(lengths[:since]) > _MATTERS * np.mean(lengths[since:]) else 0


def drifts(calibrator: AnyCalibrator) -> bool:
    """Whether the robot is believed to change all the time."""
    if not isinstance(calibrator, Combined):
        return False
    engine = calibrator.engine
    return engine.settings.hypotheses[engine.leader].walk > 0.0
