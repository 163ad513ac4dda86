"""Rivals in benchmarks/online.py that are not in handeye: other people's, and published methods."""
# ruff: noqa: D102 (the methods of every class are those of Contestant)

from typing import Any, Protocol

import numba
import numpy as np
from river import neighbors, tree
from sklearn.kernel_approximation import RBFSampler
from sklearn.linear_model import SGDRegressor


class Contestant(Protocol):
    """What is compared: made from the first samples, taught x (n, d), y (n, m) in order."""

    def learn_many(self, x: np.ndarray, y: np.ndarray, /) -> object: ...
    def predict_many(self, x: np.ndarray, /) -> np.ndarray: ...


class FourierRLS:
    """Random Fourier features and recursive least squares in square-root form.

    Features `sqrt(2 / n) cos(W x + b)` (Rahimi and Recht 2007) of a Gaussian kernel; the square
    root S of the covariance, `P = S S^T`, after Potter (1963): `O(n^2)` a sample.
    """

    def __init__(self, d: int, m: int, n: int, scales: np.ndarray, ridge: float) -> None:
        rng = np.random.default_rng(0)
        self.directions = rng.normal(size=(d, n)) / scales[:, np.newaxis]
        self.phases = 2.0 * np.pi * rng.random(n)
        self.weights, self.root = np.zeros((n, m)), np.eye(n) / np.sqrt(ridge)

    def features(self, x: np.ndarray) -> np.ndarray:
        """(N, n)."""
        return np.sqrt(2.0 / len(self.phases)) * np.cos(x @ self.directions + self.phases)

    def learn_many(self, x: np.ndarray, y: np.ndarray) -> None:
        for start in range(0, len(x), 250):
            rows = slice(start, start + 250)
            potter(self.root, self.weights, self.features(x[rows]), y[rows])

    def predict_many(self, x: np.ndarray) -> np.ndarray:
        return self.features(x) @ self.weights


@numba.njit(fastmath=True)
def potter(root, weights, features, y):
    """Potter's update for samples one by one; noise of variance one."""
    n = len(root)
    f, gain = np.empty(n), np.empty(n)
    for s in range(len(y)):
        o = features[s]
        f[:] = 0.0
        for i in range(n):
            for j in range(n):
                f[j] += root[i, j] * o[i]
        alpha = 1.0 + (f * f).sum()
        beta = 1.0 / (alpha + np.sqrt(alpha))
        for i in range(n):
            gain[i] = (root[i] * f).sum()
        for k in range(y.shape[1]):
            step = (y[s, k] - (o * weights[:, k]).sum()) / alpha
            for i in range(n):
                weights[i, k] += step * gain[i]
        for i in range(n):
            step = beta * gain[i]
            for j in range(n):
                root[i, j] -= step * f[j]


class FourierSGD:
    """scikit-learn's RBFSampler and SGDRegressor.partial_fit, one for each output."""

    def __init__(self, d: int, m: int, n: int, scale: float, rate: float) -> None:
        gamma = 0.5 / (d * scale * scale)
        self.features = RBFSampler(gamma=gamma, n_components=n, random_state=0)
        self.features.fit(np.zeros((1, d)))
        self.models = [
            SGDRegressor(alpha=0.0, learning_rate="constant", eta0=rate) for _ in range(m)
        ]

    def learn_many(self, x: np.ndarray, y: np.ndarray) -> None:
        for start in range(0, len(x), 250):
            phi = self.features.transform(x[start : start + 250])
            for k, model in enumerate(self.models):
                model.partial_fit(phi, y[start : start + 250, k])

    def predict_many(self, x: np.ndarray) -> np.ndarray:
        phi = self.features.transform(x)
        return np.column_stack([model.predict(phi) for model in self.models])


class River:
    """A regressor of river, one for each output."""

    def __init__(self, m: int, kind: str) -> None:
        self.models: list[Any] = [
            neighbors.KNNRegressor(
                n_neighbors=5, engine=neighbors.LazySearch(window_size=1000),
                aggregation_method="weighted_mean",
            )
            if kind == "neighbours"
            else tree.HoeffdingAdaptiveTreeRegressor(seed=0)
            for _ in range(m)
        ]  # fmt: skip

    def learn_many(self, x: np.ndarray, y: np.ndarray) -> None:
        for x_i, y_i in zip(x, y, strict=True):
            named = dict(enumerate(x_i.tolist()))
            for model, target in zip(self.models, y_i.tolist(), strict=True):
                model.learn_one(named, target)

    def predict_many(self, x: np.ndarray) -> np.ndarray:
        named = [dict(enumerate(x_i.tolist())) for x_i in x]
        return np.array([[model.predict_one(one) for model in self.models] for one in named])


class XCSF:
    """xcsf: 1,000 rules of hyperellipsoids with linear models by recursive least squares."""

    def __init__(self, d: int, m: int, first: np.ndarray, spread: float) -> None:
        # It wants inputs between 0 and 1.
        self.low = first.min(axis=0) - 0.5
        self.width = first.max(axis=0) + 0.5 - self.low
        shape = {"min": 0.0, "max": 1.0, "spread_min": spread, "eta": 0.0}
        import xcsf  # noqa: PLC0415 (compiled, and it annotates nothing)

        library: Any = xcsf
        self.system = library.XCS(
            x_dim=d, y_dim=m, n_actions=1, pop_size=1000, max_trials=1, random_state=1,
            omp_num_threads=1, loss_func="mse", e0=0.01, beta=0.1,
            condition={"type": "hyperrectangle_csr", "args": shape},
            prediction={"type": "rls_linear", "args": {"x0": 1.0, "scale_factor": 1000.0,
                                                       "lambda": 1.0}},
        )  # fmt: skip
        self.begun = False

    def learn_many(self, x: np.ndarray, y: np.ndarray) -> None:
        self.system.set_params(max_trials=len(x))
        self.system.fit(
            (x - self.low) / self.width, y, shuffle=False, warm_start=self.begun, verbose=False
        )
        self.begun = True

    def predict_many(self, x: np.ndarray) -> np.ndarray:
        return np.asarray(self.system.predict((x - self.low) / self.width))
