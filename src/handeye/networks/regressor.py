"""The network as a scikit-learn estimator (extra "sklearn")."""

from typing import Any, Literal, NamedTuple, Self, cast

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, count, shaped
from handeye.errors import InvalidInput, MissingExtra
from handeye.networks.adaptation import VirtualNeuron
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


class RANRegressor(MultiOutputMixin, RegressorMixin, BaseEstimator):
    """Resource-allocating network regression, in a batch or online, with one output or many.

    Targets are standardised by the mean and standard deviation of the first data seen: all that
    `fit` is given, or the first batch of `partial_fit`, which should therefore be representative.
    So both thresholds are fractions of the targets' spread, whatever their unit, and far from all
    experience the prediction is the mean. With several outputs the error compared with a threshold
    is the norm of the standardised errors.

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
    target_mean_: Array
    target_scale_: Array

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
        _validation.check_is_fitted(self)
        inputs: Array = _validation.validate_data(self, X, dtype=np.float64, reset=False)
        outputs = self.network_.predict_many(inputs) * self.target_scale_ + self.target_mean_
        return outputs.reshape(-1, *self._target_shape)

    def _checked(self, X: ArrayLike, y: ArrayLike, *, first: bool) -> tuple[Array, Array]:
        options: dict[str, Any] = {"dtype": np.float64, "multi_output": True, "y_numeric": True}
        inputs, targets = _validation.validate_data(self, X, y, reset=first, **options)
        return inputs, np.asarray(targets, np.float64)

    def _begin(self, inputs: Array, targets: Array) -> None:
        """A network for these samples, which has learned nothing."""
        low, high = inputs.min(axis=0), inputs.max(axis=0)
        if isinstance(self.scales, str):
            if self.scales != "auto":
                raise InvalidInput(f'scales must be "auto" or an array, got {self.scales!r}')
            scales = _spread(inputs)
        else:
            scales = shaped(self.scales, (inputs.shape[1],), "scales")
        # An input that has not varied yet still needs a side of the box.
        still = high <= low
        space = InputSpace(low - 0.5 * scales * still, high + 0.5 * scales * still, scales)
        outputs = targets.reshape(len(targets), -1)
        self.network_ = ResourceAllocatingNetwork(
            inputs.shape[1],
            outputs.shape[1],
            inputs=space,
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
        self.target_mean_ = outputs.mean(axis=0)
        self.target_scale_ = _spread(outputs)
        self._target_shape = targets.shape[1:]

    def _learn(self, inputs: Array, targets: Array) -> None:
        outputs = targets.reshape(len(targets), -1)
        self.network_.learn_many(inputs, (outputs - self.target_mean_) / self.target_scale_)


def _spread(columns: Array) -> Array:
    """Standard deviation of each column of (N, n), 1 where it does not vary."""
    spread = columns.std(axis=0)
    return np.where(spread > 1e-12 * np.abs(columns).max(axis=0), spread, 1.0)
