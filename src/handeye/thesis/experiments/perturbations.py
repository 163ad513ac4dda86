"""How far do the nonlinear perturbations move a point?

Section 3.4.4, figures 3.8, 3.9, 3.46, 3.47.
"""

import numpy as np

from handeye.arrays import Array
from handeye.calibration.plant import PlanarPlant
from handeye.calibration.world import Region
from handeye.thesis.experiment import Effort, Experiment, Quantities
from handeye.thesis.plants import LARGE, NORMAL

ANGULAR_RADIUS = 2.0
RADIAL_RANGE = 3.0


def largest_displacement(
    plant: PlanarPlant,
    replicate: int,  # noqa: ARG001 (nothing is random)
    effort: Effort,
) -> Quantities:
    """Largest displacement by each perturbation over its domain.

    Of a point at 2 m for angles, and at 3 m for the range. The pointing axis turns all the way, as
    the eye stands inside the workspace.
    """
    region, n = Region(), effort.of(10001)
    eccentricity = np.linspace(-region.eccentricity, region.eccentricity, n)

    def largest(errors: Array, radius: float = 1.0) -> float:
        return float(radius * np.max(np.abs(errors)))

    angles = {
        "alpha": plant.alpha.error(np.linspace(*region.alpha, n)),
        "beta": plant.beta.error(np.linspace(*region.beta, n)),
        "gamma": plant.gamma.error(np.linspace(-np.pi, np.pi, n)),
        "eccentricity": plant.head.eccentricity_error(np.full(n, ANGULAR_RADIUS), eccentricity),
    }
    ranges = plant.head.range_error(np.full(n, RADIAL_RANGE), eccentricity)
    moved = {name: largest(errors, ANGULAR_RADIUS) for name, errors in angles.items()}
    return {**moved, "range": largest(ranges)}


PERTURBATIONS = Experiment(
    id="perturbations",
    settings={"normal": NORMAL, "large": LARGE},
    measure=largest_displacement,
    deterministic=True,
)
