"""The compiled loops of a Kalman network: respond, linearise around the neighbours, correct."""

import numpy as np

from handeye._compiled import compiled, compiled_sums
from handeye.arrays import Array, Booleans
from handeye.networks.kernels import weighted_sum
from handeye.networks.recursive.kalman_filter import correct, linearise, move, see
from handeye.networks.recursive.kalman_units import LEAST_WIDTH, Settings, Shared, Units, Work
from handeye.networks.recursive.units import NOISE_WINDOW
from handeye.networks.responses import Gaussian, respond


@compiled_sums
def distances(centers: Array, precision: Array, n: int, x: Array, z: Array) -> float:
    """z (n,) = squared distances from x (d,) to the centers, in the scales of now; the least."""
    z[:n] = 0.0
    for i in range(x.size):
        row, x_i, weight = centers[i][:n], x[i], precision[i]
        for j in range(n):
            z[j] += weight * (row[j] - x_i) * (row[j] - x_i)
    nearest = np.inf
    for j in range(n):
        nearest = min(nearest, z[j])
    return nearest


@compiled
def evaluate(units: Units, shared: Shared, n: int, x: Array, work: Work, out: Array) -> float:
    """Outputs (m,), overwritten, at x (d,); fills work.z and work.o, returns the least z."""
    nearest = distances(units.centers, shared.precision, n, x, work.z)
    respond(Gaussian(), work.z[:n], units.widths[:n], work.o[:n])
    for k in range(out.size):
        out[k] = weighted_sum(units.weights[k, :n], work.o[:n])
    return nearest


@compiled
def strongest(n: int, work: Work) -> int:
    """Fill work.which with the neurons of the largest responses, in no order; returns how many."""
    found = min(n, work.which.size)
    weakest = 0
    for j in range(n):
        if j < found:
            work.which[j] = j
        elif work.o[j] > work.o[work.which[weakest]]:
            work.which[weakest] = j
        else:
            continue
        if j >= found - 1:
            for a in range(found):
                if work.o[work.which[a]] < work.o[work.which[weakest]]:
                    weakest = a
    return found


@compiled
def add(units: Units, settings: Settings, j: int, trials: int, x: Array, weights: Array,
        distance: float) -> None:  # fmt: skip
    """Neuron j at x (d,) with weights (m,), as wide as the overlap says, at most one scale."""
    m, d = len(units.weights), x.size
    h = max(min(settings.overlap * distance, 1.0), LEAST_WIDTH)
    units.centers[:, j], units.weights[:, j], units.widths[j] = x, weights, 2.0 * h * h
    units.prior[j, :m] = settings.weight_deviation
    units.prior[j, m : m + d] = settings.shape_deviation * h
    units.prior[j, m + d] = settings.shape_deviation
    units.roots[j] = np.diag(units.prior[j])
    units.use[j], units.born[j] = 0.0, trials


@compiled
def least_useful(units: Units, n: int, trials: int) -> tuple[int, float]:
    """The neuron of the least mean squared contribution to the outputs since it came."""
    least, which = np.inf, 0
    for j in range(n):
        size = 0.0
        for k in range(len(units.weights)):
            size += units.weights[k, j] * units.weights[k, j]
        size *= (1.0 + units.use[j]) / (1.0 + trials - units.born[j])
        if size < least:
            least, which = size, j
    return which, least


@compiled
def learn_stream(
    units: Units, shared: Shared, settings: Settings, work: Work, state: tuple[int, int],
    inputs: Array, errors: Array, allocated: Booleans,
) -> int:  # fmt: skip
    """Learn inputs (N, d), errors (N, m) holding the targets, which become the errors.

    state is (neurons, trials so far); returns how many neurons there are then.
    """
    n, trials = state
    out = np.empty(errors.shape[1])
    for t in range(len(inputs)):
        x, error = inputs[t], errors[t]
        nearest = np.sqrt(evaluate(units, shared, n, x, work, out))
        size = 0.0
        for k in range(error.size):
            error[k] -= out[k]
            size += error[k] * error[k]
        for j in range(n):
            units.use[j] += work.o[j] * work.o[j]
        novel = nearest > settings.distance_threshold and np.sqrt(size) > settings.error_threshold
        place = n
        if novel and n == units.use.size and settings.prune_tolerance > 0.0:
            which, least = least_useful(units, n, trials + t)
            if least < settings.prune_tolerance**2:
                place = which
        allocated[t] = novel and place < units.use.size
        if allocated[t]:
            for k in range(error.size):
                # One that makes room no longer answers here.
                out[k] = error[k]
                if place < n:
                    out[k] += units.weights[k, place] * work.o[place]
            add(units, settings, place, trials + t, x, out, nearest)
            n = max(n, place + 1)
        else:
            found = strongest(n, work)
            linearise(units, shared, found, x, work)
            gain = max(1.0 / (trials + t + 1.0), 1.0 / NOISE_WINDOW)
            correct(units, shared, settings, found, gain, error, work)
            move(units, shared, settings, found, work)
    return n


@compiled
def predict_stream(
    units: Units, shared: Shared, n: int, work: Work, inputs: Array, outputs: Array
) -> None:
    """Outputs (N, m), overwritten, at inputs (N, d)."""
    for t in range(len(inputs)):
        evaluate(units, shared, n, inputs[t], work, outputs[t])


@compiled
def variance_stream(
    units: Units, shared: Shared, n: int, work: Work, inputs: Array, variances: Array
) -> None:
    """`noise + sum h^T P h` over the neighbours and the scales, (N, m), at inputs (N, d)."""
    for t in range(len(inputs)):
        evaluate(units, shared, n, inputs[t], work, variances[t])
        found = strongest(n, work)
        linearise(units, shared, found, inputs[t], work)
        for k in range(variances.shape[1]):
            variances[t, k] = shared.noise[k]
            for a in range(found):
                variances[t, k] += see(units.roots[work.which[a]], work.slopes[a, k], work.seen[a])
            variances[t, k] += see(shared.root, work.by_scale[k], work.scale_seen)
