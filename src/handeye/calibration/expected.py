"""How far the hand is expected to miss: at rows that were seen, and anywhere else.

A calibrator that knows the covariance C of its unknowns x expects the hand at y(x) to miss by

    e^2 = tr( J C J^T + N ),   J = dy/dx

root mean square, with N the covariance of what the model leaves unexplained and, at a row that
was seen, of what its measurement states. `HeldOut.expected` can be compared with what happened.
"""

from typing import Any, NamedTuple

import numpy as np
from scipy.linalg import solve_triangular
from scipy.stats import chi2

from handeye._compiled import compiled
from handeye.arrays import Array
from handeye.calibration.arm import ArmEstimator
from handeye.calibration.arm.log_system import misfits
from handeye.calibration.arm.residuals import measured_at
from handeye.calibration.arm.student import OF_NORMAL
from handeye.calibration.combined import Combined
from handeye.calibration.engine.chain import reach
from handeye.calibration.engine.design import spreads
from handeye.calibration.placed_arm import PlacedArm
from handeye.calibration.results import CalibrationResult, HeldOut, Workspace
from handeye.observations import Observation
from handeye.randomness import stream
from handeye.robots.urdf import UrdfArm

# How far joints are turned to look around [rad], unless they worked farther out, and how often.
_AROUND, _LOOKS = np.pi, 3000
# So many of the rows are shown.
_SHOWN = 400
_CHUNK = 256
# Errors of nineteen rows in twenty stay below.
_MOST = 0.95
_LEAST = 1e-9


def expected_at_rows(calibrator: Any, seen: Observation) -> Array | None:
    """Root mean square (N,) of the error that each row should show [m].

    None of a calibrator that does not know how certain it is.
    """
    if not isinstance(calibrator, Combined | ArmEstimator):
        return None
    observations: Any = seen
    return _expected(calibrator, calibrator.robot.seen_rows(observations))


def expected_at(calibrator: Any, joints: Array) -> Array | None:
    """The same for an arm of a URDF file at any joints (N, n), with a sensor that is exact."""
    if not isinstance(calibrator, Combined | ArmEstimator):
        return None
    if not isinstance(calibrator.model, PlacedArm):
        return None
    x = calibrator.engine.x if isinstance(calibrator, Combined) else calibrator.x
    rows = calibrator.robot.candidates(x, joints, len(joints))[1]
    return _expected(calibrator, rows)


def expected_summary(result: CalibrationResult) -> dict[str, dict[str, float]]:
    """Expected misses [m]: `n`, `median`, `p95` and `max` of rows, working range and elsewhere.

    Of held-out rows also `expected_rms` beside `found_rms`, and `within`, the share of errors below
    what nineteen in twenty should stay below, sqrt(chi^2_0.95(k) / k) e for errors of k normal
    components. Empty where the calibrator does not know how certain it is.
    """
    out: dict[str, dict[str, float]] = {}
    pulled, held, space = result.influence, result.held_out, result.workspace
    if pulled is not None and pulled.expected is not None:
        out["rows"] = _sizes(pulled.expected)
    if held is not None and held.expected is not None and len(held.rows):
        found: Array = np.linalg.norm(held.after, axis=1)
        k = held.after.shape[1]
        most = float(np.sqrt(chi2.isf(1.0 - _MOST, k) / k))
        out["held_out"] = _sizes(held.expected) | {
            "expected_rms": _rms(held.expected),
            "found_rms": _rms(found),
            "within": float(np.mean(found <= most * held.expected)),
        }
        out["held_out"]["stretch"] = stretch(held)
    if space is not None:
        for name, which in (("working_range", space.worked), ("elsewhere", ~space.worked)):
            if which.any():
                out[name] = _sizes(space.expected[which])
    return out


def stretch(held: HeldOut | None) -> float:
    """How many times farther off held-out rows are than was expected of them, at least 1.

    By the median of |e|^2 / expected^2 over that of chi^2(k) / k, so that wild rows do not count:
    rows of another time show errors that the rows that were learned could not tell of.
    """
    if held is None or held.expected is None or not len(held.rows):
        return 1.0
    k = held.after.shape[1]
    ratio = np.sum(held.after**2, axis=1) / np.maximum(held.expected, _LEAST) ** 2
    return max(float(np.sqrt(np.median(ratio) * k / chi2.median(k))), 1.0)


def _sizes(expected: Array) -> dict[str, float]:
    median, p95 = np.quantile(expected, [0.5, 0.95])
    most = float(expected.max())
    return {"n": len(expected), "median": float(median), "p95": float(p95), "max": most}


def _rms(lengths: Array) -> float:
    return float(np.sqrt(np.mean(lengths**2)))


def workspace(
    calibrator: Any, seen: Observation, n: int = _LOOKS, *, held: HeldOut | None = None
) -> Workspace | None:
    """Poses all over the limits of an arm's joints, half of them where the joints have worked.

    What is expected there is stretched as `held` rows call for. None as `expected_at`, or without
    any row.
    """
    model: Any = getattr(calibrator, "model", None)
    if not isinstance(model, PlacedArm) or not isinstance(model.arm, UrdfArm) or not len(seen):
        return None
    arm, rng = model.arm, stream("expected: workspace", n)
    low: Array = np.maximum(arm.lower, np.minimum(model.low, -_AROUND))
    high = np.minimum(arm.upper, np.maximum(model.high, _AROUND))
    joints = rng.uniform(low, high, (n, len(low)))
    # So large a space is nearly all far from any row: half of the poses look where the robot works.
    near = np.clip(model.low, low, high), np.clip(model.high, low, high)
    joints[::2] = rng.uniform(*near, (len(joints[::2]), len(low)))
    expected = expected_at(calibrator, joints)
    if expected is None:
        return None
    worked = np.all((joints >= near[0]) & (joints <= near[1]), axis=1)
    rows = seen.joints[:: -(-len(seen) // _SHOWN)]
    expected = stretch(held) * expected
    return Workspace(joints, _marker(model, joints), expected, worked, _marker(model, rows))


def _marker(model: PlacedArm, joints: Array) -> Array:
    """Where the nominal arm has the marker, (N, 3) in its base frame."""
    return (model.arm.poses(joints) @ model.placement.T_flange_marker[:, 3])[:, :3]


def _expected(calibrator: Combined | ArmEstimator, rows: Array) -> Array:
    if isinstance(calibrator, ArmEstimator):
        return _of_estimator(calibrator, rows)
    engine, chain = calibrator.engine, calibrator.engine.chain
    m, k = chain.n_hand, chain.n_values
    squares = np.empty(len(rows))
    for first in range(0, len(rows), _CHUNK):
        some = rows[first : first + _CHUNK]
        spread, noise = spreads(engine, some, hand=True), np.empty((len(some), m, k))
        noises(chain.kernel, engine.x, some, engine.doubt, noise)
        part = slice(first, first + len(some))
        squares[part] = np.sum(spread**2, axis=(1, 2)) + np.sum(noise**2, axis=(1, 2))
    return np.sqrt(squares)


def _of_estimator(calibrator: ArmEstimator, rows: Array) -> Array:
    robot, found = calibrator.robot, calibrator.posterior()
    kernel, tolerance = robot.kernel, robot.chain.tolerance
    at = measured_at(kernel) + 3
    k = robot.chain.n_values
    values, by = np.empty((len(rows), k)), np.empty((len(rows), k, len(tolerance)))
    misfits(kernel, found.x, rows, values, by)
    J = by[:, :3].reshape(-1, len(tolerance)) * tolerance
    half = solve_triangular(found.root, J.T, lower=True)
    known = np.sum(half**2, axis=0).reshape(-1, 3)
    stated = rows[:, at : at + 3] ** 2 + (found.noise[0] / OF_NORMAL) ** 2
    return np.sqrt(np.sum(known + stated, axis=1))


@compiled
def noises(kernel: NamedTuple, x: Array, rows: Array, doubt: float, out: Array) -> None:
    """out (N, m, k), overwritten: the hand by residuals of unit variance, at rows (N, w)."""
    for i in range(len(rows)):
        reach(kernel, x, rows[i], doubt, out[i])
