"""Every experiment of this version: one short file each, listed here."""

from typing import Any

from handeye.thesis.experiment import Experiment
from handeye.thesis.experiments.adaptation import ADAPTATION
from handeye.thesis.experiments.allocation import ALLOCATION
from handeye.thesis.experiments.catch_choices import CATCH_CHOICES, CATCH_DELAY
from handeye.thesis.experiments.catch_flights import CATCH_FLIGHTS
from handeye.thesis.experiments.catch_improved import CATCH_CHANGES, CATCH_IMPROVED
from handeye.thesis.experiments.catch_pid import CATCH_PID
from handeye.thesis.experiments.catching import CATCHING
from handeye.thesis.experiments.combined import (
    COMBINED,
    COMBINED_HEAT,
    COMBINED_KNOWLEDGE,
    COMBINED_MISFIT,
    COMBINED_SCALE,
    COMBINED_STEP,
)
from handeye.thesis.experiments.comparison import COMPARISON
from handeye.thesis.experiments.distortions import DISTORTIONS
from handeye.thesis.experiments.earlier import EARLIER
from handeye.thesis.experiments.estimation import ESTIMATION
from handeye.thesis.experiments.exact import EXACT
from handeye.thesis.experiments.excluded_region import EXCLUDED_REGION
from handeye.thesis.experiments.fixed_point import FIXED_POINT
from handeye.thesis.experiments.functions_back_propagation import BACK_PROPAGATION
from handeye.thesis.experiments.functions_influence import INFLUENCE
from handeye.thesis.experiments.functions_pairs import PAIRED_SERIES, PAIRED_SIGMOIDS
from handeye.thesis.experiments.functions_structured import FOURIER_STRUCTURED
from handeye.thesis.experiments.grids import GRIDS
from handeye.thesis.experiments.hardware import HARDWARE
from handeye.thesis.experiments.noise_example import NOISE_EXAMPLE
from handeye.thesis.experiments.noise_floor import NOISE_FLOOR
from handeye.thesis.experiments.periodic import PERIODIC
from handeye.thesis.experiments.perturbations import PERTURBATIONS
from handeye.thesis.experiments.preferred import PREFERRED
from handeye.thesis.experiments.real_arms import REAL_FR3, REAL_UR10, REAL_UR10_ORDER
from handeye.thesis.experiments.real_sockets import REAL_SOCKETS
from handeye.thesis.experiments.responses import RESPONSES
from handeye.thesis.experiments.scenarios import SCENARIOS
from handeye.thesis.experiments.step import STEP
from handeye.thesis.experiments.step_extremes import STEP_EXTREMES
from handeye.thesis.experiments.uncorrected import UNCORRECTED
from handeye.thesis.experiments.width import WIDTH

_ALL: tuple[Experiment[Any], ...] = (
    UNCORRECTED,
    PERTURBATIONS,
    DISTORTIONS,
    EXCLUDED_REGION,
    NOISE_FLOOR,
    NOISE_EXAMPLE,
    EXACT,
    PREFERRED,
    ALLOCATION,
    GRIDS,
    ADAPTATION,
    WIDTH,
    RESPONSES,
    FIXED_POINT,
    STEP,
    PERIODIC,
    STEP_EXTREMES,
    SCENARIOS,
    ESTIMATION,
    COMPARISON,
    CATCH_FLIGHTS,
    CATCHING,
    CATCH_PID,
    CATCH_IMPROVED,
    CATCH_CHANGES,
    CATCH_CHOICES,
    CATCH_DELAY,
    COMBINED,
    COMBINED_SCALE,
    COMBINED_STEP,
    COMBINED_HEAT,
    COMBINED_KNOWLEDGE,
    COMBINED_MISFIT,
    EARLIER,
    BACK_PROPAGATION,
    PAIRED_SIGMOIDS,
    PAIRED_SERIES,
    FOURIER_STRUCTURED,
    INFLUENCE,
    HARDWARE,
    REAL_UR10,
    REAL_UR10_ORDER,
    REAL_FR3,
    REAL_SOCKETS,
)

EXPERIMENTS = {experiment.id: experiment for experiment in _ALL}
