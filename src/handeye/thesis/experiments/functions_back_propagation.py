"""How does back-propagation through several layers do at the hand-eye correction?

Section 5.1.1, conclusion 1.
"""

from dataclasses import dataclass
from typing import NamedTuple

from handeye.calibration.calibrators import NetworkCorrection
from handeye.calibration.models import PlanarModel
from handeye.calibration.plant import PlanarPlant
from handeye.calibration.world import PlanarWorld
from handeye.networks.layered import LayeredNetwork, Sigmoid, Tanh
from handeye.observations import StereoObservation, StereoTarget
from handeye.randomness import stream
from handeye.thesis.experiment import Effort, Experiment, Quantities
from handeye.thesis.learning import performance
from handeye.thesis.plants import NOMINAL, NORMAL


@dataclass(frozen=True)
class Layered:
    """A network correction like that of `Learning`, by a network of layers.

    hidden        neurons of each hidden layer
    rate          eta of eq A.9
    activation    of hidden neurons
    output_scale  what an output neuron's answer of 1 means [rad]
    plant, trials, every, tests
                  as in Learning
    """

    hidden: tuple[int, ...]
    rate: float
    activation: NamedTuple = Tanh()  # noqa: RUF009 (immutable)
    output_scale: float = 0.1
    plant: PlanarPlant = NORMAL
    trials: int = 100_000
    every: int = 1000
    tests: int = 1000

    @property
    def world(self) -> PlanarWorld:
        """The robot at work."""
        return PlanarWorld(self.plant)

    def calibrator(self, replicate: int) -> NetworkCorrection[StereoObservation, StereoTarget]:
        """A fresh one."""
        model = PlanarModel(NOMINAL)
        network = LayeredNetwork(
            model.space.n_inputs,
            model.n_outputs,
            self.hidden,
            inputs=model.space,
            output_scale=self.output_scale,
            activation=self.activation,
            rate=self.rate,
            rng=stream("learner: first weights", replicate),
        )
        return NetworkCorrection(model, network)


def layered_curve(setting: Layered, replicate: int, effort: Effort) -> Quantities:
    """The curves of `learning_curve`, neurons left out."""
    curves = performance(setting, setting.calibrator(replicate), replicate, effort)
    return {name: curve for name, curve in curves.items() if name != "neurons"}


BACK_PROPAGATION = Experiment(
    id="back-propagation",
    settings={
        "one-layer": Layered((100,), rate=0.01),
        "small": Layered((20, 20), rate=0.01),
        "two-layers": Layered((50, 50), rate=0.005),
        "plain": Layered((50, 50), rate=0.1, activation=Sigmoid(), output_scale=1.0),
    },
    measure=layered_curve,
)
