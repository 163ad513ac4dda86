"""What an estimator minimises over N sightings, as problems for `levenberg_marquardt`."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal, NamedTuple, get_args

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array, Integers, scalar
from handeye.calibration.estimation.kernels import forward_rows, residual_rows, reverse_rows
from handeye.calibration.estimation.losses import LOSSES, Loss, curvature, rho, weight
from handeye.calibration.estimation.parameters import NAMES, Tolerances, indices, vector
from handeye.calibration.plant import PlanarPlant
from handeye.errors import InvalidInput
from handeye.observations import StereoObservation

Objective = Literal["forward", "reverse", "residuals"]
OBJECTIVES: tuple[Objective, ...] = get_args(Objective)

Rows = Callable[[Array, Array, Array, Array], None]


@dataclass(frozen=True)
class Assumptions:
    """What is taken for granted when residuals are weighed.

    tolerances     priors: independent normal distributions about the nominal parameters. They also
                   choose among parameters that no sighting can tell apart: turning the arm's base,
                   the eye and both zeros (O_alpha, O_gamma) together, and, with range_scale free,
                   growing every length together. Commands do not depend on the choice.
    free           names of the parameters to estimate; the others keep their nominal values
    range_error    standard deviation of what neither noise nor parameters explain [m]; added in
    bearing_error  quadrature to the head's, [rad]. A floor for heads without noise
    loss           robust loss of `losses`; soft_l1 keeps one minimum and bounds the influence of an
                   outlier
    loss_scale     residuals beyond this many standard deviations count less
    """

    tolerances: Tolerances = field(default_factory=Tolerances)
    free: tuple[str, ...] = NAMES
    range_error: float = 1e-4
    bearing_error: float = 1e-4
    loss: Loss = "soft_l1"
    loss_scale: float = 2.0

    def __post_init__(self) -> None:
        indices(self.free)
        scalar(self.range_error, "range_error", above=0.0)
        scalar(self.bearing_error, "bearing_error", above=0.0)
        scalar(self.loss_scale, "loss_scale", above=0.0)
        if self.loss not in LOSSES:
            raise InvalidInput(f"loss must be one of {', '.join(LOSSES)}, got {self.loss!r}")


def sightings(
    nominal: PlanarPlant, assumptions: Assumptions, observations: StereoObservation
) -> Array:
    """N observations as rows (N, 6) for the kernels, with the nominal head's noise."""
    out = np.empty((len(observations), 6))
    out[:, :2] = observations.joints
    out[:, 2] = observations.range
    out[:, 3] = observations.pointing + observations.eccentricity
    range_std = nominal.head.range_std(observations.range, observations.eccentricity)
    bearing_std = nominal.head.eccentricity_std(observations.eccentricity)
    out[:, 4] = np.hypot(range_std, assumptions.range_error)
    out[:, 5] = np.hypot(bearing_std, assumptions.bearing_error)
    return out


@compiled
def _weigh(loss: int, scale: float, values: Array, slopes: Array) -> float:
    """The robust cost of residuals (M,).

    They and their slopes (M, 8) are scaled so that 2 J^T r is the gradient of that cost and
    2 J^T J its curvature, kept positive.
    """
    cost = 0.0
    for i in range(len(values)):
        z = values[i] / scale
        cost += scale * scale * rho(loss, z)
        root = np.sqrt(curvature(loss, z))
        values[i] *= weight(loss, z) / root
        slopes[i, :] *= root
    return cost


class _Evaluated(NamedTuple):
    at: bytes
    cost: float
    residuals: Array
    jacobian: Array


class PlanarProblem:
    """An objective over sightings, as a function of the free parameters alone.

    Args:
        objective: `forward` and `reverse` are the thesis's scalar merit functions with unit
            weights and no priors; `residuals` are signed components over their standard deviations
            under a robust loss, followed by one row for each prior, `(nominal - p) / tolerance`.
        nominal: the plant with the parameters that stay, and the means of the priors.
        assumptions: the free parameters and, for `residuals`, all the rest.
        rows: sightings (N, 6).
    """

    def __init__(
        self, objective: Objective, nominal: PlanarPlant, assumptions: Assumptions, rows: Array
    ) -> None:
        self.free: Integers = indices(assumptions.free)
        self.nominal = vector(nominal)
        self.rows = rows
        self._assumptions = assumptions
        self._modern = objective == "residuals"
        kernels: dict[Objective, Rows] = {
            "forward": forward_rows,
            "reverse": reverse_rows,
            "residuals": residual_rows,
        }
        self._kernel = kernels[objective]
        self._last: _Evaluated | None = None

    def full(self, parameters: Array) -> Array:
        """All parameters (8,) from the free ones (n,)."""
        p = self.nominal.copy()
        p[self.free] = parameters
        return p

    def cost(self, parameters: Array) -> float:
        """Infinite where a length or the scale is not positive."""
        return self._evaluate(parameters).cost

    def residuals(self, parameters: Array) -> Array:
        """(N,), or weighted and with priors (2 N + n,)."""
        return self._evaluate(parameters).residuals

    def jacobian(self, parameters: Array) -> Array:
        """(N, n) or (2 N + n, n)."""
        return self._evaluate(parameters).jacobian

    def _evaluate(self, parameters: Array) -> _Evaluated:
        at = parameters.tobytes()
        if self._last is None or self._last.at != at:
            self._last = _Evaluated(at, *self._compute(parameters))
        return self._last

    def _compute(self, parameters: Array) -> tuple[float, Array, Array]:
        p = self.full(parameters)
        n = len(self.rows) * (2 if self._modern else 1)
        values, slopes = np.zeros(n), np.zeros((n, 8))
        if min(p[0], p[1], p[7]) <= 0.0:
            return np.inf, values, slopes[:, self.free]
        self._kernel(p, self.rows, values, slopes)
        if not self._modern:
            return float(values @ values), values, slopes[:, self.free]
        loss = LOSSES.index(self._assumptions.loss)
        cost = _weigh(loss, self._assumptions.loss_scale, values, slopes)
        std = self._assumptions.tolerances.std()[self.free]
        prior = (self.nominal[self.free] - parameters) / std
        jacobian = np.vstack([slopes[:, self.free], np.diag(-1.0 / std)])
        return cost + float(prior @ prior), np.concatenate([values, prior]), jacobian
