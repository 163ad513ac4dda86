"""What does it cost to leave out the stretched arm?

Section 3.4.4.
"""

import numpy as np

from handeye.arrays import Array
from handeye.calibration.world import Region
from handeye.robots.planar import TwoLinkArm
from handeye.thesis.experiment import Effort, Experiment, Quantities
from handeye.thesis.plants import NOMINAL


def area(arm: TwoLinkArm, region: Region, betas: Array) -> float:
    """Area [m^2] that the hand reaches with |beta| in betas (N,), both elbows counted once.

    The hand at |beta| is at distance rho, with rho d rho = -a b sin(beta) d beta, and in direction
    alpha +- phi(beta): together the elbows sweep the travel of alpha and 2 phi more, at most a
    full turn. Holds for travel that is the same to both sides.
    """
    tips = arm.tips(np.stack([np.zeros_like(betas), betas], axis=-1))
    phi = np.arctan2(tips[:, 1], tips[:, 0])
    swept = np.minimum(region.alpha[1] - region.alpha[0] + 2.0 * phi, 2.0 * np.pi)
    return float(np.trapezoid(swept * arm.a * arm.b * np.sin(betas), betas))


def losses(
    arm: TwoLinkArm,
    replicate: int,  # noqa: ARG001 (nothing is random)
    effort: Effort,
) -> Quantities:
    """Fractions of the reach and of the area that are lost with the singular strip."""
    region, n = Region(), effort.of(10001)
    most = region.beta[1]
    whole = area(arm, region, np.linspace(0.0, most, n))
    left = area(arm, region, np.linspace(region.singular_beta, most, n))
    reach = float(np.linalg.norm(arm.tips(np.array([0.0, region.singular_beta]))))
    return {"radius": 1.0 - reach / arm.reach, "area": 1.0 - left / whole}


EXCLUDED_REGION = Experiment(
    id="excluded-region",
    settings={"nominal": NOMINAL.arm},
    measure=losses,
    deterministic=True,
)
