"""The least error that a sighting with noise allows: what is left when the robot is fully known."""

import numpy as np

from handeye.arrays import Array
from handeye.calibration.calibrator import Feedback
from handeye.calibration.plant import PlanarPlant
from handeye.calibration.session import WorldStreams, position_errors
from handeye.calibration.world import PlanarWorld
from handeye.geometry.angles import wrap
from handeye.observations import StereoObservation, StereoTarget
from handeye.robots.encoder import AxisEncoder

_ITERATIONS = 60


class Informed:
    """Commands by the actual plant, all its curves undone; only the target's noise is left.

    The measured pointing angle, range and eccentricity are taken as if they had no noise, which
    for small noise is the most likely place. Then eq 3.11 to 3.17 with actual parameters, and the
    readings that eq 3.37 and 3.38 ask for. A fixed point is enough: the curves are small.
    """

    def __init__(self, plant: PlanarPlant) -> None:
        self.plant = plant

    def observe(self, observation: StereoObservation) -> Feedback:
        """Nothing is left to learn."""
        return Feedback(self.errors(observation), np.zeros((), np.bool_))

    def observe_many(self, observations: StereoObservation) -> Feedback:
        """Nothing is left to learn."""
        return Feedback(self.errors(observations), np.zeros(len(observations), np.bool_))

    def errors(self, observations: StereoObservation) -> Array:
        """Where the hand was minus where the command for its sighting brings it, (..., 2) [m]."""
        there = self.plant.tips(self.command(observations.target))
        return self.plant.tips(observations.joints) - there

    def command(self, target: StereoTarget) -> Array:
        """Encoder readings (..., 2)."""
        plant, head = self.plant, self.plant.head
        # gamma_meas = gamma - O_gamma + error(gamma) (eq 3.34)
        gamma = straight = target.pointing + plant.gamma.offset
        r, eps = target.range / head.range_scale, target.eccentricity
        for _ in range(_ITERATIONS):
            gamma = straight - plant.gamma.error(gamma)
            eps = target.eccentricity - head.eccentricity_error(r, eps)
            r = (target.range - head.range_error(r, eps)) / head.range_scale
        theta = gamma + eps
        tips = np.stack([r * np.cos(theta) + plant.v_x, r * np.sin(theta) + plant.v_y], axis=-1)
        actual = plant.arm.inverse(tips, target.elbow)
        joints = [
            _reading(axis, actual[..., k]) for k, axis in enumerate((plant.alpha, plant.beta))
        ]
        return np.stack(joints, axis=-1)


def _reading(encoder: AxisEncoder, actual: Array) -> Array:
    """What reads so that the joint is at `actual`, in (-pi, pi]."""
    straight = actual - encoder.offset
    reading = wrap(straight)
    for _ in range(_ITERATIONS):
        reading = wrap(straight - encoder.error(reading))
    return reading


def floor(world: PlanarWorld, trial: int, streams: WorldStreams, n: int) -> Array:
    """Lengths (n,) [m] of the errors that remain when true parameters and curves are known.

    At n fresh poses with the plant as it is at `trial`: where the hand really was minus where the
    command of `Informed` for its noisy sighting really brings it. Their mean is the floor. To
    compare with a calibrator on the same poses and noise, give `position_errors` both.
    """
    informed = Informed(world.drift(world.plant, trial))
    (errors,) = position_errors(world, [informed], trial, streams, n)
    return np.linalg.norm(errors, axis=1)
