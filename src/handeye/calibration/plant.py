"""A planar hand-eye robot: arm, pointing axis and stereo head, as it is or is thought to be."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from handeye.arrays import Array
from handeye.geometry.angles import wrap
from handeye.observations import StereoTarget
from handeye.robots.encoder import AxisEncoder
from handeye.robots.planar import TwoLinkArm
from handeye.sensors.stereo import StereoHead


@dataclass(frozen=True)
class PlanarPlant:
    """The kinematic parameters of section 3.4.4 and every source of error, each on its own switch.

    With nominal parameters this is what the engineer knows; with actual ones, what is so.

    arm                 links a and b
    v_x, v_y            eye and pointing axis in the arm's base frame [m]
    alpha, beta, gamma  encoders of the arm's joints and of the pointing axis
    head                stereo head

    A parameter may be an array (N,), one value for each of N trials of a plant that drifts; then
    every method takes and returns N rows.
    """

    arm: TwoLinkArm
    v_x: float | Array
    v_y: float | Array
    alpha: AxisEncoder
    beta: AxisEncoder
    gamma: AxisEncoder
    head: StereoHead

    def tips(self, readings: Array) -> Array:
        """Hand positions (..., 2) [m] in the base frame at joint encoder readings (..., 2)."""
        actual = [self.alpha.actual(readings[..., 0]), self.beta.actual(readings[..., 1])]
        return self.arm.tips(np.stack(actual, axis=-1))

    def sight(
        self, tips: Array, eccentricity: Array, unit_noise: Array
    ) -> tuple[Array, Array, Array]:
        """See points (..., 2): pointing encoder, measured range and eccentricity, each (...).

        `eccentricity` is the actual angle at which the head is pointed beside the point; unit_noise
        (..., 2) is standard normal (eq 3.3 to 3.5, 3.8 to 3.10).
        """
        x, y = tips[..., 0] - self.v_x, tips[..., 1] - self.v_y
        pointing = wrap(np.arctan2(y, x) - eccentricity)
        measured = self.head.measure(np.hypot(x, y), eccentricity, unit_noise)
        return self.gamma.reading(pointing), *measured

    def locate(self, target: StereoTarget) -> Array:
        """Where a sighting lies in the base frame, (..., 2) [m], taken at its word (eq 3.11, 3.12).

        Undoes the offset of the pointing encoder and the range scale, but no distortion.
        """
        theta = target.pointing + self.gamma.offset + target.eccentricity
        r = target.range / self.head.range_scale
        return np.stack([r * np.cos(theta) + self.v_x, r * np.sin(theta) + self.v_y], axis=-1)

    def joints_for(self, target: StereoTarget) -> Array:
        """Joint encoder readings (..., 2) in (-pi, pi] that bring the hand to a sighting.

        Eq 3.13 to 3.17, then the encoder offsets; periodic errors are not undone.
        """
        angles = self.arm.inverse(self.locate(target), target.elbow)
        offsets = np.stack(np.broadcast_arrays(self.alpha.offset, self.beta.offset), axis=-1)
        return wrap(angles - offsets)

    def without_noise(self) -> Self:
        """The same plant with a head that measures without noise."""
        return replace(self, head=replace(self.head, pixel_pitch=0.0))

    def without_perturbations(self) -> Self:
        """The same plant with linear encoders and an undistorted head; offsets and noise stay."""
        linear = {
            axis: AxisEncoder(offset=encoder.offset)
            for axis, encoder in (("alpha", self.alpha), ("beta", self.beta), ("gamma", self.gamma))
        }
        head = replace(self.head, eccentricity_warp=0.0, range_warp=0.0)
        return replace(self, head=head, **linear)

    def with_range_scale(self, scale: float) -> Self:
        """The same plant with every range multiplied by `scale` (section 3.5.8)."""
        return replace(self, head=replace(self.head, range_scale=scale))
