"""Small trained networks for the tests of chips."""

import numpy as np

from handeye.networks import InputSpace, ResourceAllocatingNetwork

SPACE = InputSpace(
    np.array([-1.0, 0.0, -1.0]), np.array([1.0, 1.0, 1.0]), np.array([1.0, 0.5, 2.0])
)


def samples(seed, n):
    """Inputs of the box (n, 3) and targets (n, 2)."""
    rng = np.random.default_rng(seed)
    x = rng.uniform(SPACE.low, SPACE.high, (n, 3))
    return x, 0.5 * np.column_stack([np.sin(2.0 * x.sum(axis=1)), x[:, 0] * x[:, 1]])


def trained(n_neurons=40, **kinds):
    network = ResourceAllocatingNetwork(3, 2, inputs=SPACE, capacity=n_neurons, **kinds)
    network.learn_many(*samples(0, 4 * n_neurons))
    return network
