"""What else changes when a network learns one sample?

Appendix A has every network in it learn by examples; this shows how each takes one to hold for
others.
"""

from collections.abc import Callable
from functools import partial
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array
from handeye.networks import (
    CMAC,
    InputSpace,
    ResourceAllocatingNetwork,
    VirtualNeuron,
    fixed_grid,
)
from handeye.networks.layered import LayeredNetwork, fourier_network
from handeye.networks.memories import AlbusCMAC, SigmaPi, monomials
from handeye.randomness import stream
from handeye.thesis.experiment import Curve, Effort, Experiment, Quantities

HERE = 0.2
_BOX = InputSpace.box([-1.0], [1.0])
_GRID = np.linspace(-1.0, 1.0, 801)


class Learner(Protocol):
    """The two verbs."""

    def predict_many(self, x: ArrayLike) -> Array:
        """Outputs (N, m)."""
        ...

    def learn_many(self, x: ArrayLike, target: ArrayLike) -> object:
        """Learn N samples in order."""
        ...


def gaussians(adaptation: NamedTuple) -> ResourceAllocatingNetwork:
    """Eleven Gaussian neurons on a grid, adjusted by a rule."""
    network = ResourceAllocatingNetwork(1, 1, inputs=_BOX, capacity=11, adaptation=adaptation)
    network.place(fixed_grid(_BOX, 11))
    return network


def influence(setting: Callable[[], Learner], replicate: int, effort: Effort) -> Quantities:
    """Curve over [-1, 1] of the change that a single sample at HERE makes, its own being one.

    Before it, the network learns a sine.
    """
    network = setting()
    rng = stream("functions: influence", replicate)
    x = rng.uniform(-1.0, 1.0, (effort.of(5000, least=500), 1))
    network.learn_many(x, np.sin(np.pi * x))
    spot = np.array([[HERE]])
    at = np.append(_GRID[:, np.newaxis], spot, axis=0)
    before = network.predict_many(at)[:, 0]
    network.learn_many(spot, [[before[-1] + 0.1]])
    change = network.predict_many(at)[:, 0] - before
    return {"change": Curve(_GRID, change[:-1] / change[-1])}


INFLUENCE = Experiment(
    id="influence",
    settings={
        "layered": partial(LayeredNetwork, 1, 1, (20,), largest_weight=1.0),
        "series": partial(fourier_network, -1.0, 1.0, 4, rate=0.01),
        "virtual": partial(gaussians, VirtualNeuron()),
        "cmac-rule": partial(gaussians, CMAC()),
        "albus": partial(AlbusCMAC, 1, 1, inputs=_BOX, field=0.5, layers=8),
        "sigma-pi": partial(SigmaPi, 1, 1, monomials(1, 5)),
    },
    measure=influence,
    deterministic=True,
)
