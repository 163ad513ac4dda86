"""Activation functions: how strongly a neuron answers its net excitation (section A.4).

A kind is a NamedTuple class with two compiled functions, registered below; a new one needs nothing
else. Its derivative is a function of the response, which is all that a trial keeps.
"""
# ruff: noqa: ARG001 (every implementation has the arguments of its declaration)

from typing import NamedTuple

import numpy as np

from handeye._compiled import by_kind


class Tanh(NamedTuple):
    """`o = tanh(gain e)`, between -1 and 1 (eq A.3)."""

    gain: float = 1.0


class Sigmoid(NamedTuple):
    """`o = (1 + tanh(gain e)) / 2`, between rest at 0 and 1 (eq A.1)."""

    gain: float = 1.0


class Linear(NamedTuple):
    """`o = gain e` (eq A.5). Layers of these alone are worth no more than one (eq A.6, A.7)."""

    gain: float = 1.0


@by_kind
def respond(activation: NamedTuple, excitation: float) -> float:
    """The response o to a net excitation e."""
    return excitation


@by_kind
def slope(activation: NamedTuple, o: float) -> float:
    """The derivative do/de where the response is o."""
    return o


@respond.of(Tanh)
def tanh(activation: Tanh, excitation: float) -> float:
    """Eq A.3."""
    return np.tanh(activation.gain * excitation)


@slope.of(Tanh)
def tanh_slope(activation: Tanh, o: float) -> float:
    """tanh' = 1 - tanh^2."""
    return activation.gain * (1.0 - o * o)


@respond.of(Sigmoid)
def sigmoid(activation: Sigmoid, excitation: float) -> float:
    """Eq A.1."""
    return 0.5 * (1.0 + np.tanh(activation.gain * excitation))


@slope.of(Sigmoid)
def sigmoid_slope(activation: Sigmoid, o: float) -> float:
    """(1 - tanh^2) / 2 with tanh = 2 o - 1."""
    return 2.0 * activation.gain * o * (1.0 - o)


@respond.of(Linear)
def linear(activation: Linear, excitation: float) -> float:
    """Eq A.5."""
    return activation.gain * excitation


@slope.of(Linear)
def linear_slope(activation: Linear, o: float) -> float:
    """Constant."""
    return activation.gain


ACTIVATIONS: dict[str, type] = {kind.__name__: kind for kind in (Tanh, Sigmoid, Linear)}
"""Every activation by name; a stored network finds its own here. Add yours."""
