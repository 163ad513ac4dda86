"""Sigma-pi units: weighted sums of products of inputs."""

from collections.abc import Sequence
from itertools import combinations_with_replacement
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, count, scalar, shaped
from handeye.errors import InvalidInput
from handeye.io.tensors import Parts
from handeye.networks.checked import CheckedLearner
from handeye.networks.memories import sigma_pi_kernels as kernels
from handeye.networks.outcomes import LearnedMany, LearningDiverged
from handeye.networks.units import LARGEST

Product = tuple[int, ...]
"""The inputs that are multiplied, counted from 0; an input may stand there more than once."""


def monomials(n_inputs: int, degree: int) -> tuple[Product, ...]:
    """Every product of at most `degree` of d inputs, from the empty one, which is 1.

    There are `binomial(d + degree, degree)`.
    """
    d, most = count(n_inputs, "n_inputs"), count(degree, "degree", least=0)
    return tuple(
        product
        for factors in range(most + 1)
        for product in combinations_with_replacement(range(d), factors)
    )


class SigmaPi(CheckedLearner):
    """m units whose inputs are products of the d inputs: a polynomial, learned online (eq A.4).

        I_k = sum_t w_kt a_t,    a_t = prod_p x_tp

    By such a product one input can gate another: it passes the other on while it is 1, and stops it
    while it is 0. For each sample with error e = target - output,

        delta w_kt = rate e_k a_t / sum_s a_s^2

    descends |e|^2 in the weights with a step that moves the output there by `rate e`, exactly.
    Where every product is 0 or 1 that is the rule of CMAC (eq A.19).

    Args:
        n_inputs: d.
        n_outputs: m.
        products: the inputs of each product; `monomials(d, degree)` makes a full polynomial.
        rate: in (0, 1].

    Raises:
        InvalidInput: a setting out of range, here or in any method an array of the wrong shape or
            type, with values that are not finite, or so large that a product may exceed 1e100;
            nothing has changed then.
        LearningDiverged: in learning, at the first sample whose error is beyond 1e100; the samples
            before it are learned.
    """

    FORMAT = "handeye.sigma-pi"

    def __init__(
        self, n_inputs: int, n_outputs: int, products: Sequence[Product], *, rate: float = 0.5
    ) -> None:
        super().__init__(n_inputs, n_outputs)
        self.products = tuple(
            tuple(count(i, "the input of a product", least=0) for i in product)
            for product in products
        )
        if not self.products:
            raise InvalidInput("give at least one product; the empty one, (), is always 1")
        unknown = {i for product in self.products for i in product} - set(range(self.n_inputs))
        if unknown:
            raise InvalidInput(f"products name inputs {sorted(unknown)} of only {n_inputs}, from 0")
        self.rate = scalar(rate, "rate", above=0.0)
        if self.rate > 1.0:
            raise InvalidInput(f"rate must be at most 1, which removes an error at once: {rate}")
        self.degree = max(map(len, self.products))
        self._factors = np.full((len(self.products), max(self.degree, 1)), -1, np.int64)
        for row, product in zip(self._factors, self.products, strict=True):
            row[: len(product)] = product
        self._weights = np.zeros((self.n_outputs, len(self.products)))

    @property
    def weights(self) -> Array:
        """One for each output and product, (m, T); a copy."""
        return self._weights.copy()

    @weights.setter
    def weights(self, value: ArrayLike) -> None:
        self._weights = shaped(value, self._weights.shape, "weights").copy()

    def gradient(self, x: ArrayLike) -> Array:
        """Derivatives (m, d) of the outputs in the inputs at one input (d,)."""
        slopes = np.empty((self.n_outputs, self.n_inputs))
        (one,) = self._inputs(shaped(x, (self.n_inputs,), "x")[np.newaxis])
        kernels.differentiate(self._weights, self._factors, one, slopes)
        return slopes

    def __repr__(self) -> str:
        """Shape, state and settings."""
        return (
            f"SigmaPi({self.n_inputs} inputs, {self.n_outputs} outputs, {len(self.products)} "
            f"products of up to {self.degree}, {self.trials} trials, rate {self.rate})"
        )

    def _inputs(self, x: Array) -> Array:
        largest = LARGEST ** (1.0 / max(self.degree, 1))
        if np.any(np.abs(x) > largest):
            raise InvalidInput(
                f"x must not exceed {largest:.3g}, so that products of {self.degree} stay in bounds"
            )
        return x

    def _predict(self, inputs: Array) -> Array:
        outputs = np.empty((len(inputs), self.n_outputs))
        kernels.predict_stream(self._weights, self._factors, inputs, outputs)
        return outputs

    def _learn(self, inputs: Array, targets: Array) -> LearnedMany:
        errors = np.empty_like(targets)
        done = kernels.learn_stream(
            self.rate, self._weights, self._factors, inputs, targets, errors
        )
        self._trials += done
        if done < len(inputs):
            raise LearningDiverged(
                f"the error at sample {done} is beyond all bounds, after samples whose products "
                "were next to nothing: scale the inputs to about one, or add the empty product"
            )
        return LearnedMany(errors, np.zeros(len(inputs), np.bool_))

    def _parts(self) -> Parts:
        settings = {"products": [list(p) for p in self.products], "rate": self.rate}
        return {"weights": self._weights}, {"n_inputs": self.n_inputs, "settings": settings}

    @classmethod
    def _restored(cls, arrays: dict[str, Array], rest: dict[str, Any]) -> Self:
        weights = arrays["weights"]
        units = cls(rest["n_inputs"], len(weights), **rest["settings"])
        units.weights = weights
        return units
