"""What a hand-eye calibration found, and how good it is."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, Integers, shaped
from handeye.calibration.hand_eye.links import Links
from handeye.calibration.hand_eye.noise import Noise
from handeye.calibration.hand_eye.samples import Setup, poses
from handeye.errors import InvalidInput
from handeye.geometry import invert
from handeye.robots.arm import Arm


@dataclass(frozen=True, eq=False)
class HandEye:
    """Where camera and target sit: A X = Z B for N samples.

    setup          "eye_in_hand": X = T_flange_camera, Z = T_base_target, B = T_camera_target^-1;
                   "eye_to_hand": X = T_flange_target, Z = T_base_camera, B = T_camera_target
    X, Z           (4, 4)
    covariance     (12, 12) of X, then Z: turn [rad] and shift [m], R <- exp(turn) R and
                   t <- t + shift, in axes of the flange and of the base
    scale          length that the camera reports for one metre; 1 if it is known
    scale_std      its standard deviation
    residuals      (N, 6) measured minus predicted, in camera axes: rotation vector [rad], position
                   in the unit of the camera
    normalised     (N, 6) residuals over their standard deviations
    good           (N,) probability that a sample is no outlier
    influence      (N,) how far the result would move without a sample, in standard deviations of
                   the result (square root of Cook's distance); inf if the rest determines less
    noise          what camera and arm were found to err
    links          (n - 1, 4, 4) by how much each link of the arm departs from its model, as
                   `links.Links` says (`flanges` applies it); None without an arm
    condition      how much better the best known direction is known than the worst
    undetermined   what the samples leave open, in words; empty if nothing. There the values are
                   those of the `Mounting` and the covariance is its own
    status         the outcome and what to do about it
    """

    setup: Setup
    X: Array
    Z: Array
    covariance: Array
    scale: float
    scale_std: float
    residuals: Array
    normalised: Array
    good: Array
    influence: Array
    noise: Noise
    links: Array | None
    condition: float
    undetermined: tuple[str, ...]
    status: str

    @property
    def determined(self) -> bool:
        """Whether the samples decide everything."""
        return not self.undetermined

    @property
    def std(self) -> Array:
        """Standard deviations (12,) in the order of the covariance."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def outliers(self) -> Integers:
        """Samples that are more likely wrong than right, as numbers from 0."""
        return np.flatnonzero(self.good < 0.5)

    @property
    def T_flange_camera(self) -> Array:
        """(4, 4), eye in hand; raises InvalidInput otherwise."""
        return self._only("eye_in_hand", self.X, "T_base_camera")

    @property
    def T_base_target(self) -> Array:
        """(4, 4), eye in hand; raises InvalidInput otherwise."""
        return self._only("eye_in_hand", self.Z, "T_flange_target")

    @property
    def T_flange_target(self) -> Array:
        """(4, 4), eye to hand; raises InvalidInput otherwise."""
        return self._only("eye_to_hand", self.X, "T_base_target")

    @property
    def T_base_camera(self) -> Array:
        """(4, 4), eye to hand; raises InvalidInput otherwise."""
        return self._only("eye_to_hand", self.Z, "T_flange_camera")

    def predict(self, flanges: ArrayLike) -> Array:
        """T_camera_target (N, 4, 4) at T_base_flange (N, 4, 4); raises InvalidInput for others."""
        A = poses(flanges, "flanges")
        if self.setup == "eye_in_hand":
            seen = invert(A @ self.X) @ self.Z
        else:
            seen = invert(self.Z) @ A @ self.X
        seen[:, :3, 3] *= self.scale
        return seen

    def flanges(self, arm: Arm, joints: ArrayLike) -> Array:
        """T_base_flange (N, 4, 4) of an arm at joints (N, n) with the errors of its links.

        Raises:
            InvalidInput: for joints of another shape.
        """
        q = shaped(joints, (None, len(arm.joint_names)), "joints")
        return arm.poses(q) if self.links is None else Links.of(arm, q).flanges(self.links)

    def _only(self, setup: Setup, value: Array, other: str) -> Array:
        if self.setup != setup:
            raise InvalidInput(f"this is {self.setup.replace('_', ' ')}: use {other}")
        return value
