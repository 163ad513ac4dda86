"""How do the thesis's estimator, today's and a network compare without noise and perturbations?

Section 3.6.2, figures 3.51 to 3.53.
"""

import numpy as np

from handeye.calibration.estimation import Recursive, Refit
from handeye.calibration.world import Region
from handeye.thesis.estimating import Estimating, estimation_curve
from handeye.thesis.experiment import Effort, Experiment, Quantities
from handeye.thesis.learning import Learning, learning_curve
from handeye.thesis.plants import LARGE, NORMAL

KINEMATIC = NORMAL.without_perturbations().without_noise()
LARGE_KINEMATIC = LARGE.without_perturbations().without_noise()

LOCAL = Region(
    alpha=(-np.pi / 3.0 - 0.1, -np.pi / 3.0 + 0.1),
    beta=(2.0 * np.pi / 3.0 - 0.1, 2.0 * np.pi / 3.0 + 0.1),
    eccentricity=0.05,
)
"""Where the hand stays in figure 3.53."""

PLACES = {
    "normal": (KINEMATIC, Region()),
    "large": (LARGE_KINEMATIC, Region()),
    "local": (KINEMATIC, LOCAL),
    "scale": (KINEMATIC.with_range_scale(0.9), Region()),
}
METHODS = {"forward": Refit("forward"), "reverse": Refit("reverse"), "modern": Recursive()}
NETWORKS = {"normal": 500, "large": 500, "local": 205}


def calibration_curve(setting: Learning | Estimating, replicate: int, effort: Effort) -> Quantities:
    """`learning_curve` or `estimation_curve`."""
    if isinstance(setting, Learning):
        return learning_curve(setting, replicate, effort)
    return estimation_curve(setting, replicate, effort)


ESTIMATION = Experiment(
    id="estimation",
    settings={
        **{
            f"{place}-{method}": Estimating(plant, how, region)
            for place, (plant, region) in PLACES.items()
            for method, how in METHODS.items()
        },
        **{
            f"{place}-network": Learning(
                PLACES[place][0], capacity, region=PLACES[place][1], trials=500, every=10, tests=100
            )
            for place, capacity in NETWORKS.items()
        },
        "normal-network-longer": Learning(KINEMATIC, 500, trials=1000, tests=100),
    },
    measure=calibration_curve,
)
