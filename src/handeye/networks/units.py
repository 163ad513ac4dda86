"""The arrays of a network, laid out so that one input is compared with many centers at a time."""

from typing import NamedTuple

import numpy as np

from handeye.arrays import Array, Integers, shaped
from handeye.errors import InvalidInput

LARGEST = 1e100
"""Largest scaled input, target or error: squares and their sums stay far inside the doubles."""


class Units(NamedTuple):
    """All neurons: column j of each array is neuron j; columns past the last neuron are free.

    centers (d, size) in scaled input units, widths (size,), weights (m, size).
    """

    centers: Array
    widths: Array
    weights: Array


class Settings(NamedTuple):
    """The numbers of a network that never change (section 3.5.4).

    half_max_fraction   h: half-maximum distance over distance to the nearest neighbour
    error_threshold     theta_e: |error| above which a neuron may be allocated
    learning_threshold  theta_l: |error| above which neurons are adapted
    first_width         half-maximum distance of the first neuron over h D
    smallest_width      no neuron, real or virtual, has a half-maximum distance below this times D
    diameter            D: diagonal of the scaled input space
    """

    half_max_fraction: float
    error_threshold: float
    learning_threshold: float
    first_width: float
    smallest_width: float
    diameter: float


class Work(NamedTuple):
    """Scratch for one input: squared distances z, responses o, and room for a rule; all (size,)."""

    z: Array
    o: Array
    a: Array
    b: Array
    c: Array
    indices: Integers


def moderate(values: Array, name: str) -> Array:
    """`values` unless some are larger than LARGEST, then InvalidInput."""
    # The sum of squares is by far the fastest to find, and nearly always small enough.
    if not np.vdot(values, values) <= LARGEST**2 and np.any(np.abs(values) > LARGEST):
        raise InvalidInput(f"{name} must not exceed {LARGEST:g}: their squares would overflow")
    return values


def allocate_units(n_inputs: int, n_outputs: int, size: int) -> Units:
    """Room for `size` neurons."""
    return Units(np.zeros((n_inputs, size)), np.zeros(size), np.zeros((n_outputs, size)))


def allocate_work(size: int) -> Work:
    """Scratch for as many neurons; kept between samples, since asking for memory takes longer."""
    z, o, a, b, c = np.empty((5, size))
    return Work(z, o, a, b, c, np.empty(size, np.int64))


def with_room(units: Units, n: int, needed: int) -> Units:
    """The units, or the first n of them in arrays doubled until `needed` fit."""
    size = units.widths.size
    if needed <= size:
        return units
    while size < needed:
        size *= 2
    more = allocate_units(len(units.centers), len(units.weights), size)
    for old, new in zip(units, more, strict=True):
        new[..., :n] = old[..., :n]
    return more


def restored(stored: Units, room: Units, capacity: int | None) -> Units:
    """`room`, grown where capacity allows, holding stored neurons.

    Raises InvalidInput if they do not fit in or together, or are not those of a working network.
    """
    n = np.size(stored.widths)
    if capacity is not None and n > capacity:
        raise InvalidInput(f"{n} neurons exceed the capacity of {capacity}")
    widths = shaped(stored.widths, (n,), "widths")
    if not np.all(widths > 0.0):
        raise InvalidInput("widths must be positive")
    units = with_room(room, 0, n)
    centers = shaped(stored.centers, (len(room.centers), n), "centers")
    units.centers[:, :n] = moderate(centers, "centers")
    units.widths[:n] = widths
    units.weights[:, :n] = shaped(stored.weights, (len(room.weights), n), "weights")
    return units
