"""Where the sensor stands to the arm's base, and the marker to its flange."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.spatial.transform import Rotation

from handeye.arrays import Array, shaped
from handeye.calibration.placement_problem import MEDIAN_LENGTH, PlacementProblem
from handeye.calibration.placement_start import Start, base_turn, starts
from handeye.calibration.placement_status import status, undetermined
from handeye.geometry import make_pose, matrix_from_wxyz
from handeye.observations import PointObservation
from handeye.robots.arm import Arm

_ROWS_TO_CHOOSE_START = 2000
_REWEIGHTINGS = 5
# Orientations farther from their mean than this multiple of the median take no part in it.
_OUTLIER = 3.0
# Orientations that agree no better than this with the arm are not those of the marker; none are
# better than the least [rad].
_LARGE_TURN, _LEAST_TURN = 0.1, 1e-5


@dataclass(frozen=True)
class Placement:
    """The two poses that an arm's kinematics leaves open.

    T_sensor_base    (4, 4)  base of the arm in the sensor's frame
    T_flange_marker  (4, 4)  marker in the flange's frame
    """

    T_sensor_base: Array
    T_flange_marker: Array

    def predict(self, arm: Arm, joints: Array) -> Array:
        """Positions (N, 3) of the marker in the sensor's frame [m] at joints (N, n).

        The translation of T_sensor_base T_base_flange(q) T_flange_marker.
        """
        chain = self.T_sensor_base @ arm.poses(joints)
        return (chain @ self.T_flange_marker[:, 3])[:, :3]


@dataclass(frozen=True)
class PlacementFit:
    """A placement and how far to trust it.

    residuals              measured minus predicted positions (N, 3) [m]
    orientation_residuals  rotation vectors from predicted to measured orientation, in the
                           marker's frame (N, 3) [rad]; None where none was measured
    condition              largest over smallest singular value, with turns counted as the
                           motion they cause; inf where something is not determined at all
    undetermined           what the rows leave open, in words; empty if nothing
    status                 the outcome and what to do about it
    """

    placement: Placement
    residuals: Array
    orientation_residuals: Array | None
    condition: float
    undetermined: tuple[str, ...]
    status: str


def sensor_of(fit: PlacementFit, seen: PointObservation) -> tuple[float | None, float]:
    """How accurate the sensor is at worst: of orientations [rad], of positions [m].

    Standard deviations of what the nominal arm leaves unexplained, which is the sensor's noise and
    the arm's own errors together. None for orientations that are not measured, or that are about
    something else; 0 for positions that state their own.
    """
    turn, noise = None, 0.0
    if fit.orientation_residuals is not None:
        turn = max(_robust_std(fit.orientation_residuals), _LEAST_TURN)
    if seen.position_std is None:
        noise = _robust_std(fit.residuals)
    return (None if turn is None or turn > _LARGE_TURN else turn), noise


def _robust_std(vectors: Array) -> float:
    """Of the components of N normally distributed vectors (N, 3), whatever some of them are."""
    return float(np.median(np.linalg.norm(vectors, axis=1))) / MEDIAN_LENGTH


def estimate_placement(
    arm: Arm, observations: PointObservation, *, marker: Literal["free", "fixed"] = "free"
) -> PlacementFit:
    """Fit base and marker to N sightings, with the arm's kinematics as they are.

        p_i = R (R_i m + t_i) + t + e_i,    (R_i, t_i) = T_base_flange(q_i)

    Closed forms (`placement_start`) give starts; from each, R, t and m minimise the sum of
    soft_l1 of the components of e_i over their standard deviations, and the best is kept. These
    standard deviations join the measurement's with the kinematics' own, which is taken from the
    residuals. Measured orientations decide only what positions leave open, and the orientation
    of the marker (else the identity). A "fixed" marker sits at the flange's origin. What no row
    decides stays near the start, and `status` says so.

    Raises:
        InvalidInput: for no rows, or arrays that do not fit each other or the arm.
    """
    problem = PlacementProblem.of(arm, observations, fixed=marker == "fixed")
    flanges = problem.poses[:, :3, :3]
    rotations = None
    if observations.orientation is not None:
        wxyz = shaped(observations.orientation, (len(flanges), 4), "orientation")
        rotations = matrix_from_wxyz(wxyz)
    start, x = _best_start(problem, rotations)
    for _ in range(_REWEIGHTINGS):
        x = problem.refined(start, x, problem.spread(start, x))
    R, t, m = problem.parts(start, x)
    Z, disagreements = _marker_turn(flanges, rotations, R)

    residuals = problem.residuals(start, x)
    median = float(np.median(np.linalg.norm(residuals, axis=1)))
    disagreement = None
    turn_std = np.inf
    if rotations is not None and disagreements is not None:
        disagreement = float(np.median(np.linalg.norm(disagreements, axis=1)))
        if base_turn(flanges, rotations) is not None:
            turn_std = disagreement
    jacobian, std, motion = problem.sensitivity(start, x, turn_std)
    condition, still_open = undetermined(jacobian, std, motion)
    advice = status(
        problem.poses,
        still_open,
        condition,
        median=median,
        motion=motion,
        disagreement=disagreement,
    )
    return PlacementFit(
        Placement(make_pose(R, t), make_pose(Z, m)),
        residuals,
        disagreements,
        condition,
        still_open,
        advice,
    )


def placement_size(poses: Array, positions: Array, lever: float) -> float:
    """Half of what base and marker, fitted to flanges at poses (N, 4, 4), leave exceeds this [m].

    lever: the arm's reach [m].
    """
    problem = PlacementProblem(poses, positions, np.zeros_like(positions), lever, fixed=False)
    residuals = problem.residuals(*_best_start(problem, None))
    return float(np.median(np.linalg.norm(residuals, axis=1)))


def _best_start(problem: PlacementProblem, rotations: Array | None) -> tuple[Start, Array]:
    thin = problem.thinned(_ROWS_TO_CHOOSE_START)
    candidates = starts(problem.poses, problem.positions, rotations, fixed=problem.fixed)

    def refined(start: Start) -> tuple[float, Start, Array]:
        x = thin.begin(start)
        x = thin.refined(start, x, thin.spread(start, x))
        return float(np.median(thin.spread(start, x))), start, x

    best = refined(candidates[0])
    for start in candidates[1:]:
        other = refined(start)
        # Starts are in the order of trust: only a real gain moves on.
        if other[0] < 0.99 * best[0]:
            best = other
    return best[1], best[2]


def _marker_turn(flanges: Array, rotations: Array | None, R: Array) -> tuple[Array, Array | None]:
    """Mean Z of R_i^T R^T R_marker_i, without outliers, and each row's deviation from it."""
    if rotations is None:
        return np.eye(3), None
    each = Rotation.from_matrix(flanges.swapaxes(1, 2) @ R.T @ rotations)
    off = np.asarray((each.mean().inv() * each).magnitude())
    mean = each[np.flatnonzero(off <= _OUTLIER * np.median(off) + 1e-12)].mean()
    return mean.as_matrix(), (mean.inv() * each).as_rotvec()
