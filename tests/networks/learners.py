"""Every learner of the package, for the laws that all of them keep (test_every_learner.py).

Add yours to EVERY: a name and a function that makes a small fresh one from a seed. Inputs of the
suite lie in [-1, 1]^d, targets within about [-1, 1]^m; any d and m will do.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from safetensors import safe_open

from handeye.arrays import Array
from handeye.networks import (
    CMAC,
    FixedPoint,
    HardwareNetwork,
    Learner,
    ResourceAllocatingNetwork,
    VirtualNeuron,
)
from handeye.networks.layered import (
    LayeredNetwork,
    Sigmoid,
    Tanh,
    fourier_network,
    gaussian_network,
)
from handeye.networks.memories import AlbusCMAC, SigmaPi, monomials
from handeye.networks.recursive import KalmanNetwork, RecursiveNetwork


class Case(NamedTuple):
    """One learner: `make(seed)` gives a fresh one; `load` reads what its `save` wrote.

    `random` tells whether a fresh one depends on its seed.
    """

    name: str
    make: Callable[[int], Learner]
    load: Callable[[Any], Learner]
    random: bool = False


def chip(fixed: FixedPoint | None, adaptation: NamedTuple = VirtualNeuron()) -> HardwareNetwork:
    """One that goes on from neurons that a network has placed."""
    network = ResourceAllocatingNetwork(2, 3, capacity=20, adaptation=adaptation)
    rng = np.random.default_rng(5)
    network.learn_many(rng.uniform(-1.0, 1.0, (20, 2)), rng.uniform(-1.0, 1.0, (20, 3)))
    return HardwareNetwork.of(network, fixed)


EVERY = [
    Case("RAN", lambda _: ResourceAllocatingNetwork(2, 3), ResourceAllocatingNetwork.load),
    Case(
        "RAN of fixed size",
        lambda _: ResourceAllocatingNetwork(3, 1, capacity=8, adaptation=CMAC()),
        ResourceAllocatingNetwork.load,
    ),
    Case("chip of 16 bits", lambda _: chip(FixedPoint(16, 4.0, 4.0)), HardwareNetwork.load),
    Case(
        "chip that rounds at random",
        lambda _: chip(FixedPoint(12, 4.0, 4.0, rounding="random"), CMAC()),
        HardwareNetwork.load,
    ),
    Case("chip in double precision", lambda _: chip(None), HardwareNetwork.load),
    Case("Albus's CMAC", lambda _: AlbusCMAC(2, 3), AlbusCMAC.load),
    Case(
        "Albus's CMAC in a small table",
        lambda _: AlbusCMAC(3, 1, layers=5, slots=35, rate=1.0, displacements=(1, 2, 3)),
        AlbusCMAC.load,
    ),
    Case("sigma-pi", lambda _: SigmaPi(2, 3, monomials(2, 3)), SigmaPi.load),
    Case("gated", lambda _: SigmaPi(3, 1, [(0, 1), (2,)], rate=1.0), SigmaPi.load),
    Case(
        "layered",
        lambda seed: LayeredNetwork(2, 3, (6, 5), rng=np.random.default_rng(seed)),
        LayeredNetwork.load,
        random=True,
    ),
    Case(
        "layered of sigmoids",
        lambda seed: LayeredNetwork(
            3,
            1,
            (4,),
            activation=Sigmoid(),
            output=Tanh(),
            output_scale=3.0,
            rate=0.3,
            rng=np.random.default_rng(seed),
        ),
        LayeredNetwork.load,
        random=True,
    ),
    Case(
        "series of pairs",
        lambda _: fourier_network(-1.0, 1.0, 2, rate=0.01),
        LayeredNetwork.load,
    ),
    Case(
        "Gaussian pairs",
        lambda _: gaussian_network(-1.0, 1.0, 5),
        LayeredNetwork.load,
    ),
    Case(
        "recursive",
        lambda _: RecursiveNetwork(2, 3, capacity=20, relevance_samples=16),
        RecursiveNetwork.load,
    ),
    Case(
        "recursive in blocks",
        lambda _: RecursiveNetwork(
            3, 1, capacity=None, block=6, relevance_samples=None, forgetting=0.98
        ),
        RecursiveNetwork.load,
    ),
    Case(
        "recursive and pruned",
        lambda _: RecursiveNetwork(2, 2, capacity=12, prune_tolerance=0.05, relevance_samples=None),
        RecursiveNetwork.load,
    ),
    Case("Kalman", lambda _: KalmanNetwork(2, 3, capacity=20), KalmanNetwork.load),
    Case(
        "Kalman, full and pruned",
        lambda _: KalmanNetwork(
            3, 1, capacity=6, neighbours=3, forgetting=0.98, prune_tolerance=0.3
        ),
        KalmanNetwork.load,
    ),
]


def samples(learner: Learner, seed: int, n: int) -> tuple[Array, Array]:
    """Inputs (n, d) and noisy smooth targets (n, m) of the learner's shape."""
    rng = np.random.default_rng(seed)
    x = rng.uniform(-1.0, 1.0, size=(n, learner.n_inputs))
    phases = np.arange(learner.n_outputs)
    smooth = 0.7 * np.sin(2.0 * x.sum(axis=1, keepdims=True) + phases)
    return x, smooth + 0.1 * rng.normal(size=smooth.shape)


def state(learner: Learner, folder: Any) -> dict[str, Any]:
    """Everything that the learner would store, to the bit."""
    path = folder / "state"
    learner.save(path)
    # safetensors does not declare that it is a context manager.
    with safe_open(path, framework="numpy") as tensors:  # pyright: ignore[reportGeneralTypeIssues]
        names = list(tensors.keys())
        arrays = {name: tensors.get_tensor(name).tobytes() for name in names}
        return arrays | {"metadata": tensors.metadata()}
