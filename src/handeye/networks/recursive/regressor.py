"""The recursive network as a scikit-learn estimator (extra "sklearn")."""

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, count
from handeye.networks.inputs import InputSpace
from handeye.networks.recursive.network import RecursiveNetwork
from handeye.networks.regressor import OnlineRegressor, input_scales


class RecursiveRegressor(OnlineRegressor):
    """Regression by recursive least squares over Gaussian neurons, in a batch or online.

    Targets are standardised by the first data seen, as in every OnlineRegressor. Scales of the
    inputs and the noise are estimated from the first samples, from all that `fit` is given if
    those are fewer than `relevance_samples` (but at least 2 d + 4).

    Args:
        scales: differences of each input that count as a distance of one until they are estimated,
            (d,); "auto" takes sqrt(d) standard deviations of the first data seen.
        capacity, block, noise_ratio, forgetting, distance_threshold, novelty, error_threshold: as
            in RecursiveNetwork, outputs counted in standard deviations.
        relevance_samples: how many first samples scales and noise are estimated from, or None to
            keep both.
        epochs: how often `fit` goes through the samples. More than once counts them more than once,
            so that the noise seems smaller than it is.
        random_state: None keeps the order of the samples; otherwise every pass of `fit` takes them
            in a random one. Random is better where neighbours in the list are alike.

    Attributes:
        network_: the RecursiveNetwork; it maps inputs to standardised targets.
        target_mean_, target_scale_: what standardises the targets, (m,).
        n_features_in_, feature_names_in_: as in every estimator.

    Raises:
        InvalidInput: in `fit` and `partial_fit`, a setting out of range.

    Example:
        RecursiveRegressor(capacity=300).fit(x, y).predict(x)
    """

    network_: RecursiveNetwork

    def __init__(
        self,
        *,
        scales: Literal["auto"] | ArrayLike = "auto",
        capacity: int | None = 1000,
        block: int = 1000,
        noise_ratio: float = 0.01,
        forgetting: float = 1.0,
        distance_threshold: float = 0.05,
        novelty: float = 0.01,
        error_threshold: float = 0.0,
        relevance_samples: int | None = 500,
        epochs: int = 1,
        random_state: int | np.random.RandomState | None = None,
    ) -> None:
        self.scales = scales
        self.capacity = capacity
        self.block = block
        self.noise_ratio = noise_ratio
        self.forgetting = forgetting
        self.distance_threshold = distance_threshold
        self.novelty = novelty
        self.error_threshold = error_threshold
        self.relevance_samples = relevance_samples
        self.epochs = epochs
        self.random_state = random_state

    def predict_deviation(self, X: ArrayLike) -> Array:
        """Standard deviation of the target around the prediction, of the shape of `predict`."""
        inputs = self._checked_inputs(X)
        deviation = np.sqrt(self.network_.variance_many(inputs)) * self.target_scale_
        return deviation.reshape(-1, *self._target_shape)

    def _network(self, inputs: Array, n_outputs: int) -> RecursiveNetwork:
        n, d = inputs.shape
        scales = input_scales(self.scales, inputs)
        if isinstance(self.scales, str):
            scales *= np.sqrt(d)
        first = self.relevance_samples
        if first is not None:
            first = min(count(first, "relevance_samples"), max(n, 2 * (d + 2)))
        return RecursiveNetwork(
            d,
            n_outputs,
            inputs=InputSpace.scaled(scales),
            capacity=self.capacity,
            block=self.block,
            noise_ratio=self.noise_ratio,
            forgetting=self.forgetting,
            distance_threshold=self.distance_threshold,
            novelty=self.novelty,
            error_threshold=self.error_threshold,
            relevance_samples=first,
        )
