"""A calibrator that learns what the robot's parameters really are (section 3.6)."""

import numpy as np

from handeye.arrays import Array
from handeye.calibration.calibrator import Feedback
from handeye.calibration.estimation.fit import Fit
from handeye.calibration.estimation.kernels import commanded_rows
from handeye.calibration.estimation.knowledge import Knowledge
from handeye.calibration.estimation.methods import (
    Learner,
    Method,
    Recursive,
    RecursiveLearner,
    RefitLearner,
)
from handeye.calibration.estimation.objectives import sightings
from handeye.calibration.estimation.parameters import NAMES, plant_with, vector
from handeye.calibration.models import PlanarModel
from handeye.calibration.plant import PlanarPlant
from handeye.errors import InvalidInput
from handeye.geometry.angles import wrap
from handeye.observations import StereoObservation, StereoTarget


class ParameterEstimator:
    """Commands a planar robot by a plant whose parameters follow from what was observed.

    A periodic error of an encoder in the nominal plant is left aside, as in
    `PlanarPlant.joints_for`; nothing but the parameters is learned.

    Args:
        model: nominal kinematics; its parameters are where the estimate starts, its head says how
            noisy sightings are.
        method: `Recursive` by default, or `Refit`, which is the thesis's.

    Raises:
        InvalidInput: a model of another kind, or a nominal plant that drifts.
    """

    def __init__(self, model: PlanarModel, method: Method | None = None) -> None:
        # Not every caller checks types.
        if not isinstance(model, PlanarModel):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InvalidInput(
                f"a ParameterEstimator needs a PlanarModel, whose parameters have names; for a "
                f"{type(model).__name__} use a NetworkCorrection"
            )
        self.model = model
        self.method = method or Recursive()
        self.learner: Learner = (
            RecursiveLearner(model.nominal, self.method)
            if isinstance(self.method, Recursive)
            else RefitLearner(model.nominal, self.method)
        )

    @property
    def parameters(self) -> Array:
        """The estimate (8,) in the order of NAMES: [m], [rad], and a number."""
        return self.learner.parameters.copy()

    @property
    def plant(self) -> PlanarPlant:
        """The nominal plant with the estimated parameters."""
        return plant_with(self.model.nominal, self.learner.parameters)

    def knowledge(self) -> Knowledge | None:
        """How well the parameters are known; None where the thesis's objectives do not say."""
        return self.learner.knowledge()

    @property
    def last_fit(self) -> Fit | None:
        """The last solve of a Refit with its status; None before it, and for Recursive."""
        return self.learner.last

    def observe(self, observation: StereoObservation) -> Feedback:
        """Learn from one observation; report the error made before learning."""
        feedback = self.observe_many(observation[np.newaxis])
        return Feedback(feedback.error[0], feedback.allocated[0])

    def observe_many(self, observations: StereoObservation) -> Feedback:
        """Learn from N observations in order: the same result as one by one."""
        if observations.joints.ndim != 2:
            raise InvalidInput("observe_many needs a leading axis; for one observation use observe")
        rows = sightings(self.model.nominal, self.method.assumptions, observations)

        def surprise(i: int, parameters: Array) -> float:
            one = slice(i, i + 1)
            error = self._errors(observations[one], rows[one], parameters[np.newaxis])
            return float(np.linalg.norm(error[0]))

        before = self.learner.learn(rows, surprise)
        error = self._errors(observations, rows, before)
        return Feedback(error, np.zeros(len(observations), np.bool_))

    def errors(self, observations: StereoObservation) -> Array:
        """Errors (N, 2) [m] on N observations with the parameters as they are."""
        rows = sightings(self.model.nominal, self.method.assumptions, observations)
        return self._errors(observations, rows, np.tile(self.parameters, (len(rows), 1)))

    def command(self, target: StereoTarget) -> Array:
        """Joint commands of the estimated plant for one target or N."""
        return self.plant.joints_for(target)

    def __repr__(self) -> str:
        """The method, and how far the parameters are from nominal."""
        moved = self.learner.parameters - vector(self.model.nominal)
        changes = ", ".join(
            f"{name} {change:+.3g}" for name, change in zip(NAMES, moved, strict=True) if change
        )
        return f"ParameterEstimator({type(self.method).__name__}, {changes or 'nominal'})"

    def _errors(self, observations: StereoObservation, rows: Array, parameters: Array) -> Array:
        """Displacement (N, 2) of the hand when each is commanded with its parameters (N, 8)."""
        commanded = np.empty((len(rows), 2))
        commanded_rows(parameters, rows, commanded)
        return self.model.displacement(observations, wrap(observations.joints - commanded))
