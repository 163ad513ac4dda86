"""Ways to estimate parameters while sightings come in: settings, and what they learn."""

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from handeye.arrays import Array, count, scalar
from handeye.calibration.estimation.fit import Fit, checked_objective, fit_rows
from handeye.calibration.estimation.knowledge import Knowledge, knowledge
from handeye.calibration.estimation.losses import LOSSES
from handeye.calibration.estimation.objectives import Assumptions, Objective
from handeye.calibration.estimation.parameters import THESIS, indices, plant_with, vector
from handeye.calibration.estimation.recursion import (
    Belief,
    Rules,
    ignorance,
    learn_stream,
    noticeable,
    parameters_at,
)
from handeye.calibration.plant import PlanarPlant
from handeye.errors import InvalidInput


@dataclass(frozen=True)
class Recursive:
    """Every sighting refines what is known, at a cost that does not grow; the default.

    assumptions  priors, free parameters, noise and loss
    drift        how far a parameter may wander from one sighting to the next: a standard deviation,
                 as a share of its tolerance. 0 says that nothing ever changes, and then a change
                 is taken for a long row of outliers
    """

    assumptions: Assumptions = field(default_factory=Assumptions)
    drift: float = 0.005

    def __post_init__(self) -> None:
        if not 0.0 <= scalar(self.drift, "drift") < 1.0:
            raise InvalidInput(f"drift must be at least 0 and below 1, got {self.drift}")


@dataclass(frozen=True)
class Refit:
    """Solve anew over kept sightings whenever one surprises, as the thesis does (section 3.6.2).

    The solve starts from the last estimate. The thesis's objectives give one equation for each
    sighting and have no priors, so they wait until there are as many as free parameters. They have
    local minima, so they are solved from nominal parameters too, and the lower cost is kept.

    objective        `forward` or `reverse` as in the thesis, or `residuals`
    error_threshold  a sighting that shows the hand at least this far off calls for a solve [m]; 0
                     solves every time (section 3.4.6)
    window           most sightings kept, the latest, which bounds the cost of a solve: a small one
                     is incremental, None is the batch over all trials so far, whose solves cost
                     more and more unless the threshold keeps them rare
    assumptions      as for Recursive; the thesis's objectives use the free parameters only

    Raises InvalidInput for settings that make no sense.
    """

    objective: Objective
    error_threshold: float = 1e-9
    window: int | None = None
    assumptions: Assumptions = field(default_factory=lambda: Assumptions(free=THESIS))

    def __post_init__(self) -> None:
        checked_objective(self.objective)
        scalar(self.error_threshold, "error_threshold", least=0.0)
        if self.window is not None and count(self.window, "window") < self.least:
            raise InvalidInput(
                f"{self.least} free parameters need a window of as many sightings, got "
                f"{self.window}"
            )

    @property
    def least(self) -> int:
        """Sightings that a solve needs."""
        return 1 if self.objective == "residuals" else len(self.assumptions.free)


Method = Recursive | Refit


class Surprise(Protocol):
    """How far off [m] a plant with parameters (8,) puts the hand in one of the sightings."""

    def __call__(self, i: int, parameters: Array) -> float:
        """In the i-th of those that are being learned."""
        ...


class Learner(Protocol):
    """What a method has learned about a nominal plant."""

    @property
    def parameters(self) -> Array:
        """The estimate (8,)."""
        ...

    def learn(self, rows: Array, surprise: Surprise) -> Array:
        """Learn from sightings (N, 6) in order; the parameters (N, 8) as each arrived."""
        ...

    def knowledge(self) -> Knowledge | None:
        """What is known, if the method says."""
        ...

    @property
    def last(self) -> Fit | None:
        """The last solve, for methods that solve anew."""
        ...

    def arrays(self) -> dict[str, Array]:
        """All that `restore` needs."""
        ...

    def restore(self, arrays: dict[str, Array]) -> None:
        """Continue from arrays; KeyError or ValueError where they do not fit."""
        ...


class RecursiveLearner:
    """A belief that sightings are folded into."""

    last = None

    def __init__(self, nominal: PlanarPlant, method: Recursive) -> None:
        known = method.assumptions
        free = indices(known.free)
        self._nominal = nominal
        start, tolerances = vector(nominal), known.tolerances.std()[free]
        self._rules = Rules(
            start,
            tolerances,
            free,
            noticeable(start, free, tolerances),
            LOSSES.index(known.loss),
            float(known.loss_scale),
            float(method.drift),
        )
        self._belief = ignorance(len(free))

    @property
    def parameters(self) -> Array:
        """As Learner."""
        p = np.empty(8)
        parameters_at(self._rules, self._belief.deviations, p)
        return p

    def learn(self, rows: Array, surprise: Surprise) -> Array:  # noqa: ARG002 (learns from all)
        """As Learner."""
        before = np.empty((len(rows), 8))
        learn_stream(self._rules, self._belief, rows, before)
        return before

    def knowledge(self) -> Knowledge:
        """As Learner."""
        p, rules = self.parameters, self._rules
        plant = plant_with(self._nominal, p)
        return knowledge(plant, p, rules.free, rules.tolerances, self._belief.R)

    def arrays(self) -> dict[str, Array]:
        """As Learner."""
        return self._belief._asdict()

    def restore(self, arrays: dict[str, Array]) -> None:
        """As Learner."""
        self._belief = restored(self._belief, arrays)


def restored(like: Belief, arrays: dict[str, Array]) -> Belief:
    """The belief in arrays, which must have the shapes of `like`."""
    parts = {name: np.array(arrays[name]) for name in like._fields}
    for name, old in like._asdict().items():
        if parts[name].shape != old.shape or parts[name].dtype != old.dtype:
            raise ValueError(f"{name} is {parts[name].dtype} of shape {parts[name].shape}")
    R = parts["R"]
    if np.tril(R, -1).any() or not np.diag(R).all():
        raise ValueError("R is not an invertible triangular matrix")
    return Belief(**parts)


class RefitLearner:
    """Kept sightings, and the parameters of the last solve.

    last  that solve, None before the first
    """

    def __init__(self, nominal: PlanarPlant, method: Refit) -> None:
        self._nominal = nominal
        self._method = method
        self._rows = np.empty((0, 6))
        self.parameters = vector(nominal)
        self.last: Fit | None = None

    def learn(self, rows: Array, surprise: Surprise) -> Array:
        """As Learner."""
        before = np.empty((len(rows), 8))
        method = self._method
        for i in range(len(rows)):
            before[i] = self.parameters
            kept = np.concatenate([self._rows, rows[i : i + 1]])
            self._rows = kept if method.window is None else kept[-method.window :]
            enough = len(self._rows) >= method.least
            if enough and surprise(i, self.parameters) >= method.error_threshold:
                self.last = self._solve()
                self.parameters = self.last.parameters
        return before

    def _solve(self) -> Fit:
        starts = [self.parameters]
        if self._method.objective != "residuals":
            starts.append(vector(self._nominal))
        known, objective = self._method.assumptions, self._method.objective
        fits = [fit_rows(self._nominal, self._rows, objective, known, start) for start in starts]
        return min(fits, key=lambda fit: fit.solution.cost)

    def knowledge(self) -> Knowledge | None:
        """As Learner: by the last solve."""
        return None if self.last is None else self.last.knowledge

    def arrays(self) -> dict[str, Array]:
        """As Learner."""
        return {"rows": self._rows, "parameters": self.parameters}

    def restore(self, arrays: dict[str, Array]) -> None:
        """As Learner."""
        rows, parameters = arrays["rows"], arrays["parameters"]
        if rows.shape != (len(rows), 6) or parameters.shape != (8,):
            raise ValueError(f"shapes {rows.shape} and {parameters.shape}")
        self._rows, self.parameters = np.array(rows), np.array(parameters)
