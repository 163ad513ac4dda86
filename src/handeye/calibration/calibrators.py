"""Calibrators: what learns where the hand goes."""

from typing import Any, Generic, TypeVar

import numpy as np

from handeye.arrays import Array
from handeye.calibration.calibrator import Feedback
from handeye.calibration.models import AnyModel, Correct, HandEyeModel
from handeye.errors import InvalidInput
from handeye.networks import Learner, ResourceAllocatingNetwork
from handeye.observations import Observation, Target

Seen = TypeVar("Seen", bound=Observation)
Wanted = TypeVar("Wanted", bound=Target)


class Nominal(Generic[Seen, Wanted]):
    """Trusts the model and learns nothing: what every calibrator is compared with."""

    def __init__(self, model: HandEyeModel[Seen, Wanted]) -> None:
        self.model = model

    def observe(self, observation: Seen) -> Feedback:
        """Report the error of the nominal model for one observation."""
        feedback = self.observe_many(_batch(observation))
        return Feedback(feedback.error[0], feedback.allocated[0])

    def observe_many(self, observations: Seen) -> Feedback:
        """The same for N observations."""
        return Feedback(self.errors(observations), np.zeros(len(observations), np.bool_))

    def errors(self, observations: Seen) -> Array:
        """Errors (N, k) [m] of the nominal model on N observations."""
        return self.model.displacement(observations, self.model.needed(observations))

    def command(self, target: Wanted) -> Array:
        """Nominal joint commands for one target or N."""
        return _command(self.model, target, self._nothing)

    def __repr__(self) -> str:
        """The kind of model."""
        return f"Nominal({type(self.model).__name__})"

    def _nothing(self, inputs: Array) -> Array:
        return np.zeros((len(inputs), self.model.n_outputs))


class NetworkCorrection(Generic[Seen, Wanted]):
    """Adds a correction, learned by a network, to the model (section 3.5).

    Each observation gives the correction that would have been right, `needed = measured - nominal`;
    the network learns it as one sample (figure 3.5). A fresh network corrects nothing.

    Args:
        model: nominal kinematics and where the correction enters.
        network: any learner; by default the preferred resource-allocating network of section 3.5.4
            over the model's inputs, with the model's resolution as its error thresholds.

    Raises:
        InvalidInput: a network whose inputs or outputs do not fit the model.
    """

    def __init__(self, model: HandEyeModel[Seen, Wanted], network: Learner | None = None) -> None:
        space = model.space
        self.model = model
        # What else a network offers than every learner, those who chose it know.
        self.network: Any = network or ResourceAllocatingNetwork(
            space.n_inputs,
            model.n_outputs,
            inputs=space,
            error_threshold=model.resolution,
            learning_threshold=model.resolution,
        )
        have = (self.network.n_inputs, self.network.n_outputs)
        if have != (space.n_inputs, model.n_outputs):
            raise InvalidInput(
                f"{type(model).__name__} needs a network of {space.n_inputs} inputs and "
                f"{model.n_outputs} outputs, got {have[0]} and {have[1]}"
            )

    def observe(self, observation: Seen) -> Feedback:
        """Learn from one observation; report the error made before learning."""
        feedback = self.observe_many(_batch(observation))
        return Feedback(feedback.error[0], feedback.allocated[0])

    def observe_many(self, observations: Seen) -> Feedback:
        """Learn from N observations in order: the same result as one by one."""
        learned = self.network.learn_many(
            self.model.features(observations), self.model.needed(observations)
        )
        return Feedback(self.model.displacement(observations, learned.error), learned.allocated)

    def errors(self, observations: Seen) -> Array:
        """Errors (N, k) [m] on N observations with the network as it is."""
        given = self.network.predict_many(self.model.features(observations))
        return self.model.displacement(observations, self.model.needed(observations) - given)

    def command(self, target: Wanted) -> Array:
        """Corrected joint commands for one target or N."""
        return _command(self.model, target, self.network.predict_many)

    def __repr__(self) -> str:
        """The kind of model, and the network."""
        return f"NetworkCorrection({type(self.model).__name__}, {self.network!r})"


def _batch(one: Any) -> Any:
    """One observation or target as a batch of one."""
    return one[np.newaxis]


def _command(model: AnyModel, target: Any, correct: Correct) -> Array:
    try:
        len(target)
    except TypeError:
        return model.command(_batch(target), correct)[0]
    return model.command(target, correct)
