"""Small networks and streams, shared by the tests of the network."""

import os

import numpy as np

from handeye.networks import InputSpace, ResourceAllocatingNetwork

D_IN, D_OUT = 2, 2


def make(kinds=None, **settings):
    if kinds is not None:
        settings |= kinds._asdict()
    space = InputSpace(*np.array([[-1, 0], [1, 3], [1.0, 2.0]]))
    return ResourceAllocatingNetwork(D_IN, D_OUT, inputs=space, **settings)


def fewer(n, plain):
    """n samples, or `plain` of them with compilation off, where each takes milliseconds."""
    return plain if os.environ.get("NUMBA_DISABLE_JIT") == "1" else n


def stream(seed, n):
    rng = np.random.default_rng(seed)
    x = rng.uniform([-1, 0], [1, 3], size=(n, D_IN))
    smooth = np.column_stack([np.sin(3 * x[:, 0]), x[:, 1] ** 2])
    return x, smooth + 0.1 * rng.normal(size=(n, D_OUT))


def state(network):
    """Everything that a network has learned, to the bit."""
    arrays = (network.centers, network.widths, network.weights)
    return network.n_neurons, network.trials, *(a.tobytes() for a in arrays)
