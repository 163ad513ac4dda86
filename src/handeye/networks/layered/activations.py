"""Activation functions: how strongly a neuron answers its net excitation (section A.4).

A kind is a NamedTuple class with two compiled functions, registered below; a new one needs nothing
else. Its derivative is a function of the response, which is all that a trial keeps.
"""

from typing import NamedTuple

import numpy as np

from handeye._compiled import by_kind
from handeye.arrays import scalar
from handeye.errors import InvalidInput


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
def respond(activation: NamedTuple, excitation: float) -> float:  # noqa: ARG001 (a declaration)
    """The response o to a net excitation e."""
    return excitation


@by_kind
def slope(activation: NamedTuple, o: float) -> float:  # noqa: ARG001 (a declaration)
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
def linear_slope(activation: Linear, o: float) -> float:  # noqa: ARG001 (as declared)
    """Constant."""
    return activation.gain


ACTIVATIONS: dict[str, type] = {kind.__name__: kind for kind in (Tanh, Sigmoid, Linear)}
"""Every activation by name; a stored network finds its own here. Add yours."""


def checked_activation(role: str, kind: NamedTuple) -> NamedTuple:
    """`kind` with plain numbers in its fields.

    Raises InvalidInput unless it is an instance of a registered class with positive numbers.
    """
    if ACTIVATIONS.get(type(kind).__name__) is not type(kind):
        hint = f" (an instance, {kind.__name__}(), not the class)" if isinstance(kind, type) else ""
        raise InvalidInput(
            f"{role} must be one of {', '.join(sorted(ACTIVATIONS))}{hint}, got {kind!r}"
        )
    numbers = {
        name: scalar(value, f"{role} {name}", above=0.0) for name, value in kind._asdict().items()
    }
    return kind._replace(**numbers)
