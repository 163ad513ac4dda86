"""The compiled loops of sigma-pi units."""

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array, Integers
from handeye.networks.units import LARGEST

_SMALLEST = 1e-200


@compiled
def multiply(x: Array, factors: Integers, products: Array) -> None:
    """Products (T,), overwritten, of the inputs that factors (T, most) name; -1 names none."""
    for t in range(products.size):
        product = 1.0
        for i in factors[t]:
            if i >= 0:
                product *= x[i]
        products[t] = product


@compiled
def add_up(weights: Array, products: Array, out: Array) -> None:
    """Output (m,), overwritten: `I_k = sum_t w_kt a_t` (eq A.4)."""
    for k in range(out.size):
        total = 0.0
        for t in range(products.size):
            total += weights[k, t] * products[t]
        out[k] = total


@compiled
def predict_stream(weights: Array, factors: Integers, inputs: Array, outputs: Array) -> None:
    """Outputs (N, m), overwritten, at inputs (N, d)."""
    products = np.empty(len(factors))
    for n in range(len(inputs)):
        multiply(inputs[n], factors, products)
        add_up(weights, products, outputs[n])


@compiled
def differentiate(weights: Array, factors: Integers, x: Array, slopes: Array) -> None:
    """Slopes (m, d), overwritten, of the output in the inputs at x (d,), by the product rule."""
    slopes[:] = 0.0
    for t in range(len(factors)):
        for p in range(factors.shape[1]):
            if factors[t, p] < 0:
                continue
            others = 1.0
            for q in range(factors.shape[1]):
                if q != p and factors[t, q] >= 0:
                    others *= x[factors[t, q]]
            for k in range(len(weights)):
                slopes[k, factors[t, p]] += weights[k, t] * others


@compiled
def learn_stream(
    rate: float, weights: Array, factors: Integers, inputs: Array, targets: Array, errors: Array
) -> int:
    """Learn inputs (N, d), targets (N, m) one after the other: `delta w_kt = rate e_k a_t / |a|^2`.

    Products that are all too small to be squared teach nothing. Returns how many were learned: it
    stops before an error larger than LARGEST changes anything.
    """
    products = np.empty(len(factors))
    for n in range(len(inputs)):
        multiply(inputs[n], factors, products)
        error = errors[n]
        add_up(weights, products, error)
        for k in range(error.size):
            error[k] = targets[n, k] - error[k]
            if not np.abs(error[k]) <= LARGEST:
                return n
        squared = 0.0
        for t in range(products.size):
            squared += products[t] * products[t]
        if squared < _SMALLEST:
            continue
        for k in range(error.size):
            for t in range(products.size):
                weights[k, t] += rate * error[k] * (products[t] / squared)
    return len(inputs)
