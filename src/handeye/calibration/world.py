"""A simulated planar robot at work: poses, sightings, and where commands really bring the hand."""

from dataclasses import dataclass

import numpy as np

from handeye.arrays import Array, Integers
from handeye.calibration.drift import Drift, steady
from handeye.calibration.plant import PlanarPlant
from handeye.errors import InvalidInput
from handeye.observations import StereoObservation

Interval = tuple[float, float]


@dataclass(frozen=True)
class Region:
    """Where the hand works and how far beside it the eye points (section 3.4.4).

    alpha, beta          joint travel, encoder readings [rad]
    singular_beta        |beta| below this is left out, since a stretched arm cannot be inverted
    eccentricity         the head points within +- this angle of the hand [rad]
    """

    alpha: Interval = (-0.8 * np.pi, 0.8 * np.pi)
    beta: Interval = (-0.8 * np.pi, 0.8 * np.pi)
    singular_beta: float = 0.1 * np.pi
    eccentricity: float = np.pi / 6.0

    def __post_init__(self) -> None:
        beta_is_left_out = -self.singular_beta < self.beta[0] <= self.beta[1] < self.singular_beta
        if (
            self.alpha[1] < self.alpha[0]
            or self.beta[1] < self.beta[0]
            or beta_is_left_out
            or self.eccentricity < 0.0
        ):
            raise InvalidInput(f"no pose is left in {self}")

    def sample(self, n: int, rng: np.random.Generator) -> tuple[Array, Array]:
        """n uniform poses: joints (n, 2) and eccentricities (n,).

        Three numbers are drawn for each, so n poses are the same drawn at once or in parts.
        """
        u, v, w = rng.random((n, 3)).T
        low, high = self.beta
        left = max(min(high, -self.singular_beta) - low, 0.0)
        right = max(high - max(low, self.singular_beta), 0.0)
        along = v * (left + right)
        # A pose to the right of the singular strip is moved across it.
        strip = max(low, self.singular_beta) - (low + left) if high >= self.singular_beta else 0.0
        beta = low + along + strip * (along >= left)
        alpha = self.alpha[0] + u * (self.alpha[1] - self.alpha[0])
        return np.stack([alpha, beta], axis=-1), (2.0 * w - 1.0) * self.eccentricity


@dataclass(frozen=True)
class PlanarWorld:
    """A plant that is never told to the learner, at work in a region.

    foveate  the head turns until the hand is measured at zero eccentricity (section 3.5.9)
    drift    what becomes of the plant over the trials
    """

    plant: PlanarPlant
    region: Region = Region()
    foveate: bool = False
    drift: Drift = steady

    def observe(
        self, trials: Integers, poses: np.random.Generator, noise: np.random.Generator
    ) -> StereoObservation:
        """One sighting of the hand at a random pose in each of trials (N,), counted from 0."""
        n = len(trials)
        joints, eccentricity = self.region.sample(n, poses)
        unit_noise = noise.standard_normal((n, 2))
        plant = self.drift(self.plant, trials)
        if self.foveate:
            # The pointing loop is closed around the measured eccentricity, noise included.
            straight = np.zeros(n)
            eccentricity = -plant.head.eccentricity_std(straight) * unit_noise[:, 1]
        pointing, r, measured = plant.sight(plant.tips(joints), eccentricity, unit_noise)
        return StereoObservation(np.asarray(trials, np.float64), joints, pointing, r, measured)

    def tips(self, joints: Array, trials: Integers) -> Array:
        """Where the hand really is, (N, 2) [m], with joints (N, 2) read in trials (N,)."""
        return self.drift(self.plant, trials).tips(joints)
