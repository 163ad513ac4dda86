"""Which poses to add to a log."""

from copy import deepcopy
from dataclasses import dataclass
from typing import Any

import numpy as np

from handeye.arrays import Array, count
from handeye.calibration.combined import Combined
from handeye.calibration.placed_arm import PlacedArm
from handeye.errors import InvalidInput
from handeye.observations import Target
from handeye.randomness import stream
from handeye.robots.urdf import UrdfArm

_CANDIDATES = 400
# Poses drawn to find so many in view, as a multiple, and to learn what the view is.
_DRAWN, _LOOKED = 50, 2000
# The view ends where so little of what was seen lay beyond.
_EDGE = 1.0


@dataclass(frozen=True, eq=False)
class SuggestedPoses:
    """Poses to add, the most useful first, each given the ones before.

    joints         (n, q) encoder readings [rad], or [m] of joints that slide
    eccentricity   (n,) where beside the hand the eye of the planar robot points [rad]
    before         uncertainty of the hand now, root mean square over the work [m]
    after          (n,) the same after so many of the poses
    """

    joints: Array
    eccentricity: Array
    before: float
    after: Array


def suggest_poses(
    calibrator: Combined,
    n: int,
    *,
    wider: bool = False,
    working_points: Target | None = None,
) -> SuggestedPoses:
    """The n poses that together help the work most, chosen one after the other.

    After each choice the calibrator, a copy of the one given, is shown what it expects to see
    there: its estimate stays and its uncertainty shrinks. Poses keep the joints' limits. They lie
    in the range in which the joints were when the robot was placed, or, if `wider`, anywhere
    within the limits where the marker comes into the space in which it was seen then.

    Raises:
        InvalidInput: n below 1, working points that make no sense, or no pose in view.
    """
    learner = deepcopy(calibrator)
    region = _in_view(learner, _CANDIDATES) if wider else None
    poses: list[Array] = []
    before, after = 0.0, list[float]()
    for i in range(count(n, "n")):
        best = learner.suggest(region, working_points, candidates=_CANDIDATES)
        rows = learner.robot.candidates(learner.engine.x, region, _CANDIDATES)[1]
        learner.engine.learn(rows[best.best])
        poses.append(np.append(best.joints, best.eccentricity))
        before = best.before if i == 0 else before
        after.append(best.after)
    chosen = np.array(poses)
    return SuggestedPoses(chosen[:, :-1], chosen[:, -1], before, np.array(after))


def _in_view(calibrator: Combined, n: int) -> Array | None:
    """Joints (n, q) within limits that bring the marker into the box where it was seen."""
    model: Any = calibrator.model
    if not isinstance(model, PlacedArm) or not isinstance(model.arm, UrdfArm):
        return None
    arm, rng = model.arm, stream("suggest: in view", n)
    low, high = np.maximum(model.low, arm.lower), np.minimum(model.high, arm.upper)
    worked = rng.uniform(low, high, (_LOOKED, len(low)))
    seen = np.percentile(model.placement.predict(arm, worked), [_EDGE, 100.0 - _EDGE], axis=0)
    freely = np.isinf(arm.lower) | np.isinf(arm.upper)
    low = np.where(freely, np.minimum(model.low, -np.pi), arm.lower)
    high = np.where(freely, np.maximum(model.high, np.pi), arm.upper)
    joints = rng.uniform(low, high, (_DRAWN * n, len(low)))
    places = model.placement.predict(arm, joints)
    inside = np.all((places > seen[0]) & (places < seen[1]), axis=1)
    if not inside.any():
        raise InvalidInput(
            f"{arm.name}: no other pose brings the marker to where it was seen; leave out --wider"
        )
    return joints[inside][:n]
