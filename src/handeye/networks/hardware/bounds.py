"""How far a chip in fixed point is at most from the same network in exact numbers."""

import numpy as np

from handeye.arrays import Array
from handeye.errors import InvalidInput
from handeye.networks.hardware.chip import HardwareNetwork
from handeye.networks.hardware.formats import step_of

RESPONSE_STEPS = 3.0
"""Steps of a word by which a response is off at most, given the squared distance (`fixed.py`)."""


def prediction_bound(chip: HardwareNetwork) -> Array:
    """Largest |output - exact output| (m,) at any input of the chip's box.

        sum_j |w_j| (delta_o + sqrt(d) delta_x / H_j) + N delta_w + delta_y

    delta_o is three steps of a response. Input and center are each half a step off in every
    direction, together sqrt(d) steps, and no response falls faster than 1 / H_j over the distance,
    H_j the neuron's half-maximum distance. delta_w and delta_y are half steps of weights and
    outputs. Every term halves with each bit of the word. Weights and outputs must not saturate,
    and neurons be at least two steps of an input wide.

    Raises:
        InvalidInput: a chip in floating point.
    """
    design = chip.design
    if design.fixed is None or design.ranges is None:
        raise InvalidInput("a chip in floating point has no words that could be counted")
    W = design.fixed.word_length
    weight_step = step_of(design.ranges.weights, W)
    gains = chip.cells.gains * 2.0 ** -chip.cells.shifts.astype(float)
    slopes = np.sqrt(chip.n_inputs * gains)  # sqrt(d) step / H_j
    off = RESPONSE_STEPS * 2.0 ** (1 - W) + slopes
    weights = np.abs(chip.weights) + 0.5 * weight_step
    return off @ weights + 0.5 * weight_step * chip.n_neurons + 0.5 * design.output_step
