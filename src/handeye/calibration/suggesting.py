"""Which poses to add to a log."""

from copy import deepcopy
from dataclasses import dataclass
from typing import Any

import numpy as np

from handeye.arrays import Array, count
from handeye.calibration.combined import Combined
from handeye.calibration.placed_arm import PlacedArm
from handeye.calibration.view import View
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
    view: View | None = None,
    working_points: Target | None = None,
) -> SuggestedPoses:
    """The n poses that together help the work most, chosen one after the other.

    After each choice the calibrator, a copy of the one given, is shown what it expects to see
    there: its estimate stays and its uncertainty shrinks. Poses keep the joints' limits. They lie
    in the range in which the joints were when the robot was placed, or, if `wider`, anywhere
    within the limits where the marker comes into the space in which it was seen then. With a
    `view` the marker is also where, and turned as, the sensor can see it, and the space in which it
    was seen before does not count.

    Raises:
        InvalidInput: n below 1, working points that make no sense, or no pose in view.
    """
    learner = deepcopy(calibrator)
    region = _region(learner, _CANDIDATES, view, wider=wider)
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


def _region(calibrator: Combined, n: int, view: View | None, *, wider: bool) -> Array | None:
    """Joints (n, q) to choose from; None where the robot's own working range will do."""
    model: Any = calibrator.model
    if not isinstance(model, PlacedArm) or not isinstance(model.arm, UrdfArm):
        if view is not None:
            raise InvalidInput("a view is for arms in space: the planar robot's eye turns")
        return None
    if view is None and not wider:
        return None
    arm, rng = model.arm, stream("suggest: in view", n)
    worked = np.maximum(model.low, arm.lower), np.minimum(model.high, arm.upper)
    low, high = _limits(model) if wider else worked
    joints = rng.uniform(low, high, (_DRAWN * n, len(low)))
    if view is not None:
        inside = view.sees(model, joints)
    else:
        drawn = model.placement.predict(arm, rng.uniform(*worked, (_LOOKED, len(low))))
        seen = np.percentile(drawn, [_EDGE, 100.0 - _EDGE], axis=0)
        places = model.placement.predict(arm, joints)
        inside = np.all((places > seen[0]) & (places < seen[1]), axis=1)
    if not inside.any():
        if view is None:
            raise InvalidInput(
                f"{arm.name}: no other pose brings the marker to where it was seen; leave out "
                "--wider"
            )
        raise InvalidInput(
            f"{arm.name}: none of {len(joints)} poses tried has the marker in view; check angles, "
            "distances and that the sensor looks along its z axis"
            + ("" if wider else ", or look beyond the working range with --wider")
        )
    return joints[inside][:n]


def _limits(model: PlacedArm) -> tuple[Array, Array]:
    """Of the joints; those without any turn half a turn either way, or as far as they did."""
    low, high = model.arm.lower, model.arm.upper
    freely = np.isinf(low) | np.isinf(high)
    return (
        np.where(freely, np.minimum(model.low, -np.pi), low),
        np.where(freely, np.maximum(model.high, np.pi), high),
    )
