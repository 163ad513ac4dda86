"""What benchmarks/networks.py compares."""
# ruff: noqa: D102 (the methods of every class are those of Contestant)

import math
from typing import Any, Protocol

import numba
import numpy as np
from river import neighbors
from sklearn.kernel_approximation import RBFSampler
from sklearn.linear_model import SGDRegressor

from handeye.networks import ResourceAllocatingNetwork

D, M = 5, 2
H, THETA_L, THETA_O, RATE, FLOOR = 1.2, 1e-3, 0.1, 0.06, 1e-6 * math.sqrt(D)


class Contestant(Protocol):
    """What is timed: x (D,) and y (M,), or (n, D) and (n, M) for many.

    Those for many raise NotImplementedError where a library has no such call.
    """

    name: str

    def learn(self, x: np.ndarray, y: np.ndarray) -> object: ...
    def predict(self, x: np.ndarray) -> np.ndarray: ...
    def learn_many(self, x: np.ndarray, y: np.ndarray) -> object: ...
    def predict_many(self, x: np.ndarray) -> np.ndarray: ...
    def bytes_per_neuron(self) -> float: ...


class Ours:
    """handeye.networks."""

    name = "ours"

    def __init__(self, size: int, x: np.ndarray, y: np.ndarray) -> None:
        self.network = ResourceAllocatingNetwork(D, M, capacity=size, error_threshold=0.0)
        self.network.learn_many(x, y)

    def learn(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return self.network.learn(x, y).error

    def predict(self, x: np.ndarray) -> np.ndarray:
        return self.network.predict(x)

    def learn_many(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return self.network.learn_many(x, y).error

    def predict_many(self, x: np.ndarray) -> np.ndarray:
        return self.network.predict_many(x)

    def bytes_per_neuron(self) -> float:
        return self.network.bytes_per_neuron


@numba.njit
def plain_outputs(C, R, W, x, z, o, out):
    """Eq 3.45 and 3.58, one neuron after the other."""
    out[:] = 0.0
    for j in range(len(R)):
        z[j] = 0.0
        for i in range(x.size):
            z[j] += (x[i] - C[j, i]) ** 2
        o[j] = math.exp(-z[j] / R[j])
        for k in range(out.size):
            out[k] += W[j, k] * o[j]


@numba.njit
def plain_predict(C, R, W, x, outputs):
    """Outputs (n, M) at inputs (n, D)."""
    z, o = np.empty(len(R)), np.empty(len(R))
    for i in range(len(x)):
        plain_outputs(C, R, W, x[i], z, o, outputs[i])


@numba.njit
def plain_learn(C, R, W, x, y, errors):
    """Eq 3.69."""
    z, o, v = np.empty(len(R)), np.empty(len(R)), np.empty(len(R))
    for i in range(len(x)):
        plain_outputs(C, R, W, x[i], z, o, errors[i])
        size, nearest = 0.0, np.inf
        for k in range(errors.shape[1]):
            errors[i, k] = y[i, k] - errors[i, k]
            size += errors[i, k] ** 2
        if math.sqrt(size) <= THETA_L:
            continue
        for j in range(len(R)):
            if o[j] > THETA_O:
                nearest = min(nearest, z[j])
        if nearest == np.inf:
            continue
        width = max(H * math.sqrt(nearest), FLOOR) ** 2 / math.log(2.0)
        overlap = 0.0
        for j in range(len(R)):
            if o[j] > THETA_O:
                v[j] = math.exp(-z[j] / width)
                overlap += v[j] * o[j]
        for j in range(len(R)):
            if o[j] > THETA_O:
                for k in range(errors.shape[1]):
                    W[j, k] += RATE * errors[i, k] * v[j] / overlap


class Plain:
    """The straightforward compiled loop."""

    name = "plain compiled"

    def __init__(self, network: ResourceAllocatingNetwork) -> None:
        self.state = (
            np.ascontiguousarray(network.centers), network.widths,
            np.ascontiguousarray(network.weights),
        )  # fmt: skip

    def learn(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return self.learn_many(x[np.newaxis], y[np.newaxis])[0]

    def predict(self, x: np.ndarray) -> np.ndarray:
        return self.predict_many(x[np.newaxis])[0]

    def learn_many(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        errors = np.empty_like(y)
        plain_learn(*self.state, x, y, errors)
        return errors

    def predict_many(self, x: np.ndarray) -> np.ndarray:
        outputs = np.empty((len(x), M))
        plain_predict(*self.state, x, outputs)
        return outputs

    def bytes_per_neuron(self) -> float:
        return sum(a.nbytes for a in self.state) / len(self.state[1])


class PlainNumPy(Plain):
    """The formulas over whole arrays."""

    name = "plain NumPy"

    def respond(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Squared distances and responses."""
        z = ((self.state[0] - x) ** 2).sum(axis=1)
        return z, np.exp(-z / self.state[1])

    def learn(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        z, o = self.respond(x)
        error = y - o @ self.state[2]
        if np.linalg.norm(error) > THETA_L:
            active = np.flatnonzero(o > THETA_O)
            if active.size:
                half = max(H * math.sqrt(z[active].min()), FLOOR)
                v = np.exp(-z[active] / (half**2 / math.log(2.0)))
                self.state[2][active] += np.outer(v, RATE * error / (v @ o[active]))
        return error

    def predict(self, x: np.ndarray) -> np.ndarray:
        return self.respond(x)[1] @ self.state[2]

    def learn_many(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.array([self.learn(x_i, y_i) for x_i, y_i in zip(x, y, strict=True)])

    def predict_many(self, x: np.ndarray) -> np.ndarray:
        return np.array([self.predict(x_i) for x_i in x])


class FourierSGD:
    """scikit-learn's RBFSampler and SGDRegressor.partial_fit."""

    name = "RBFSampler + SGD"
    chunk = 250  # samples whose features are held at a time

    def __init__(self, size: int, x: np.ndarray, y: np.ndarray) -> None:
        self.size = size
        self.features = RBFSampler(gamma=2.0, n_components=size, random_state=0).fit(x[:1])
        # The features have unit norm: a step corrects this part of the error, as in the network.
        step = {"alpha": 0.0, "learning_rate": "constant", "eta0": 0.1}
        self.models = [SGDRegressor(**step) for _ in range(M)]
        self.learn_many(x, y)

    def _update(self, x: np.ndarray, y: np.ndarray) -> None:
        phi = self.features.transform(x)
        for k, model in enumerate(self.models):
            model.partial_fit(phi, y[:, k])

    def learn(self, x: np.ndarray, y: np.ndarray) -> None:
        self._update(x[np.newaxis], y[np.newaxis])

    def predict(self, x: np.ndarray) -> np.ndarray:
        return self.predict_many(x[np.newaxis])[0]

    def learn_many(self, x: np.ndarray, y: np.ndarray) -> None:
        for start in range(0, len(x), self.chunk):
            self._update(x[start : start + self.chunk], y[start : start + self.chunk])

    def predict_many(self, x: np.ndarray) -> np.ndarray:
        parts = [x[start : start + self.chunk] for start in range(0, len(x), self.chunk)]
        phis = (self.features.transform(part) for part in parts)
        return np.vstack([np.column_stack([m.predict(phi) for m in self.models]) for phi in phis])

    def bytes_per_neuron(self) -> float:
        arrays = [self.features.random_weights_, self.features.random_offset_]
        return sum(a.nbytes for a in arrays + [m.coef_ for m in self.models]) / self.size


class Neighbours:
    """river's KNNRegressor; it has no calls for many samples, and learning only stores one."""

    name = "river KNN"

    def __init__(self, size: int, x: np.ndarray, y: np.ndarray) -> None:
        self.size = size
        self.models = [
            neighbors.KNNRegressor(5, neighbors.LazySearch(window_size=size)) for _ in range(M)
        ]
        for x_i, y_i in zip(x, y, strict=True):
            self._update(dict(enumerate(x_i.tolist())), y_i)

    def _update(self, features: dict[Any, float], y: np.ndarray) -> None:
        for model, target in zip(self.models, y.tolist(), strict=True):
            model.learn_one(features, target)

    def learn(self, x: np.ndarray, y: np.ndarray) -> None:
        self._update(dict(enumerate(x.tolist())), y)

    def predict(self, x: np.ndarray) -> np.ndarray:
        features: dict[Any, float] = dict(enumerate(x.tolist()))
        return np.array([model.predict_one(features) for model in self.models])

    def learn_many(self, x: np.ndarray, y: np.ndarray) -> None:
        raise NotImplementedError

    def predict_many(self, x: np.ndarray) -> np.ndarray:
        raise NotImplementedError

    def bytes_per_neuron(self) -> float:
        return sum(model._raw_memory_usage for model in self.models) / self.size
