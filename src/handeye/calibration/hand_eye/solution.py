"""Hand-eye and robot-world calibration from nothing but pairs of poses."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import least_squares

from handeye.arrays import Array, shaped
from handeye.calibration.hand_eye.beliefs import Mounting, Tolerances
from handeye.calibration.hand_eye.directions import Directions, directions
from handeye.calibration.hand_eye.links import Links
from handeye.calibration.hand_eye.mistakes import Reading, mistakes
from handeye.calibration.hand_eye.model import Guess, Model, motions
from handeye.calibration.hand_eye.refinement import Fit, Refinement
from handeye.calibration.hand_eye.result import HandEye
from handeye.calibration.hand_eye.samples import Samples, Setup
from handeye.calibration.hand_eye.starts import starts
from handeye.calibration.hand_eye.summary import summary
from handeye.calibration.hand_eye.turns import turned_by
from handeye.errors import InvalidInput
from handeye.robots.arm import Arm

# What is open is looked for where the fit ends, and the fit starts again without it, this often.
_LOOKS = 3


def solve(
    flanges: ArrayLike,
    sensed: ArrayLike,
    *,
    setup: Setup = "eye_in_hand",
    free_scale: bool = False,
    odometry: bool = False,
    mounting: Mounting | None = None,
) -> HandEye:
    """Where camera and target sit, from N >= 3 pairs of poses in any order.

    flanges T_base_flange (N, 4, 4), sensed T_camera_target (N, 4, 4) [m].

    Closed forms and a consensus among triples of samples (`starts`) begin; from each the likelihood
    of all samples is climbed, with errors of camera and arm as large as the samples say (`noise`)
    and wrong samples recognised (`robust`). The best fit counts. What the samples do not determine
    stays at `mounting`, and `HandEye.status` names it and says which poses to add.

    free_scale: the camera knows no metres. odometry: the camera stands on the flange and counts its
    way from pose to pose, so that its errors add up: the order of samples matters then, and
    residuals are those of the N - 1 motions.

    Raises:
        InvalidInput: for arrays that are no poses, do not pair up, or are fewer than three.
    """
    samples = Samples.of(flanges, sensed, setup, in_order=odometry)
    if odometry and setup != "eye_in_hand":
        raise InvalidInput("only a camera that moves can count its way: use setup='eye_in_hand'")
    model = Model(motions(samples) if odometry else samples, free_scale)
    refinement = Refinement(model, Tolerances(), tied=odometry)
    begin = starts(model.samples, free_scale=free_scale, tied=odometry)
    return _finished(samples, refinement, begin, mounting or Mounting())


def solve_arm(
    arm: Arm,
    joints: ArrayLike,
    sensed: ArrayLike,
    *,
    setup: Setup = "eye_in_hand",
    tolerances: Tolerances | None = None,
    mounting: Mounting | None = None,
) -> HandEye:
    """As `solve`, with the errors of the arm itself among the unknowns.

    joints (N, n) [rad] or [m] instead of flanges. Each link may depart from the arm's model
    (`links.Links`) by as much as `tolerances` and the samples allow together, and every reading of
    a joint may err.

    Raises:
        InvalidInput: as `solve`, or for joints of another shape.
    """
    q = shaped(joints, (None, len(arm.joint_names)), "joints")
    samples = Samples.of(arm.poses(q), sensed, setup, in_order=False)
    rigid = Refinement(Model(samples), Tolerances())
    best = _best(rigid, starts(samples, free_scale=False, tied=False))
    model = Model(samples, links=Links.of(arm, q[samples.order]))
    departures = np.tile(np.eye(4), (q.shape[1] - 1, 1, 1))
    begin = replace(best.guess, links=departures)
    refinement = Refinement(model, tolerances or Tolerances())
    in_degrees = Reading("joints are in degrees", arm.poses(np.radians(q)), np.asarray(sensed))
    return _finished(samples, refinement, [begin], mounting or Mounting(), in_degrees)


def _finished(
    samples: Samples,
    refinement: Refinement,
    begin: Sequence[Guess],
    mounting: Mounting,
    *others: Reading,
) -> HandEye:
    fit = _best(refinement, begin)
    found = directions(refinement, fit)
    for _ in range(_LOOKS):
        if not found.open.shape[1]:
            break
        guess = _at_mounting(samples.setup, fit.guess, found, mounting)
        fit = refinement.fit(guess, found.closed)
        found = directions(refinement, fit)
    suspected = () if refinement.tied else mistakes(samples, fit.guess, *others)
    return summary(samples, refinement, fit, found, mounting, suspected)


def _best(refinement: Refinement, begin: Sequence[Guess]) -> Fit:
    """The fit from the start that promises most after a few rounds."""
    fits = [refinement.fit(guess, rounds=_LOOKS) for guess in begin]
    return refinement.fit(max(fits, key=lambda fit: fit.log_likelihood).guess)


def _at_mounting(setup: Setup, guess: Guess, found: Directions, mounting: Mounting) -> Guess:
    """The guess moved along what is open to where the mounting is met best."""

    def off(z: Array) -> Array:
        here = guess.moved(found.open @ z)
        X = here.camera if setup == "eye_in_hand" else here.target
        turn = turned_by(X[:3, :3] @ mounting.pose[:3, :3].T) / mounting.turn_std
        shift = (X[:3, 3] - mounting.pose[:3, 3]) / mounting.position_std
        growth = np.log(here.scale)
        return np.concatenate([turn, shift, [growth]])

    nearest = least_squares(off, np.zeros(found.open.shape[1]), xtol=1e-10)
    return guess.moved(found.open @ nearest.x)
