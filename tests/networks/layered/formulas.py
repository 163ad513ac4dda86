"""Back error propagation written the slow and obvious way (section A.6.2)."""

import numpy as np

from handeye.networks.layered import LayeredNetwork, Linear, Sigmoid, Tanh

ACTIVATIONS = {Tanh: lambda g, e: np.tanh(g * e), Linear: lambda g, e: g * e,
               Sigmoid: lambda g, e: 1.0 / (1.0 + np.exp(-2.0 * g * e))}  # fmt: skip
SLOPES = {Tanh: lambda g, e: g / np.cosh(g * e) ** 2, Linear: lambda g, e: g + 0.0 * e,
          Sigmoid: lambda g, e: 0.5 * g / np.cosh(g * e) ** 2}  # fmt: skip


def make(hidden=(4, 3), largest_weight=0.8, **settings):
    """Two inputs, three outputs."""
    rng = np.random.default_rng(0)
    return LayeredNetwork(2, 3, hidden, rng=rng, largest_weight=largest_weight, **settings)


def centred(network, x):
    """Inputs (N, d) with their box mapped to [-1, 1]."""
    low, high = network.inputs.low, network.inputs.high
    return (2.0 * np.asarray(x, float) - low - high) / (high - low)


def layers(network, x):
    """Excitations and answers of each layer at one input, the input itself as the first answer."""
    answers, excitations = [centred(network, x)], []
    weights = network.weights
    for i, block in enumerate(weights):
        kind = network.kinds.output if i == len(weights) - 1 else network.kinds.hidden
        excitations.append(block @ np.append(answers[-1], 1.0))
        answers.append(ACTIVATIONS[type(kind)](kind.gain, excitations[-1]))
    return excitations, answers


def output(network, x):
    return network.output_scale * layers(network, x)[1][-1]


def energy(network, x, target):
    """Eq A.8, outputs counted in their scale."""
    return 0.5 * np.sum(((target - output(network, x)) / network.output_scale) ** 2)


def steps(network, x, wanted):
    """The change of every weight by eq A.13 and A.14, `wanted` in the place of T - O (scaled)."""
    excitations, answers = layers(network, x)
    weights, changes = network.weights, []
    signal = np.asarray(wanted)
    for i in reversed(range(len(weights))):
        kind = network.kinds.output if i == len(weights) - 1 else network.kinds.hidden
        delta = SLOPES[type(kind)](kind.gain, excitations[i]) * signal
        changes.insert(0, network.rate * np.outer(delta, np.append(answers[i], 1.0)))
        signal = weights[i][:, :-1].T @ delta
    return changes
