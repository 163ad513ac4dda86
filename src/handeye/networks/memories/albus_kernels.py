"""The compiled loops of Albus's CMAC."""

from typing import NamedTuple

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array, Booleans, Integers

PRIME = 2**31 - 1
"""Hashes are numbers below it: a product of two of them fits into 64 bits."""

_SLOT_FACTOR, _NAME_FACTOR = 1_220_703_125, 630_360_016
FREE = -1


class Tiling(NamedTuple):
    """The mapping from inputs to cells.

    field          side of a receptive field, in scaled input units
    displacements  quanta by which each layer lies beside the one before, (d,)
    layers         C: cells that are active at a time, and quanta in a field
    per_layer      slots of the table that belong to a layer
    """

    field: float
    displacements: Integers
    layers: int
    per_layer: int


@compiled
def find_cells(tiling: Tiling, x: Array, slots: Integers, names: Integers) -> None:
    """The cell of each layer that holds x (d,): its slot in the table and its name, both (C,).

    An input is first cut into quanta of `field / C`. In layer l, input i of a cell covers the C
    quanta that have the same `(quantum + l displacement_i mod C) div C`. Both numbers are hashes of
    these coordinates and of the layer; that of the name is another one, so that two cells with one
    slot are told apart.
    """
    for layer in range(tiling.layers):
        slot = layer
        name = layer
        for i in range(x.size):
            quantum = int(np.floor(x[i] / tiling.field * tiling.layers))
            shift = (layer * tiling.displacements[i]) % tiling.layers
            tile = (quantum + shift) // tiling.layers
            slot = (slot * _SLOT_FACTOR + tile % PRIME) % PRIME
            name = (name * _NAME_FACTOR + tile % PRIME) % PRIME
        slots[layer] = layer * tiling.per_layer + slot % tiling.per_layer
        names[layer] = name


@compiled
def add_up(weights: Array, slots: Integers, out: Array) -> None:
    """Output (m,), overwritten: the sum of the active cells' weights (section A.6.4)."""
    out[:] = 0.0
    for slot in slots:
        for k in range(out.size):
            out[k] += weights[slot, k]


@compiled
def predict_stream(tiling: Tiling, weights: Array, inputs: Array, outputs: Array) -> None:
    """Outputs (N, m), overwritten, at inputs (N, d)."""
    slots = np.empty(tiling.layers, np.int64)
    names = np.empty(tiling.layers, np.int64)
    for n in range(len(inputs)):
        find_cells(tiling, inputs[n], slots, names)
        add_up(weights, slots, outputs[n])


@compiled
def learn_stream(
    tiling: Tiling,
    rate: float,
    weights: Array,
    owners: Integers,
    inputs: Array,
    targets: Array,
    errors: Array,
    allocated: Booleans,
) -> int:
    """Learn inputs (N, d), targets (N, m) one after the other (eq A.19).

    Returns how often an active cell's slot belonged to another cell.
    """
    slots = np.empty(tiling.layers, np.int64)
    names = np.empty(tiling.layers, np.int64)
    collisions = 0
    for n in range(len(inputs)):
        find_cells(tiling, inputs[n], slots, names)
        error = errors[n]
        add_up(weights, slots, error)
        for k in range(error.size):
            error[k] = targets[n, k] - error[k]
        for layer in range(tiling.layers):
            slot = slots[layer]
            for k in range(error.size):
                weights[slot, k] += rate * error[k] / tiling.layers
            if owners[slot] == FREE:
                owners[slot] = names[layer]
                allocated[n] = True
            elif owners[slot] != names[layer]:
                collisions += 1
    return collisions
