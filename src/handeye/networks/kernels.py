"""The compiled loops of a network: evaluate, predict and learn."""

from typing import NamedTuple

import numpy as np

from handeye._compiled import compiled, compiled_sums
from handeye.arrays import Array, Booleans
from handeye.networks.adaptation import adapt
from handeye.networks.responses import respond, width
from handeye.networks.schedules import threshold
from handeye.networks.units import LARGEST, Settings, Units, Work

BLOCK = 512
"""Neurons handled at a time: their distances and responses stay in the first-level cache."""


@compiled_sums
def squared_distances(centers: Array, start: int, stop: int, x: Array, z: Array) -> float:
    """z = |x - c_j|^2 for neurons start to stop, x (d,), z overwritten; returns the smallest."""
    z[:] = 0.0
    for i in range(x.size):
        row = centers[i][start:stop]
        x_i = x[i]
        for j in range(z.size):
            z[j] += (row[j] - x_i) * (row[j] - x_i)
    # Doubles that are not negative sort like their bits, and a minimum of whole numbers fills the
    # vector units where a minimum of doubles does not.
    bits = z.view(np.int64)
    nearest = np.empty(1)
    nearest[0] = np.inf
    least = nearest.view(np.int64)
    for j in range(z.size):
        least[0] = min(least[0], bits[j])
    return nearest[0]


@compiled_sums
def weighted_sum(weights: Array, o: Array) -> float:
    """sum_j w_j o_j (eq 3.58)."""
    total = 0.0
    for j in range(o.size):
        total += weights[j] * o[j]
    return total


@compiled
def evaluate(
    response: NamedTuple, units: Units, n: int, x: Array, z: Array, o: Array, out: Array
) -> float:
    """Output of n neurons at x (eq 3.58), filling z and o (at least n) and out (m,).

    Rounding moves it from the exact value of the formula by less than
    `2^-53 sum_j |w_j| (n o_j + d + 12)`, a Gaussian response below exp(-708) counting as 0.
    Returns the squared distance to the nearest center, inf if there is none.
    """
    out[:] = 0.0
    nearest = np.inf
    for start in range(0, n, BLOCK):
        stop = min(start + BLOCK, n)
        part = squared_distances(units.centers, start, stop, x, z[start:stop])
        nearest = min(nearest, part)
        respond(response, z[start:stop], units.widths[start:stop], o[start:stop])
        for k in range(out.size):
            out[k] += weighted_sum(units.weights[k][start:stop], o[start:stop])
    return nearest


@compiled
def predict_stream(
    response: NamedTuple, units: Units, n: int, inputs: Array, outputs: Array
) -> None:
    """Outputs (N, m), overwritten, at inputs (N, d)."""
    z = np.empty(n)
    o = np.empty(n)
    for i in range(len(inputs)):
        evaluate(response, units, n, inputs[i], z, o, outputs[i])


@compiled
def nearest_stream(units: Units, n: int, inputs: Array, distances: Array) -> None:
    """Distances (N,), overwritten, from inputs (N, d) to the nearest center; inf if none."""
    z = np.empty(n)
    for i in range(len(inputs)):
        distances[i] = np.inf
        if n > 0:
            distances[i] = np.sqrt(squared_distances(units.centers, 0, n, inputs[i], z))


@compiled
def add_neuron(
    response: NamedTuple,
    settings: Settings,
    units: Units,
    n: int,
    x: Array,
    weights: Array,
    distance: float,
) -> None:
    """Make column n a neuron at x, sized by its distance to the nearest other (eq 3.46, 3.5.1)."""
    half_distance = settings.half_max_fraction * distance
    if n == 0:
        half_distance = settings.first_width * settings.half_max_fraction * settings.diameter
    smallest = settings.smallest_width * settings.diameter
    units.widths[n] = width(response, max(half_distance, smallest))
    units.centers[:, n] = x
    units.weights[:, n] = weights


@compiled
def learn_stream(
    response: NamedTuple,
    schedule: NamedTuple,
    rule: NamedTuple,
    settings: Settings,
    units: Units,
    work: Work,
    state: tuple[int, int, int],
    may_grow: bool,
    inputs: Array,
    targets: Array,
    errors: Array,
    allocated: Booleans,
) -> tuple[int, int, int]:
    """Learn inputs (N, d), targets (N, m) one after the other (section 3.5.2, A.6.3).

    state is (next sample, neurons, trials so far), and its new value is returned. Stops early,
    before the next sample changes anything, when the arrays are full and may grow, or when the
    error is larger than LARGEST or no number at all (a rule has diverged).
    """
    i, n, trials = state
    size = units.widths.size
    while i < len(inputs):
        if may_grow and n == size:
            break
        x = inputs[i]
        error = errors[i]
        distance = np.sqrt(evaluate(response, units, n, x, work.z, work.o, error))
        squared_error = 0.0
        for k in range(error.size):
            error[k] = targets[i, k] - error[k]
            squared_error += error[k] * error[k]
        if not squared_error <= LARGEST * LARGEST:  # also if it is NaN
            break
        trials += 1
        magnitude = np.sqrt(squared_error)
        allocated[i] = (
            magnitude > settings.error_threshold
            and n < size
            and distance > threshold(schedule, trials, settings.diameter)
        )
        if allocated[i]:
            add_neuron(response, settings, units, n, x, error, distance)
            n += 1
        elif magnitude > settings.learning_threshold:
            adapt(rule, response, settings, units, n, x, error, work)
        i += 1
    return i, n, trials


@compiled
def place_stream(
    response: NamedTuple,
    settings: Settings,
    units: Units,
    n: int,
    centers: Array,
    targets: Array,
    exact: bool,
) -> int:
    """Add a neuron at each of centers (N, d), whatever the thresholds; returns the new count.

    If exact, the output there becomes targets (N, m); otherwise targets are the weights.
    """
    z = np.empty(n + len(centers))
    o = np.empty(n + len(centers))
    weights = np.empty(targets.shape[1])
    for i in range(len(centers)):
        distance = np.sqrt(evaluate(response, units, n, centers[i], z, o, weights))
        for k in range(weights.size):
            weights[k] = targets[i, k] - weights[k] if exact else targets[i, k]
        add_neuron(response, settings, units, n, centers[i], weights, distance)
        n += 1
    return n
