"""The compiled loops of a layered network: forward, backward, predict and learn.

All weights lie in one flat array, layer after layer. Layer l from n to m neurons is a block (m,
n + 1), a row for each neuron that it leads to; the last column is the weight of a neuron that
always answers 1, which makes it the threshold with its sign reversed (section A.6.2).
"""

from typing import NamedTuple

import numpy as np

from handeye._compiled import compiled, compiled_sums
from handeye.arrays import Array, Integers
from handeye.networks.layered.activations import respond, slope
from handeye.networks.units import LARGEST


class Kinds(NamedTuple):
    """What neurons are made of: those of hidden layers, and those of the output."""

    hidden: NamedTuple
    output: NamedTuple


@compiled_sums
def excitation(row: Array, answers: Array) -> float:
    """sum_k w_jk o_k and the threshold: row (n + 1,), answers (n,)."""
    total = row[answers.size]
    for k in range(answers.size):
        total += row[k] * answers[k]
    return total


@compiled
def forward(kinds: Kinds, sizes: Integers, weights: Array, answers: Array) -> None:
    """The answer of every neuron; `answers` holds the inputs first, and all layers in turn.

    Shapes: sizes (L + 1,) from inputs to outputs, answers (sum of sizes,).
    """
    first, start = 0, 0
    last = len(sizes) - 2
    for layer in range(last + 1):
        n, m = int(sizes[layer]), int(sizes[layer + 1])
        below = answers[first : first + n]
        first += n
        block = weights[start : start + m * (n + 1)].reshape(m, n + 1)
        start += block.size
        for j in range(m):
            e = excitation(block[j], below)
            if layer == last:
                answers[first + j] = respond(kinds.output, e)
            else:
                answers[first + j] = respond(kinds.hidden, e)


@compiled
def send_back(
    kinds: Kinds, sizes: Integers, weights: Array, answers: Array, signal: Array, rate: float
) -> None:
    """Propagate a signal from the outputs to the inputs, adjusting weights on the way.

    `signal` (sum of sizes,) holds -dE/do of the outputs at its end; everything before is
    overwritten with -dE/do of each neuron, down to the inputs. Weights move by
    `rate o_k f'_j(e_j) (-dE/do_j)` (eq A.12), each layer after the signal has passed it (A.14).
    """
    first, start = answers.size, weights.size
    last = len(sizes) - 2
    for layer in range(last, -1, -1):
        n, m = int(sizes[layer]), int(sizes[layer + 1])
        first -= m
        start -= m * (n + 1)
        block = weights[start : start + m * (n + 1)].reshape(m, n + 1)
        below = answers[first - n : first]
        back = signal[first - n : first]
        back[:] = 0.0
        for j in range(m):
            o = answers[first + j]
            if layer == last:
                delta = slope(kinds.output, o) * signal[first + j]
            else:
                delta = slope(kinds.hidden, o) * signal[first + j]
            row = block[j]
            for k in range(n):
                back[k] += row[k] * delta
            step = rate * delta
            for k in range(n):
                row[k] += step * below[k]
            row[n] += step


@compiled
def predict_stream(
    kinds: Kinds, sizes: Integers, weights: Array, scales: Array, inputs: Array, outputs: Array
) -> None:
    """Outputs (N, m), overwritten, at inputs (N, d); scales (m,) are what an answer of 1 means."""
    answers = np.empty(sizes.sum())
    d, m = sizes[0], sizes[-1]
    for i in range(len(inputs)):
        answers[:d] = inputs[i]
        forward(kinds, sizes, weights, answers)
        for k in range(m):
            outputs[i, k] = scales[k] * answers[answers.size - m + k]


@compiled
def learn_stream(
    kinds: Kinds,
    rate: float,
    sizes: Integers,
    weights: Array,
    scales: Array,
    inputs: Array,
    targets: Array,
    errors: Array,
) -> int:
    """Learn inputs (N, d) and targets (N, m) one after the other; errors (N, m) are overwritten.

    Returns how many were learned. Stops before the sample whose error is larger than LARGEST or no
    number at all.
    """
    answers = np.empty(sizes.sum())
    signal = np.empty(answers.size)
    d, m = sizes[0], sizes[-1]
    top = answers.size - m
    for i in range(len(inputs)):
        answers[:d] = inputs[i]
        forward(kinds, sizes, weights, answers)
        squared_error = 0.0
        for k in range(m):
            errors[i, k] = targets[i, k] - scales[k] * answers[top + k]
            signal[top + k] = errors[i, k] / scales[k]
            squared_error += errors[i, k] * errors[i, k]
        if not squared_error <= LARGEST * LARGEST:  # also if it is NaN
            return i
        send_back(kinds, sizes, weights, answers, signal, rate)
    return len(inputs)


@compiled
def learn_signal(
    kinds: Kinds, rate: float, sizes: Integers, weights: Array, x: Array, wanted: Array
) -> None:
    """Learn at one input (d,) from a wanted change (m,) of the answers, not from a target."""
    answers = np.empty(sizes.sum())
    signal = np.empty(answers.size)
    answers[: x.size] = x
    forward(kinds, sizes, weights, answers)
    signal[answers.size - wanted.size :] = wanted
    send_back(kinds, sizes, weights, answers, signal, rate)


@compiled
def input_slopes(kinds: Kinds, sizes: Integers, weights: Array, x: Array, slopes: Array) -> None:
    """Derivatives (m, d), overwritten, of every answer by every input at x (d,)."""
    answers = np.empty(sizes.sum())
    signal = np.empty(answers.size)
    answers[: x.size] = x
    forward(kinds, sizes, weights, answers)
    top = answers.size - len(slopes)
    for k in range(len(slopes)):
        signal[top:] = 0.0
        signal[top + k] = 1.0
        send_back(kinds, sizes, weights, answers, signal, 0.0)
        slopes[k] = signal[: x.size]
