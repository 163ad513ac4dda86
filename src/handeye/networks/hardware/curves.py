"""Response functions as a chip tabulates them: over u = (distance / half-maximum distance)^2.

Over u every kind has one curve, whatever a neuron's width: it falls from 1 to 1/2 at u = 1.
"""
# ruff: noqa: ARG001 (every implementation has the arguments of its declaration)

from typing import Any, NamedTuple

import numpy as np

from handeye._compiled import by_kind
from handeye.arrays import Array
from handeye.networks.responses import Cosine, Gaussian, Parabolic

SPAN = 4
"""Curves that end, end at this u."""


@by_kind
def curve(response: NamedTuple, u: float) -> Any:
    """The response, a number, at u >= 0."""


@curve.of(Gaussian)
def gaussian(response: Gaussian, u: float) -> float:
    """Eq 3.45 is 2^-u."""
    return np.exp2(-u)


@curve.of(Cosine)
def cosine(response: Cosine, u: float) -> float:
    """Eq 3.107."""
    return 0.5 * (1.0 + np.cos(0.5 * np.pi * np.sqrt(u))) if u < SPAN else 0.0


@curve.of(Parabolic)
def parabolic(response: Parabolic, u: float) -> float:
    """Eq 3.108: its inner part is a straight line over u."""
    if u <= 1.0:
        return 1.0 - 0.5 * u
    rest = 1.0 - 0.5 * np.sqrt(u)
    return 2.0 * rest * rest if u < SPAN else 0.0


CURVES: dict[type, bool] = {Gaussian: True, Cosine: False, Parabolic: False}
"""The kinds that a chip has, and whether the response halves with each unit of u: then a table of
one unit and a shift give all of it."""


def squared_half_distances(response: NamedTuple, widths: Array) -> Array:
    """H^2 (N,) of neurons with width parameters R (N,) (note E7)."""
    return widths * np.log(2.0) if isinstance(response, Gaussian) else (0.5 * widths) ** 2


def response_table(response: NamedTuple, index_bits: int, word_length: int) -> Any:
    """The curve at 2^index_bits points per unit of u, in words with W - 1 fraction bits.

    Reading between two entries by a straight line adds at most half a step of a word if
    4^index_bits >= 2^(word_length - 4), since no curve bends by more than 1/2 per unit squared.
    """
    span = 1 if CURVES[type(response)] else SPAN
    at = np.linspace(0.0, span, span * 2**index_bits + 1)
    return _words([curve(response, u) for u in at], word_length - 1)


def reciprocal_table(index_bits: int, word_length: int) -> Any:
    """1 / s at 2^index_bits + 1 points from s = 1 to 2, in words with W fraction bits.

    Read between two entries by a straight line, within `reciprocal_error` of 1 / s.
    """
    at = np.linspace(1.0, 2.0, 2**index_bits + 1)
    return np.minimum(_words(1.0 / at, word_length), 2**word_length - 1)


def reciprocal_error(index_bits: int, word_length: int) -> float:
    """Largest distance of the table's 1 / s from the exact one; relative, it is twice that at most.

    The straight line is off by 2^(-2 index_bits - 2) where 1 / s bends most, at s = 1; the entries
    (the first, 1, is one step short of a word) and the result are rounded.
    """
    return 0.25 * 4.0**-index_bits + 1.5 * 2.0**-word_length


def _words(values: Any, fraction_bits: int) -> Any:
    return np.floor(np.asarray(values) * 2.0**fraction_bits + 0.5).astype(np.int64)
