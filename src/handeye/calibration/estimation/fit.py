"""Parameters from many sightings at once."""

from dataclasses import dataclass, replace

import numpy as np

from handeye.arrays import Array
from handeye.calibration.estimation.knowledge import Knowledge, knowledge
from handeye.calibration.estimation.levenberg_marquardt import (
    Solution,
    levenberg_marquardt,
    orthogonal,
)
from handeye.calibration.estimation.objectives import (
    OBJECTIVES,
    Assumptions,
    Objective,
    PlanarProblem,
    sightings,
)
from handeye.calibration.estimation.parameters import plant_with, vector
from handeye.calibration.plant import PlanarPlant
from handeye.errors import InvalidInput
from handeye.observations import StereoObservation


@dataclass(frozen=True, eq=False)
class Fit:
    """A solve over N sightings: the plant it gives, how it ended, and what is known by it.

    parameters (8,) in the order of NAMES. The thesis's objectives weigh nothing, so they leave
    `knowledge` None.
    """

    plant: PlanarPlant
    parameters: Array
    solution: Solution
    knowledge: Knowledge | None


def checked_objective(objective: Objective) -> Objective:
    """`objective`, or InvalidInput."""
    if objective not in OBJECTIVES:
        raise InvalidInput(f"objective must be one of {', '.join(OBJECTIVES)}, got {objective!r}")
    return objective


def fit_plant(
    nominal: PlanarPlant,
    observations: StereoObservation,
    objective: Objective = "residuals",
    assumptions: Assumptions | None = None,
) -> Fit:
    """Estimate a planar robot's parameters from N sightings of its hand, starting from nominal.

    Raises:
        InvalidInput: no sightings, an unknown objective, or a nominal plant that drifts.
    """
    known = assumptions or Assumptions()
    if not len(observations):
        raise InvalidInput("a fit needs sightings of the hand, got none")
    rows = sightings(nominal, known, observations)
    return fit_rows(nominal, rows, checked_objective(objective), known, vector(nominal))


def fit_rows(
    nominal: PlanarPlant, rows: Array, objective: Objective, known: Assumptions, start: Array
) -> Fit:
    """The same for rows (N, 6) of `sightings`, from parameters start (8,) on."""
    problem = PlanarProblem(objective, nominal, known, rows)
    begin = start[problem.free]
    if objective != "residuals":
        solution = levenberg_marquardt(problem, begin)
        parameters = problem.full(solution.parameters)
        return Fit(plant_with(nominal, parameters), parameters, solution, None)
    if known.loss != "squared":
        # Seen from a poor start every residual is an outlier; least squares finds a better one.
        plain = PlanarProblem(objective, nominal, replace(known, loss="squared"), rows)
        begin = levenberg_marquardt(plain, begin, direction=orthogonal).parameters
    solution = levenberg_marquardt(problem, begin, direction=orthogonal)
    parameters = problem.full(solution.parameters)
    plant = plant_with(nominal, parameters)
    tolerances = known.tolerances.std()[problem.free]
    information = np.linalg.qr(problem.jacobian(solution.parameters) * tolerances).R
    known_now = knowledge(plant, parameters, problem.free, tolerances, information)
    return Fit(plant, parameters, solution, known_now)
