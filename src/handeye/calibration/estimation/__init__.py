"""Nonlinear estimation of a planar robot's parameters (section 3.6), and the thesis's solver."""

from handeye.calibration.estimation.fit import Fit as Fit
from handeye.calibration.estimation.fit import fit_plant as fit_plant
from handeye.calibration.estimation.knowledge import Knowledge as Knowledge
from handeye.calibration.estimation.levenberg_marquardt import Problem as Problem
from handeye.calibration.estimation.levenberg_marquardt import Solution as Solution
from handeye.calibration.estimation.levenberg_marquardt import Status as Status
from handeye.calibration.estimation.levenberg_marquardt import (
    levenberg_marquardt as levenberg_marquardt,
)
from handeye.calibration.estimation.methods import Recursive as Recursive
from handeye.calibration.estimation.methods import Refit as Refit
from handeye.calibration.estimation.objectives import Assumptions as Assumptions
from handeye.calibration.estimation.parameter_estimator import (
    ParameterEstimator as ParameterEstimator,
)
from handeye.calibration.estimation.parameters import NAMES as NAMES
from handeye.calibration.estimation.parameters import THESIS as THESIS
from handeye.calibration.estimation.parameters import Tolerances as Tolerances
