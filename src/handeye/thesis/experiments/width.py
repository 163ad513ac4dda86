"""How wide should a neuron be?

Section 3.5.6, figure 3.31.
"""

from dataclasses import dataclass

import numpy as np

from handeye.calibration.calibrator import Feedback
from handeye.calibration.calibrators import NetworkCorrection
from handeye.networks import LearningDiverged, VirtualNeuron
from handeye.observations import StereoObservation, StereoTarget
from handeye.thesis.experiment import Experiment
from handeye.thesis.learning import Learning, learning_curve
from handeye.thesis.plants import NORMAL

FRACTIONS = (0.1, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.5, 2.0, 4.0, 10.0, 100.0)
CLEAN = NORMAL.without_noise()

ALL_ACTIVE = VirtualNeuron(on_threshold=0.0)
"""Corrects every neuron that answers at all."""


class Unstoppable(NetworkCorrection[StereoObservation, StereoTarget]):
    """Stays as it was when its rule diverged, instead of raising.

    Its outputs are then near 1e100: finite, and wrapped to joint angles that may be any. So a
    diverged learner is recorded with the error of a hand that goes anywhere, nearly the reach.
    """

    def observe_many(self, observations: StereoObservation) -> Feedback:
        """What was learned before the rule diverged counts; the rest teaches nothing."""
        before = self.network.n_neurons
        try:
            return super().observe_many(observations)
        except LearningDiverged:
            n = len(observations)
            # Which of them were given a neuron is no longer known, only how many.
            allocated = np.arange(n) < self.network.n_neurons - before
            return Feedback(np.zeros((n, 2)), allocated)


@dataclass(frozen=True)
class RiskyLearning(Learning):
    """Learning under settings that may make it diverge."""

    def calibrator(self, replicate: int) -> Unstoppable:
        """One that lives on."""
        made = super().calibrator(replicate)
        return Unstoppable(made.model, made.network)


WIDTH = Experiment(
    id="width",
    settings={
        **{f"h-{h}": RiskyLearning(CLEAN, capacity=200, half_max_fraction=h) for h in FRACTIONS},
        **{
            f"all-active-h-{h}": RiskyLearning(
                CLEAN, capacity=200, half_max_fraction=h, adaptation=ALL_ACTIVE
            )
            for h in (0.1, 0.2, 0.4, 0.6)
        },
    },
    measure=learning_curve,
)
