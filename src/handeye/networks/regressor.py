"""Networks as scikit-learn estimators (extra "sklearn")."""

from abc import abstractmethod
from typing import Any, Literal, NamedTuple, Self, cast

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, count, shaped
from handeye.errors import InvalidInput, MissingExtra
from handeye.networks.adaptation import VirtualNeuron
from handeye.networks.checked import CheckedLearner
from handeye.networks.inputs import InputSpace
from handeye.networks.network import ResourceAllocatingNetwork
from handeye.networks.responses import Gaussian
from handeye.networks.schedules import Constant

try:
    from sklearn.base import (  # pyright: ignore[reportMissingTypeStubs]
        BaseEstimator,
        MultiOutputMixin,
        RegressorMixin,
    )
    from sklearn.utils import validation  # pyright: ignore[reportMissingTypeStubs]
except ImportError as error:
    raise MissingExtra("RANRegressor", "sklearn") from error

# scikit-learn annotates little of it, and wrongly.
_validation = cast("Any", validation)


class OnlineRegressor(MultiOutputMixin, RegressorMixin, BaseEstimator):
    """A network behind the interface of scikit-learn, in a batch or online, one output or many.

    Targets are standardised by the mean and standard deviation of the first data seen: all that
    `fit` is given, or the first batch of `partial_fit`, which should therefore be representative.
    So thresholds are fractions of the targets' spread, whatever their unit, and far from all
    experience the prediction is the mean. A subclass says in `_network` which network learns.
    """

    network_: Any  # the learner of `_network`, of a kind that the subclass says
    target_mean_: Array
    target_scale_: Array
    epochs: int
    random_state: int | np.random.RandomState | None

    def fit(self, X: ArrayLike, y: ArrayLike) -> Self:
        """Forget everything and learn X (N, d), y (N,) or (N, m), in order."""
        epochs = count(self.epochs, "epochs")
        inputs, targets = self._checked(X, y, first=True)
        self._begin(inputs, targets)
        order: Any = slice(None)
        seed = self.random_state
        random = None if seed is None else _validation.check_random_state(seed)
        for _ in range(epochs):
            if random is not None:
                order = random.permutation(len(inputs))
            self._learn(inputs[order], targets[order])
        return self

    def partial_fit(self, X: ArrayLike, y: ArrayLike) -> Self:
        """Learn more samples, in order; the first call sets the scales of inputs and targets."""
        first = not hasattr(self, "network_")
        inputs, targets = self._checked(X, y, first=first)
        if first:
            self._begin(inputs, targets)
        elif targets.shape[1:] != self._target_shape:
            raise InvalidInput(
                f"y must have shape (N, {', '.join(map(str, self._target_shape))}) as in the first "
                f"call, got {targets.shape}"
            )
        self._learn(inputs, targets)
        return self

    def predict(self, X: ArrayLike) -> Array:
        """Predicted targets, (N,) if one was learned as a flat array, else (N, m)."""
        inputs = self._checked_inputs(X)
        outputs = self.network_.predict_many(inputs) * self.target_scale_ + self.target_mean_
        return outputs.reshape(-1, *self._target_shape)

    def _checked_inputs(self, X: ArrayLike) -> Array:
        _validation.check_is_fitted(self)
        return _validation.validate_data(self, X, dtype=np.float64, reset=False)

    def _checked(self, X: ArrayLike, y: ArrayLike, *, first: bool) -> tuple[Array, Array]:
        options: dict[str, Any] = {"dtype": np.float64, "multi_output": True, "y_numeric": True}
        inputs, targets = _validation.validate_data(self, X, y, reset=first, **options)
        return inputs, np.asarray(targets, np.float64)

    def _begin(self, inputs: Array, targets: Array) -> None:
        """A network for these samples, which has learned nothing."""
        outputs = targets.reshape(len(targets), -1)
        self.network_ = self._network(inputs, outputs.shape[1])
        self.target_mean_ = outputs.mean(axis=0)
        self.target_scale_ = spread(outputs)
        self._target_shape = targets.shape[1:]

    @abstractmethod
    def _network(self, inputs: Array, n_outputs: int) -> CheckedLearner:
        """A fresh network for inputs (N, d), the first."""

    def _learn(self, inputs: Array, targets: Array) -> None:
        outputs = targets.reshape(len(targets), -1)
        self.network_.learn_many(inputs, (outputs - self.target_mean_) / self.target_scale_)


class RANRegressor(OnlineRegressor):
    """Resource-allocating network regression, in a batch or online, with one output or many.

    Targets are standardised by the first data seen, as in every OnlineRegressor. With several
    outputs the error compared with a threshold is the norm of the standardised errors.

    Args:
        scales: differences of each input that count as a distance of one, (d,); "auto" takes the
            standard deviations in the first data seen.
        response, schedule, adaptation: as in ResourceAllocatingNetwork; None for its defaults.
        capacity: most neurons ever, or None for no limit.
        half_max_fraction: h: a new neuron answers one half at h times the distance to its nearest
            neighbour.
        error_threshold: a neuron may be added above this error, in standard deviations.
        learning_threshold: neurons are adjusted above this error, in standard deviations.
        first_width: half-maximum distance of the first neuron over h D, D the diagonal of the box
            of the first inputs.
        smallest_width: floor of every half-maximum distance, over D.
        epochs: how often `fit` goes through the samples; the later passes mostly adjust neurons and
            smooth out noise. `partial_fit` always goes once.
        random_state: None keeps the order of the samples; otherwise every pass of `fit` takes them
            in a random one.

    Attributes:
        network_: the ResourceAllocatingNetwork; it maps inputs to standardised targets.
        target_mean_, target_scale_: what standardises the targets, (m,).
        n_features_in_, feature_names_in_: as in every estimator.

    Raises:
        InvalidInput: in `fit` and `partial_fit`, a setting out of range.
        LearningDiverged: the learning rate is too large.

    Example:
        make_pipeline(PCA(3), RANRegressor(capacity=500)).fit(x, y).predict(x)
    """

    network_: ResourceAllocatingNetwork

    def __init__(
        self,
        *,
        scales: Literal["auto"] | ArrayLike = "auto",
        response: "NamedTuple | None" = None,
        schedule: "NamedTuple | None" = None,
        adaptation: "NamedTuple | None" = None,
        capacity: int | None = None,
        half_max_fraction: float = 1.2,
        error_threshold: float = 0.1,
        learning_threshold: float = 0.01,
        first_width: float = 0.1,
        smallest_width: float = 1e-6,
        epochs: int = 5,
        random_state: int | np.random.RandomState | None = None,
    ) -> None:
        self.scales = scales
        self.response = response
        self.schedule = schedule
        self.adaptation = adaptation
        self.capacity = capacity
        self.half_max_fraction = half_max_fraction
        self.error_threshold = error_threshold
        self.learning_threshold = learning_threshold
        self.first_width = first_width
        self.smallest_width = smallest_width
        self.epochs = epochs
        self.random_state = random_state

    def _network(self, inputs: Array, n_outputs: int) -> ResourceAllocatingNetwork:
        low, high = inputs.min(axis=0), inputs.max(axis=0)
        scales = input_scales(self.scales, inputs)
        # An input that has not varied yet still needs a side of the box.
        still = high <= low
        return ResourceAllocatingNetwork(
            inputs.shape[1],
            n_outputs,
            inputs=InputSpace(low - 0.5 * scales * still, high + 0.5 * scales * still, scales),
            response=Gaussian() if self.response is None else self.response,
            schedule=Constant() if self.schedule is None else self.schedule,
            adaptation=VirtualNeuron() if self.adaptation is None else self.adaptation,
            capacity=self.capacity,
            half_max_fraction=self.half_max_fraction,
            error_threshold=self.error_threshold,
            learning_threshold=self.learning_threshold,
            first_width=self.first_width,
            smallest_width=self.smallest_width,
        )


def input_scales(scales: Literal["auto"] | ArrayLike, inputs: Array) -> Array:
    """Scales (d,) as given, or the spread of inputs (N, d) for "auto"."""
    if not isinstance(scales, str):
        return shaped(scales, (inputs.shape[1],), "scales")
    if scales != "auto":
        raise InvalidInput(f'scales must be "auto" or an array, got {scales!r}')
    return spread(inputs)


def spread(columns: Array) -> Array:
    """Standard deviation of each column of (N, n), 1 where it does not vary."""
    deviation = columns.std(axis=0)
    return np.where(deviation > 1e-12 * np.abs(columns).max(axis=0), deviation, 1.0)
