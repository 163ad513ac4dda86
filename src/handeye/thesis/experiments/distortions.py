"""What do the nonlinear perturbations look like over their domains?

Section 3.4.4, figures 3.8, 3.9, 3.46, 3.47.
"""

import numpy as np

from handeye.calibration.plant import PlanarPlant
from handeye.calibration.world import Region
from handeye.thesis.experiment import Curve, Effort, Experiment, Quantities
from handeye.thesis.experiments.perturbations import ANGULAR_RADIUS, RADIAL_RANGE
from handeye.thesis.plants import LARGE, NORMAL


def distortion_curves(
    plant: PlanarPlant,
    replicate: int,  # noqa: ARG001 (nothing is random)
    effort: Effort,
) -> Quantities:
    """The error [rad, m] of every measured quantity, as curves over what is measured [rad, m].

    Of the eccentricity for a point at 2 m, and of the range straight ahead.
    """
    region, n = Region(), effort.of(241, least=25)
    alpha, beta = np.linspace(*region.alpha, n), np.linspace(*region.beta, n)
    gamma = np.linspace(-np.pi, np.pi, n)
    eccentricity = np.linspace(-region.eccentricity, region.eccentricity, n)
    r = np.linspace(0.0, RADIAL_RANGE, n)
    off = plant.head.eccentricity_error(np.full(n, ANGULAR_RADIUS), eccentricity)
    return {
        "alpha": Curve(alpha, plant.alpha.error(alpha)),
        "beta": Curve(beta, plant.beta.error(beta)),
        "gamma": Curve(gamma, plant.gamma.error(gamma)),
        "eccentricity": Curve(eccentricity, off),
        "range": Curve(r, plant.head.range_error(r, np.zeros(n))),
    }


DISTORTIONS = Experiment(
    id="distortions",
    settings={"normal": NORMAL, "large": LARGE},
    measure=distortion_curves,
    deterministic=True,
)
