"""The next pose to visit."""

from dataclasses import dataclass

import numpy as np

from handeye.arrays import Array
from handeye.calibration.engine.design import task_gains
from handeye.calibration.engine.engine import Engine
from handeye.errors import InvalidInput


@dataclass(frozen=True, eq=False)
class Suggestion:
    """The pose that teaches most, and what it is expected to bring.

    joints         (q,) encoder readings [rad] or [m]
    eccentricity   where beside the hand the eye points [rad], if it can point
    before, after  uncertainty of the hand at the working points, root mean square [m]
    gains          (C,) of every candidate: mean variance that it takes away [m^2]
    best           the place of the pose among the candidates
    """

    joints: Array
    eccentricity: float
    before: float
    after: float
    gains: Array
    best: int


def best_pose(engine: Engine, poses: Array, rows: Array, tasks: Array) -> Suggestion:
    """The pose whose row (of C, w) takes away most of the variance at tasks (M, w).

    poses (C, q + 1): joints, and eccentricity.
    Raises InvalidInput for no tasks.
    """
    if not len(tasks):
        raise InvalidInput("suggest needs at least one working point")
    gains, now = task_gains(engine, tasks, rows)
    best = int(np.argmax(gains))
    return Suggestion(
        joints=poses[best, :-1].copy(),
        eccentricity=float(poses[best, -1]),
        before=float(np.sqrt(now)),
        after=float(np.sqrt(max(now - gains[best], 0.0))),
        gains=gains,
        best=best,
    )
