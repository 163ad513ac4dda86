"""The thesis's performance test of a learner, as a measure for experiments (section 3.4.6)."""

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from handeye.arrays import Array, Integers
from handeye.calibration.calibrators import NetworkCorrection, Nominal
from handeye.calibration.drift import Drift, steady
from handeye.calibration.models import PlanarMap, PlanarModel
from handeye.calibration.plant import PlanarPlant
from handeye.calibration.session import AnyCalibrator, WorldStreams, learn_in_world
from handeye.calibration.world import PlanarWorld, Region
from handeye.networks import Constant, Gaussian, ResourceAllocatingNetwork, VirtualNeuron
from handeye.observations import StereoObservation, StereoTarget
from handeye.randomness import stream
from handeye.thesis.experiment import Curve, Effort, Quantities
from handeye.thesis.plants import NOMINAL


@dataclass(frozen=True)
class Learning:
    """A network correction that starts from nominal kinematics on an unknown plant.

    plant       the actual robot
    capacity    most neurons of the preferred network (section 3.5.4), or None
    half_max_fraction, response, schedule, adaptation
                what differs from the preferred network
    placed      neurons placed at random poses before learning, with output weights of `weight`
    region      where the hand works
    foveate     the eye turns to the hand, and the network has no eccentricity input
    whole_map   the network learns joint angles without kinematics (section 3.5.9)
    drift       what becomes of the plant
    trials      training trials; `tests` poses are measured after every `every` of them
    """

    plant: PlanarPlant
    capacity: int | None = None
    half_max_fraction: float = 1.2
    response: NamedTuple = Gaussian()
    schedule: NamedTuple = Constant()
    adaptation: NamedTuple = VirtualNeuron()
    placed: int = 0
    weight: float = 0.001
    region: Region = Region()
    foveate: bool = False
    whole_map: bool = False
    drift: Drift = steady
    trials: int = 5000
    every: int = 100
    tests: int = 1000

    @property
    def world(self) -> PlanarWorld:
        """The robot at work."""
        return PlanarWorld(self.plant, self.region, self.foveate, self.drift)

    @property
    def model(self) -> PlanarModel | PlanarMap:
        """What the learner knows."""
        return PlanarMap(NOMINAL) if self.whole_map else PlanarModel(NOMINAL, self.foveate)

    def calibrator(self, replicate: int) -> NetworkCorrection[StereoObservation, StereoTarget]:
        """A fresh one."""
        model = self.model
        space = model.space
        network = ResourceAllocatingNetwork(
            space.n_inputs,
            model.n_outputs,
            inputs=space,
            capacity=self.capacity,
            half_max_fraction=self.half_max_fraction,
            response=self.response,
            schedule=self.schedule,
            adaptation=self.adaptation,
        )
        if self.placed:
            names = ("learner: placed poses", "learner: placed noise")
            poses, noise = (stream(name, replicate) for name in names)
            seen = self.world.observe(np.zeros(self.placed, np.int64), poses, noise)
            network.place(model.features(seen), weight=self.weight)
        return NetworkCorrection(model, network)


def learning_curve(setting: Learning, replicate: int, effort: Effort) -> Quantities:
    """Curves of the mean position error, its spread, the uncorrected error and the neurons."""
    return performance(setting, setting.calibrator(replicate), replicate, effort)


class Course(Protocol):
    """What a performance test needs to know of a setting."""

    @property
    def world(self) -> PlanarWorld:
        """The robot at work."""
        ...

    @property
    def trials(self) -> int:
        """Training trials."""
        ...

    @property
    def every(self) -> int:
        """Trials from test to test."""
        ...

    @property
    def tests(self) -> int:
        """Poses of a test."""
        ...


def performance(
    setting: Course, calibrator: AnyCalibrator, replicate: int, effort: Effort
) -> dict[str, Curve]:
    """The curves of `learning_curve` for a calibrator of any kind."""
    curve = learn_in_world(
        setting.world,
        calibrator,
        Nominal(PlanarModel(NOMINAL)),
        WorldStreams.of(replicate),
        trials=effort.of(setting.trials),
        every=effort.of(setting.every, least=1),
        tests=effort.of(setting.tests),
    )
    at = curve.trials.astype(float)

    def over_trials(values: Array | Integers) -> Curve:
        return Curve(at, values.astype(float))

    return {
        "error": over_trials(curve.mean),
        "spread": over_trials(curve.std),
        "uncorrected": over_trials(curve.uncorrected),
        "neurons": over_trials(curve.neurons),
    }
