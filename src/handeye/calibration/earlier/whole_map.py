"""What earlier hand-eye learners share: no kinematics, the whole map from sight to joints."""

from abc import ABC, abstractmethod

import numpy as np

from handeye.arrays import Array, Booleans
from handeye.calibration.calibrator import Feedback
from handeye.calibration.models import PlanarMap
from handeye.errors import InvalidInput
from handeye.observations import StereoObservation, StereoTarget


class WholeMap(ABC):
    """A calibrator of the planar robot that learns joint angles, not a correction of them.

    A subclass learns in `_learn` and commands in `_command`, both on N at a time. The model is used
    only for what the learner senses, and to state errors in metres.
    """

    def __init__(self, model: PlanarMap) -> None:
        self.model = model

    def observe(self, observation: StereoObservation) -> Feedback:
        """Learn from one observation; report the error made before learning."""
        feedback = self.observe_many(observation[np.newaxis])
        return Feedback(feedback.error[0], feedback.allocated[0])

    def observe_many(self, observations: StereoObservation) -> Feedback:
        """Learn from N observations in order: the same result as one by one."""
        commanded, allocated = self._learn(_many(observations))
        wrong = observations.joints - commanded
        return Feedback(self.model.displacement(observations, wrong), allocated)

    def errors(self, observations: StereoObservation) -> Array:
        """Errors (N, 2) [m] on N observations with the map as it is."""
        wrong = observations.joints - self._command(_many(observations).target)
        return self.model.displacement(observations, wrong)

    def command(self, target: StereoTarget) -> Array:
        """Joint angles (2,) for one target or (N, 2) for N, as far as they are known."""
        one = target.range.ndim == 0
        return self._command(target[np.newaxis])[0] if one else self._command(target)

    @abstractmethod
    def _learn(self, observations: StereoObservation) -> tuple[Array, Booleans]:
        """Learn; what would have been commanded before (N, 2), and what was allocated (N,)."""

    @abstractmethod
    def _command(self, targets: StereoTarget) -> Array:
        """Joint angles (N, 2)."""


def _many(observations: StereoObservation) -> StereoObservation:
    if observations.range.ndim == 0:
        raise InvalidInput("this is a single observation: give N of them, or call observe")
    return observations
