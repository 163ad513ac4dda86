"""A parameter estimator as plain arrays and JSON-able settings."""

from dataclasses import asdict
from typing import Any

from handeye.arrays import Array, finite
from handeye.calibration.estimation.methods import Method, Recursive, Refit
from handeye.calibration.estimation.objectives import Assumptions
from handeye.calibration.estimation.parameter_estimator import ParameterEstimator
from handeye.calibration.estimation.parameters import Tolerances
from handeye.calibration.models import PlanarModel
from handeye.errors import FileFormatError

_METHODS: dict[str, type[Method]] = {"Recursive": Recursive, "Refit": Refit}


def estimator_to_arrays(estimator: ParameterEstimator) -> tuple[dict[str, Array], dict[str, Any]]:
    """What was learned, and the method with its settings.

    Raises InvalidInput for an estimator that is no longer finite.
    """
    arrays = {name: finite(array, name) for name, array in estimator.learner.arrays().items()}
    return arrays, {"kind": type(estimator.method).__name__, **asdict(estimator.method)}


def estimator_from_arrays(
    model: PlanarModel, arrays: dict[str, Array], settings: dict[str, Any]
) -> ParameterEstimator:
    """The estimator of `estimator_to_arrays`.

    Raises FileFormatError, or what Python raises where parts are missing or do not fit together.
    """
    fields = dict(settings)
    kind = fields.pop("kind")
    if kind not in _METHODS:
        raise FileFormatError(f"it estimates by an unknown method, {kind!r}")
    known = dict(fields.pop("assumptions"))
    tolerances, free = Tolerances(**known.pop("tolerances")), tuple(known.pop("free"))
    assumptions = Assumptions(tolerances=tolerances, free=free, **known)
    estimator = ParameterEstimator(model, _METHODS[kind](assumptions=assumptions, **fields))
    estimator.learner.restore({n: finite(a, n) for n, a in arrays.items()})
    return estimator
