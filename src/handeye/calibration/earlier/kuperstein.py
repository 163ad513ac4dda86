"""A hand-eye learner after Kuperstein: camera directions to muscle activations."""

import numpy as np

from handeye.arrays import Array, Booleans, count, scalar
from handeye.calibration.earlier import kuperstein_kernels as kernels
from handeye.calibration.earlier.whole_map import WholeMap
from handeye.calibration.models import PlanarMap
from handeye.errors import InvalidInput
from handeye.observations import StereoObservation, StereoTarget


class KupersteinMap(WholeMap):
    """Weighted sums of camera maps drive pairs of muscles (Kuperstein 1987; section 3.2).

    Two cameras point at the hand. The unit vector along each camera's axis excites a map of 20 x 20
    units, and a third map holds how much the two differ from unit to unit. Each joint is turned by
    two opposed muscles, and each muscle's activation is a weighted sum over all units of the three
    maps. While the arm moves at random, the weights are adjusted towards what the muscles really
    did.

    Three things differ from the original. The robot is planar: two joints, four muscles, cameras
    that only pan, so that the ends of the vectors lie on a circle of the map. Its head measures
    range and eccentricity, from which follows where cameras on either side of the head would point
    if it faced the hand. And as a target can be reached with the elbow on either side, each side
    has its own weights: 2 x 4 x 1,200 of them, where three joints had 6 x 1,200 = 7,200. The form
    of the disparity map and the rule, a normalised delta rule, are our reading of a short
    description.

    Args:
        model: what is sensed; no kinematics.
        units: along either side of a map.
        width: of a unit's response, where the map measures 2 across.
        rate: in (0, 1]: the share of an error that is removed at once.
        travel: largest angle of either joint, where one muscle is fully active [rad].

    Raises:
        InvalidInput: a setting out of range, or what is no observation; nothing has changed then.
    """

    def __init__(
        self,
        model: PlanarMap,
        *,
        units: int = 20,
        width: float = 0.2,
        rate: float = 0.3,
        travel: float = 0.8 * np.pi,
    ) -> None:
        super().__init__(model)
        self.units = count(units, "units", least=2)
        self.width = scalar(width, "width", above=0.0)
        if self.width * self.units < 1.0:
            raise InvalidInput(f"units of width {width} leave gaps in a map of {units} along 2")
        self.rate = scalar(rate, "rate", above=0.0)
        if self.rate > 1.0:
            raise InvalidInput(f"rate must be at most 1, which removes an error at once: {rate}")
        self.travel = scalar(travel, "travel", above=0.0)
        self._maps = kernels.Maps(
            self.units, 0.5 / self.width**2, 0.5 * model.nominal.head.baseline
        )
        self._weights = np.zeros((2, 4, 3 * self.units**2))

    @property
    def n_weights(self) -> int:
        """Adjustable weights."""
        return self._weights.size

    @property
    def weights(self) -> Array:
        """By side of the elbow (-1, +1), muscle and unit, (2, 4, 3 units^2); a copy."""
        return self._weights.copy()

    def muscles(self, joints: Array) -> Array:
        """Activations (..., 4) that hold the arm at joint angles (..., 2): `(1 +- q / travel) / 2`.

        Both muscles of alpha come before those of beta; 0 is slack and 1 the most.
        """
        turned = 0.5 * joints / self.travel
        pairs = np.stack([0.5 + turned, 0.5 - turned], axis=-1)
        return pairs.reshape(*joints.shape[:-1], 4)

    def activations(self, targets: StereoTarget) -> Array:
        """The activations (N, 4) that the map generates for N targets."""
        generated = np.empty((len(targets), 4))
        kernels.activate_stream(self._maps, self._weights, _sights(targets), generated)
        return generated

    def __repr__(self) -> str:
        """Size and settings."""
        return (
            f"KupersteinMap({self.n_weights} weights, width {self.width}, rate {self.rate}, "
            f"{type(self.model).__name__})"
        )

    def _learn(self, observations: StereoObservation) -> tuple[Array, Booleans]:
        generated = np.empty((len(observations), 4))
        kernels.learn_stream(
            self._maps, self.rate, self._weights, _sights(observations.target),
            self.muscles(observations.joints), generated,
        )  # fmt: skip
        return self._joints(generated), np.zeros(len(observations), np.bool_)

    def _command(self, targets: StereoTarget) -> Array:
        return self._joints(self.activations(targets))

    def _joints(self, activations: Array) -> Array:
        """Where opposed muscles balance, (N, 2)."""
        return self.travel * (activations[:, 0::2] - activations[:, 1::2])


def _sights(targets: StereoTarget) -> Array:
    """Direction, distance and elbow, (N, 3)."""
    direction = targets.pointing + targets.eccentricity
    return np.stack([direction, targets.range, targets.elbow], axis=-1)
