"""Nonlinear estimation put to the thesis's performance test (sections 3.4.6, 3.6.2)."""

from dataclasses import dataclass, field

import numpy as np

from handeye.arrays import Array
from handeye.calibration.drift import Drift, steady
from handeye.calibration.estimation import ParameterEstimator, Recursive, Refit
from handeye.calibration.models import PlanarModel
from handeye.calibration.plant import PlanarPlant
from handeye.calibration.world import PlanarWorld, Region
from handeye.geometry.angles import wrap
from handeye.thesis.experiment import Effort, Quantities
from handeye.thesis.learning import performance
from handeye.thesis.plants import NOMINAL


@dataclass(frozen=True)
class Estimating:
    """An estimator that starts from nominal parameters on an unknown plant.

    plant   the actual robot
    method  how it estimates
    region, drift, trials, every, tests
            as in Learning
    """

    plant: PlanarPlant
    method: Recursive | Refit = field(default_factory=Recursive)
    region: Region = Region()
    drift: Drift = steady
    trials: int = 500
    every: int = 10
    tests: int = 100

    @property
    def world(self) -> PlanarWorld:
        """The robot at work."""
        return PlanarWorld(self.plant, self.region, drift=self.drift)

    def calibrator(self, replicate: int) -> ParameterEstimator:  # noqa: ARG002 (nothing is drawn)
        """A fresh one."""
        return ParameterEstimator(PlanarModel(NOMINAL), self.method)


def estimation_curve(setting: Estimating, replicate: int, effort: Effort) -> Quantities:
    """The curves of `learning_curve` without neurons, and two numbers.

    first_error      mean position error at the first test after any training
    parameter_error  at the end
    """
    estimator = setting.calibrator(replicate)
    curves = performance(setting, estimator, replicate, effort)
    measured = {name: curve for name, curve in curves.items() if name != "neurons"}
    return {
        **measured,
        "first_error": float(curves["error"].value[1]),
        "parameter_error": parameter_error(estimator.plant, setting.plant),
    }


def parameter_error(estimated: PlanarPlant, actual: PlanarPlant) -> float:
    """Largest relative error of a parameter that sightings can tell.

    The base's x-axis is where alpha reads zero (table 3.1), and the range scale is taken to be 1;
    both choices concern no command.
    """
    found, right = settled(estimated), settled(actual)
    return float(np.max(np.abs(found - right) / np.abs(right)))


def settled(plant: PlanarPlant) -> Array:
    """a, b, v_x, v_y, O_beta, O_gamma (6,) of the same robot with O_alpha = 0 and range scale 1."""
    turn, scale = float(plant.alpha.offset), float(plant.head.range_scale)
    c, s = np.cos(turn), np.sin(turn)
    v_x, v_y = c * plant.v_x + s * plant.v_y, c * plant.v_y - s * plant.v_x
    lengths = scale * np.array([plant.arm.a, plant.arm.b, v_x, v_y])
    return np.concatenate([lengths, wrap(np.array([plant.beta.offset, plant.gamma.offset - turn]))])
