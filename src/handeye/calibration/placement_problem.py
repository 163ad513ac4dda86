"""Base and marker as a robust least-squares problem."""

from dataclasses import dataclass, replace
from typing import Self, cast

import numpy as np
from scipy.optimize import brentq, least_squares
from scipy.spatial.transform import Rotation

from handeye.arrays import Array, shaped
from handeye.calibration.placement_start import Start
from handeye.errors import InvalidInput
from handeye.observations import PointObservation
from handeye.robots.arm import Arm

# Residuals of noise-free rows are rounding; this keeps them from being weighted as information [m].
LEAST_STD = 1e-6
# How far base and marker may lie from the start: a standard deviation, in shares of the arm's
# reach. Thousands of times the residuals, so that it decides only what hardly any row decides.
_PLAY = 0.2
# A motion smaller than this share of the arm's reach is none.
_LEAST_MOTION = 1e-3
MEDIAN_LENGTH = 1.538
"""Of a normally distributed 3-vector whose components have standard deviation 1."""


@dataclass(frozen=True)
class PlacementProblem:
    """Residuals of N rows as functions of x (9,) or, with the marker fixed, x (6,) [m].

    x = (rotation vector by which the base turns from the start, times `lever`; t; m)

    poses T_base_flange (N, 4, 4), positions (N, 3) [m] and their measured std (N, 3) [m].
    """

    poses: Array
    positions: Array
    std: Array
    lever: float
    fixed: bool

    @classmethod
    def of(cls, arm: Arm, seen: PointObservation, *, fixed: bool) -> Self:
        """The problem of these sightings; raises InvalidInput for none, or odd shapes."""
        joints = shaped(seen.joints, (None, len(arm.joint_names)), "joints")
        positions = shaped(seen.position, (len(joints), 3), "position")
        if not len(joints):
            raise InvalidInput("a placement needs observations, got none")
        std = np.zeros_like(positions)
        if seen.position_std is not None:
            std = shaped(seen.position_std, positions.shape, "position_std")
        return cls(arm.poses(joints), positions, std, arm.reach or 1.0, fixed)

    def thinned(self, rows: int) -> Self:
        """About `rows` of the rows, spread evenly."""
        step = slice(None, None, -(-len(self.poses) // rows))
        return replace(
            self, poses=self.poses[step], positions=self.positions[step], std=self.std[step]
        )

    def begin(self, start: Start) -> Array:
        """The unknowns at a start."""
        R, m = start
        t = (self.positions - self.paths(m) @ R.T).mean(axis=0)
        return np.concatenate([np.zeros(3), t, m])[: 6 if self.fixed else 9]

    def parts(self, start: Start, x: Array) -> tuple[Array, Array, Array]:
        """R (3, 3), t (3,) and m (3,) of x."""
        R = Rotation.from_rotvec(x[:3] / self.lever).as_matrix() @ start[0]
        return R, x[3:6], np.zeros(3) if self.fixed else x[6:]

    def paths(self, m: Array) -> Array:
        """Marker in the base's frame R_i m + t_i (N, 3)."""
        return self.poses[:, :3, :3] @ m + self.poses[:, :3, 3]

    def residuals(self, start: Start, x: Array) -> Array:
        """Measured minus predicted positions (N, 3) [m]."""
        R, t, m = self.parts(start, x)
        return self.positions - (self.paths(m) @ R.T + t)

    def spread(self, start: Start, x: Array) -> Array:
        """Standard deviation of each residual: the measurement's and the kinematics' together.

        The kinematics' own s is the one that makes the median of |e_i| / sqrt(std_i^2 + s^2) that
        of a normal distribution: outliers do not count, and rows may differ in accuracy.
        """
        lengths = np.linalg.norm(self.residuals(start, x), axis=1)
        measured = np.sqrt(np.mean(self.std**2, axis=1))

        def surplus(s: float) -> float:
            return float(np.median(lengths / np.hypot(measured, s))) - MEDIAN_LENGTH

        most = max(float(np.median(lengths)) / MEDIAN_LENGTH, LEAST_STD)
        own = LEAST_STD if surplus(LEAST_STD) <= 0.0 else most
        if own > LEAST_STD and surplus(most) < 0.0:
            own = float(brentq(surplus, LEAST_STD, most, rtol=1e-3))
        return np.hypot(self.std, own)

    def refined(self, start: Start, x: Array, std: Array) -> Array:
        """The unknowns that minimise soft_l1 of residuals over `std` (N, 3), from x on."""
        pull = np.full(len(x), 1.0 / (_PLAY * self.lever))
        pull[3:6] = 0.0
        home = self.begin(start)

        def residuals(x: Array) -> Array:
            return np.concatenate([(self.residuals(start, x) / std).reshape(-1), pull * (home - x)])

        def jacobian(x: Array) -> Array:
            J = self.jacobian(start, x) / std[..., None]
            return np.concatenate([J.reshape(-1, len(x)), -np.diag(pull)])

        found = least_squares(
            residuals, x, jacobian, loss="soft_l1", xtol=1e-13, ftol=1e-13, gtol=1e-13, max_nfev=100
        )
        return np.asarray(found.x, dtype=np.float64)

    def jacobian(self, start: Start, x: Array) -> Array:
        """Derivative of the residuals, (N, 3, len(x))."""
        R, _, m = self.parts(start, x)
        # Central difference of the rotation only: its error is far below that of any measurement.
        step = 1e-5
        ahead = Rotation.from_rotvec(x[:3] / self.lever + step * np.eye(3)).as_matrix()
        behind = Rotation.from_rotvec(x[:3] / self.lever - step * np.eye(3)).as_matrix()
        turning = (ahead - behind) / (2.0 * step * self.lever) @ start[0]
        J = np.empty((len(self.poses), 3, len(x)))
        J[:, :, :3] = np.einsum("kij,nj->nik", turning, self.paths(m))
        J[:, :, 3:6] = np.eye(3)
        if not self.fixed:
            J[:, :, 6:] = R @ self.poses[:, :3, :3]
        return -J

    def sensitivity(self, start: Start, x: Array, turn_std: float) -> tuple[Array, float, float]:
        """How well x is determined: Jacobian (M, 6 or 9), std of a row and size of the motion [m].

        Columns: turn of the base about the middle of the marker's path, times the size of that
        motion; position of the base; marker. Orientations that fix the base's turn to `turn_std`
        [rad] add three rows.
        """
        R, _, m = self.parts(start, x)
        path = self.paths(m) @ R.T
        path = path - path.mean(axis=0)
        size = float(np.linalg.norm(path)) / np.sqrt(len(path))
        motion = max(float(size), _LEAST_MOTION * self.lever)
        std = float(np.median(self.spread(start, x)))
        J = np.zeros((len(path), 3, len(x)))
        for axis in range(3):
            J[:, :, axis] = cast("Array", np.cross(np.eye(3)[axis], path)) / motion
        J[:, :, 3:6] = np.eye(3)
        if not self.fixed:
            J[:, :, 6:] = R @ self.poses[:, :3, :3]
        turn = std / (motion * max(turn_std, LEAST_STD)) * np.eye(3, len(x))
        return np.concatenate([J.reshape(-1, len(x)), turn]), std, motion
