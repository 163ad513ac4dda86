"""An arm from all rows of a log at once, as a calibrator that goes on from there."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.linalg import cho_factor, cho_solve, cholesky

from handeye.arrays import Array, Booleans, Integers
from handeye.calibration.arm.description import ends_of
from handeye.calibration.arm.estimator import FINE
from handeye.calibration.arm.evidence import Posterior, solve
from handeye.calibration.arm.kernels import joint_at
from handeye.calibration.arm.log_system import Jump, LogSystem
from handeye.calibration.arm.robot import ArmRobot
from handeye.calibration.arm.sheet import ArmSheet, ChosenTerms, CurveTerms
from handeye.calibration.arm.student import FREEDOM, OF_NORMAL
from handeye.calibration.combined.calibrator import Combined
from handeye.calibration.placed_arm import PlacedArm
from handeye.observations import PointObservation

# A row that counts less than this is not believed.
_DOUBTFUL = 0.1
# Least share of the variance of orientations that is the sensor's own.
_OWN_TURN = 0.25

_NONE = CurveTerms(0, 0)

AfterEach = Callable[[int, int], None]
"""Called with rounds done and rounds at most."""


class Settled(NamedTuple):
    """What all rows say: the calibrator, and one without error curves beside it.

    believed (N,): rows that count.
    """

    calibrator: Combined
    rigid: Combined
    believed: Booleans


def settle(
    model: PlacedArm,
    seen: PointObservation,
    sheet: ArmSheet | None = None,
    *,
    jumps: Sequence[Jump] = (),
    after_each: AfterEach | None = None,
) -> Settled:
    """Fit an arm to N rows in the order of time, whatever that order, as `ArmEstimator` does.

    First without error curves; from there with curves as fine as `FINE`. Those that the evidence
    leaves are the curves of the calibrator, which starts with what is known of them as its prior,
    and learns from there. A part that changed, one of `jumps`, was another before its row; what is
    stated is how it is now. Between jumps the rows are taken in an order of their own, so that the
    same rows in another order give the same result, to the last bit.

    Args:
        model: nominal kinematics, placed.
        seen: what was observed.
        sheet: how far the arm may be from nominal; the default is `ArmSheet`. Its curves do not
            count, except that a sheet without any has none here.
        jumps: in the order of time.
        after_each: called after every round of the second fit.
    """
    sheet = sheet or ArmSheet()
    order = _own_order(seen, jumps)
    stiff = replace(sheet, curves=_NONE)
    system, start = _fitted(model, seen[order], stiff, jumps)
    rigid = _calibrator(model, stiff, system, start)
    if sheet.curves == _NONE:
        return Settled(rigid, rigid, _believed(order, start))
    fine = replace(sheet, curves=FINE)
    system, found = _fitted(model, seen[order], fine, jumps, start.x, after_each)
    return Settled(_calibrator(model, fine, system, found), rigid, _believed(order, found))


def _fitted(
    model: PlacedArm,
    seen: PointObservation,
    sheet: ArmSheet,
    jumps: Sequence[Jump],
    near: Array | None = None,
    after_each: AfterEach | None = None,
) -> tuple[LogSystem, Posterior]:
    robot = ArmRobot(model, sheet)
    rows = robot.seen_rows(seen)
    system = LogSystem(robot.kernel, robot.chain.tolerance, rows, jumps)
    start = np.zeros(len(system.tolerance))
    if near is not None:
        # Unknowns of curves stand between those of the arm and those of jumps.
        constants = joint_at(robot.kernel, len(robot.kernel.slides))
        start[:constants] = near[:constants]
        start[system.n_arm :] = near[constants:]
    return system, solve(system, after_each, start)


def _calibrator(model: PlacedArm, sheet: ArmSheet, system: LogSystem, found: Posterior) -> Combined:
    """With the curves that were found, and what is known as the prior of what comes."""
    kernel, n = system.kernel, system.n_arm
    constants = joint_at(kernel, len(kernel.slides))
    kept = found.used[constants:n].reshape(-1, 2).all(axis=1)
    wanted = np.concatenate(
        [np.ones(constants, np.bool_), np.repeat(kept, 2), np.ones(len(found.x) - n, np.bool_)]
    )
    noise = float(found.noise[0]) / OF_NORMAL
    turn = model.turn_std
    if kernel.oriented:
        own = (found.noise[1] / OF_NORMAL) ** 2
        turn = float(np.sqrt(max(own - (noise / kernel.lever) ** 2, _OWN_TURN * own)))
    arm = replace(model, turn_std=turn, noise=noise if model.noise > 0.0 else 0.0)
    chosen = ChosenTerms.of(kernel.terms[kept], ends_of(kernel, system.seen))
    calibrator = Combined(arm, replace(sheet, curves=chosen))
    width = found.widths / system.tolerance
    # Of constants the sheet may know better than a few of them tell; of curves only the rows know.
    width[:constants] = np.maximum(width[:constants], 1.0)
    information = found.rows_say(wanted) + np.diag(width[wanted] ** -2.0)
    inside = int(wanted[:n].sum())
    information = _without(information, inside)
    root = cholesky(information, lower=False)
    calibrator.begin(found.x[:n][wanted[:n]], root, noise, system.n_rows)
    return calibrator


def _without(information: Array, n: int) -> Array:
    """Information (n, n) of the first n unknowns, whatever the others are."""
    if n == len(information):
        return information
    across, other = information[:n, n:], information[n:, n:]
    return information[:n, :n] - across @ cho_solve(cho_factor(other), across.T)


def _own_order(seen: PointObservation, jumps: Sequence[Jump]) -> Integers:
    """Rows between two jumps by joints and positions, whatever their times."""
    keys = np.hstack([seen.joints, seen.position])
    ends = [0, *(jump.at for jump in jumps), len(keys)]
    parts = [a + np.lexsort(keys[a:b].T[::-1]) for a, b in pairwise(ends)]
    return np.concatenate(parts).astype(np.int64)


def _believed(order: Integers, found: Posterior) -> Booleans:
    out = np.empty(len(order), np.bool_)
    weights = (FREEDOM + 3.0) / (FREEDOM + np.nan_to_num(found.squares))
    out[order] = (weights >= _DOUBTFUL).all(axis=1)
    return out
