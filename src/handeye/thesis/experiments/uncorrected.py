"""How far off is a robot that trusts its nominal kinematics?

Sections 3.5.2, 3.5.9, 3.6.2.
"""

from handeye.calibration.calibrators import Nominal
from handeye.calibration.models import PlanarModel
from handeye.calibration.plant import PlanarPlant
from handeye.calibration.results import ErrorSummary
from handeye.calibration.session import WorldStreams, position_errors
from handeye.calibration.world import PlanarWorld
from handeye.thesis.experiment import Effort, Experiment, Quantities
from handeye.thesis.plants import LARGE, NOMINAL, NORMAL


def nominal_error(plant: PlanarPlant, replicate: int, effort: Effort) -> Quantities:
    """Mean position error on fresh poses."""
    nominal = Nominal(PlanarModel(NOMINAL))
    (errors,) = position_errors(
        PlanarWorld(plant), [nominal], 0, WorldStreams.of(replicate), effort.of(5000)
    )
    return {"error": ErrorSummary.of(errors).mean}


UNCORRECTED = Experiment(
    id="uncorrected",
    settings={
        "kinematic": NORMAL.without_perturbations().without_noise(),
        "full": NORMAL,
        "large-kinematic": LARGE.without_perturbations().without_noise(),
        "large-full": LARGE,
    },
    measure=nominal_error,
)
