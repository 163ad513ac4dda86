"""How well the parameters are known, and what the sightings do not tell, in words."""

from dataclasses import dataclass

import numpy as np

from handeye.arrays import Array, Integers
from handeye.calibration.estimation.gauges import Gauge, gauges
from handeye.calibration.estimation.parameters import NAMES
from handeye.calibration.plant import PlanarPlant

# A direction counts as determined once the sightings tell more about it than the tolerances do,
# which makes its information at least twice that of the priors.
_DETERMINED = np.sqrt(2.0)
# Share of a gauge direction that must be undetermined for it to be named, and smallest part of any
# other direction that is mentioned.
_RECOGNISED = 0.9
_MENTIONED = 0.3


@dataclass(frozen=True, eq=False)
class Knowledge:
    """Parameters with what is known about them.

    plant         the nominal plant with them
    parameters    (8,) in the order of NAMES, [m], [rad], and a number
    covariance    (8, 8); zeros for parameters that are not estimated
    condition     standard deviation of the least known direction over that of the best known, each
                  in tolerances
    undetermined  directions that the tolerances decide rather than the sightings
    """

    plant: PlanarPlant
    parameters: Array
    covariance: Array
    condition: float
    undetermined: tuple[str, ...]

    @property
    def std(self) -> Array:
        """Standard deviations (8,)."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def status(self) -> str:
        """What is determined, and what to do about the rest."""
        if not self.undetermined:
            return f"every parameter is determined (condition {self.condition:.3g})"
        lines = "; ".join(self.undetermined)
        return (
            f"not determined by these sightings, so that the tolerances decide: {lines}. Errors "
            "stay small where the hand has worked; elsewhere expect them to grow unless a "
            "direction is marked harmless. Add poses that spread wider, or fix a parameter"
        )


def knowledge(
    plant: PlanarPlant, parameters: Array, free: Integers, tolerances: Array, information: Array
) -> Knowledge:
    """Summarise a square root R (n, n) of the information, in tolerances (n,), priors included."""
    _, sizes, directions = np.linalg.svd(information)
    spread = tolerances[:, np.newaxis] * directions.T / sizes
    covariance = np.zeros((8, 8))
    covariance[np.ix_(free, free)] = spread @ spread.T
    open_directions = directions[sizes < _DETERMINED]
    return Knowledge(
        plant=plant,
        parameters=parameters,
        covariance=covariance,
        condition=float(sizes[0] / sizes[-1]),
        undetermined=_words(open_directions, gauges(parameters, free, tolerances), free),
    )


def _words(undetermined: Array, known: tuple[Gauge, ...], free: Integers) -> tuple[str, ...]:
    """Names for the space spanned by rows (k, n), in tolerances."""
    words: list[str] = []
    for gauge in known:
        inside = undetermined @ gauge.direction
        if np.linalg.norm(inside) > _RECOGNISED:
            words.append(gauge.words)
            # What is left of the space without it has one dimension less.
            rest = undetermined - np.outer(inside, inside @ undetermined) / (inside @ inside)
            undetermined = np.linalg.svd(rest)[2][: len(undetermined) - 1]
    for row in undetermined:
        parts = np.flatnonzero(np.abs(row) > _MENTIONED)
        order = parts[np.argsort(-np.abs(row[parts]))]
        words.append(" with ".join(NAMES[free[k]] for k in order))
    return tuple(dict.fromkeys(words))
