"""Do neurons belong on a grid?

Section 3.5.2, figure 3.15.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from handeye.arrays import Array
from handeye.calibration.calibrators import NetworkCorrection
from handeye.networks import InputSpace, fixed_grid, variable_grid
from handeye.observations import StereoObservation, StereoTarget
from handeye.randomness import stream
from handeye.thesis.experiment import Curve, Effort, Experiment, Quantities
from handeye.thesis.learning import Learning, learning_curve
from handeye.thesis.plants import NORMAL

NEURONS = 568
FIXED = partial(fixed_grid, points_per_axis=8)
VARIABLE = partial(variable_grid, levels=4)

_ROUNDING = 1e-9


@dataclass(frozen=True)
class GridLearning(Learning):
    """A network whose hand first visits the poses of a grid, in order, and learns at each.

    grid  points (N, 3) in a box of alpha, beta and eccentricity, or None to begin at random
    """

    grid: Callable[[InputSpace], Array] | None = None

    def calibrator(self, replicate: int) -> NetworkCorrection[StereoObservation, StereoTarget]:
        """One that has made the visits."""
        calibrator = super().calibrator(replicate)
        if self.grid is not None:
            calibrator.observe_many(self.visits(self.grid, replicate))
        return calibrator

    def visits(self, grid: Callable[[InputSpace], Array], replicate: int) -> StereoObservation:
        """What is seen at the grid's poses, singular ones left out."""
        region = self.region
        travel = (region.alpha, region.beta, (-region.eccentricity, region.eccentricity))
        points = grid(InputSpace.box([low for low, _ in travel], [high for _, high in travel]))
        poses = points[np.abs(points[:, 1]) >= region.singular_beta - _ROUNDING]
        joints, eccentricity = poses[:, :2], poses[:, 2]
        noise = stream("learner: grid noise", replicate).standard_normal((len(poses), 2))
        seen = self.plant.sight(self.plant.tips(joints), eccentricity, noise)
        return StereoObservation(np.arange(len(poses), dtype=np.float64), joints, *seen)


def grid_curve(setting: GridLearning, replicate: int, effort: Effort) -> Quantities:
    """The curves of learning over random trials that follow the visits to the grid.

    Every placement meets the same trials. Neurons include those of the grid; `on_grid` is how many
    it would be given if their number were not limited.
    """
    curves = learning_curve(setting, replicate, effort)
    neurons = curves["neurons"]
    if setting.grid is None or not isinstance(neurons, Curve):
        return {**curves, "on_grid": 0.0}
    begun = setting.calibrator(replicate).network.n_neurons
    unlimited = replace(setting, capacity=None).calibrator(replicate)
    return {
        **curves,
        "neurons": Curve(neurons.at, neurons.value + begun),
        "on_grid": float(unlimited.network.n_neurons),
    }


GRIDS = Experiment(
    id="grids",
    settings={
        f"{placement}-{noise}{suffix}": GridLearning(
            plant, capacity=NEURONS, grid=grid, half_max_fraction=h, tests=500
        )
        for h, suffix in ((1.2, ""), (0.8, "-h-0.8"))
        for noise, plant in (("noisy", NORMAL), ("clean", NORMAL.without_noise()))
        for placement, grid in (("random", None), ("variable", VARIABLE), ("fixed", FIXED))
    },
    measure=grid_curve,
)
