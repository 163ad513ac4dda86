"""Does it help to begin as a Fourier series?

Section A.6.6: triangles, pulses and polynomials of one input, learned by the same
back-propagation from a structured and from a random beginning.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from handeye.arrays import Array
from handeye.networks import InputSpace, Power, ResourceAllocatingNetwork
from handeye.networks.layered import LayeredNetwork, fourier_network, gaussian_network
from handeye.randomness import stream
from handeye.thesis.experiment import Curve, Effort, Experiment, Quantities

ORDER = 4
NEURONS = fourier_network(-1.0, 1.0, ORDER).hidden[0]
TRIALS, MARKS = 20_000, 24
_GRID = np.linspace(-1.0, 1.0, 401)

Function = Callable[[Array], Array]
Learner = LayeredNetwork | ResourceAllocatingNetwork


def triangle(rng: np.random.Generator) -> Function:
    """Rises to one and falls to zero again, somewhere in [-1, 1]."""
    peak, half = rng.uniform(-0.5, 0.5), rng.uniform(0.3, 0.8)
    return lambda x: np.maximum(0.0, 1.0 - np.abs(x - peak) / half)


def pulse(rng: np.random.Generator) -> Function:
    """One over some interval, zero elsewhere."""
    middle, half = rng.uniform(-0.4, 0.4), rng.uniform(0.2, 0.5)
    return lambda x: np.where(np.abs(x - middle) < half, 1.0, 0.0)


def polynomial(rng: np.random.Generator) -> Function:
    """Of fifth degree, from zero to one over [-1, 1]."""
    legendre = np.polynomial.Legendre(rng.uniform(-1.0, 1.0, 6))
    low, high = legendre(_GRID).min(), legendre(_GRID).max()
    return lambda x: (legendre(x) - low) / (high - low)


def as_series(_: np.random.Generator) -> LayeredNetwork:
    """Pairs of a Fourier series with coefficients 1/n."""
    return fourier_network(-1.0, 1.0, ORDER, rate=0.01)


def at_random(rng: np.random.Generator) -> LayeredNetwork:
    """As many neurons with random weights."""
    return LayeredNetwork(1, 1, (NEURONS,), rate=0.1, largest_weight=1.0, rng=rng)


def as_gaussians(_: np.random.Generator) -> LayeredNetwork:
    """As many pairs, evenly spread."""
    return gaussian_network(-1.0, 1.0, NEURONS // 2, rate=0.01)


def allocating(_: np.random.Generator) -> ResourceAllocatingNetwork:
    """As many Gaussian neurons as there are pairs, added by eq 3.48."""
    space = InputSpace.box([-1.0], [1.0])
    return ResourceAllocatingNetwork(1, 1, inputs=space, capacity=NEURONS // 2, schedule=Power(0.5))


FUNCTIONS = {"triangle": triangle, "pulse": pulse, "polynomial": polynomial}
STARTS = {
    "series": as_series, "random": at_random, "gaussians": as_gaussians, "allocating": allocating,
}  # fmt: skip


@dataclass(frozen=True)
class Shaped:
    """A kind of function and how the network begins.

    Rates and first weights are the best for each beginning, over all three kinds of function, of
    those that were tried on replicates 100 to 104.
    """

    function: Callable[[np.random.Generator], Function]
    start: Callable[[np.random.Generator], Learner]


def function_error(setting: Shaped, replicate: int, effort: Effort) -> Quantities:
    """Curve of the rms error over [-1, 1]; functions go from zero to one.

    Every beginning meets the same function and the same inputs, evenly at random, without noise.
    """
    function = setting.function(stream("functions: shape", replicate))
    inputs = stream("functions: inputs", replicate)
    network = setting.start(stream("functions: first weights", replicate))
    trials = effort.of(TRIALS, least=200)
    spread = np.geomspace(trials / 200.0, trials, MARKS).round().tolist()
    marks = sorted({int(mark) for mark in spread})
    errors: list[float] = []
    for done, following in zip([0, *marks[:-1]], marks, strict=True):
        x = inputs.uniform(-1.0, 1.0, following - done)
        network.learn_many(x[:, np.newaxis], function(x)[:, np.newaxis])
        off = network.predict_many(_GRID[:, np.newaxis])[:, 0] - function(_GRID)
        errors.append(float(np.sqrt(np.mean(off**2))))
    return {"error": Curve(np.array(marks, np.float64), np.array(errors))}


FOURIER_STRUCTURED = Experiment(
    id="fourier-structured",
    settings={
        f"{function}-{start}": Shaped(FUNCTIONS[function], STARTS[start])
        for function in FUNCTIONS
        for start in STARTS
    },
    measure=function_error,
)
