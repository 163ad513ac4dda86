"""The compiled loops of a recursive network: respond, solve, and learn sample by sample."""

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array, Booleans
from handeye.networks.kernels import squared_distances, weighted_sum
from handeye.networks.recursive.linear import DEPTH, PANEL, squared_norm, substitute, subtract
from handeye.networks.recursive.units import (
    NOISE_WINDOW,
    Arrays,
    Pending,
    Progress,
    Scratch,
    Settings,
    Units,
)
from handeye.networks.responses import Gaussian, respond


@compiled
def respond_all(units: Units, b: int, x: Array, scratch: Scratch, out: Array) -> float:
    """Responses of block b to x (d,), into out; returns the squared distance to its nearest."""
    n = units.counts[b]
    if n == 0:
        return np.inf
    nearest = squared_distances(units.centers[b], 0, n, x, scratch.z[:n])
    respond(Gaussian(), scratch.z[:n], scratch.widths[:n], out[:n])
    return nearest


@compiled
def predict_stream(units: Units, scratch: Scratch, inputs: Array, outputs: Array) -> None:
    """Outputs (N, m), overwritten, at scaled inputs (N, d)."""
    o = scratch.solved[0]
    for i in range(len(inputs)):
        outputs[i] = 0.0
        for b in range(units.counts.size):
            respond_all(units, b, inputs[i], scratch, o)
            for k in range(outputs.shape[1]):
                outputs[i, k] += weighted_sum(units.weights[b, k, : units.counts[b]],
                                              o[: units.counts[b]])  # fmt: skip


@compiled
def solve_block(
    units: Units, pending: Pending, b: int, known: int, scratch: Scratch, samples: int
) -> None:
    """`v = U^-T o` of the responses in scratch.solved, then `coupled -= V^T v` over known ones."""
    n = units.counts[b]
    substitute(units.factor[b], 0, n, scratch.solved[:samples])
    subtract(pending.solved[b], 0, n, 0, known, scratch.solved[:samples], scratch.coupled[:samples])


@compiled
def variance_stream(
    units: Units, pending: Pending, known: int, scratch: Scratch, inputs: Array, variances: Array
) -> None:
    """`o^T A^-1 o` at scaled inputs (N, d), A with all known samples, in noise variances."""
    for i in range(len(inputs)):
        scratch.coupled[0, :known] = 0.0
        before = 0.0
        for b in range(units.counts.size):
            respond_all(units, b, inputs[i], scratch, scratch.solved[0])
            solve_block(units, pending, b, known, scratch, 1)
            before += squared_norm(scratch.solved[0], units.counts[b])
        substitute(pending.coupling, 0, known, scratch.coupled[:1])
        variances[i] = max(before - squared_norm(scratch.coupled[0], known), 0.0)


@compiled
def _solve_panel(
    units: Units, pending: Pending, known: int, scratch: Scratch, x: Array, errors: Array,
    spread: Array,
) -> None:  # fmt: skip
    """Everything about a panel that needs no other sample of it.

    Takes the outputs by the weights of the last consolidation off errors; fills spread with
    `o^T A^-1 o` of then, and pending.responses, pending.solved, scratch.coupled and nearest.
    """
    samples = len(x)
    scratch.coupled[:samples, : known + samples] = 0.0
    for j in range(samples):
        scratch.nearest[j] = np.inf
        spread[j] = 0.0
    for b in range(units.counts.size):
        n = units.counts[b]
        for j in range(samples):
            o = pending.responses[b, known + j]
            scratch.nearest[j] = min(scratch.nearest[j], respond_all(units, b, x[j], scratch, o))
            for k in range(errors.shape[1]):
                errors[j, k] -= weighted_sum(units.weights[b, k, :n], o[:n])
            scratch.solved[j, :n] = o[:n]
        substitute(units.factor[b], 0, n, scratch.solved[:samples])
        for j in range(samples):
            spread[j] += squared_norm(scratch.solved[j], n)
        for i in range(n):
            for j in range(samples):
                pending.solved[b, i, known + j] = scratch.solved[j, i]
        subtract(
            pending.solved[b], 0, n, 0, known + samples, scratch.solved[:samples],
            scratch.coupled[:samples],
        )  # fmt: skip
    # The part of the coupling that is complete is solved for all of them.
    deep = known // DEPTH * DEPTH
    rows = scratch.coupled[:samples]
    substitute(pending.coupling, 0, deep, rows)
    for p in range(deep):
        for j in range(samples):
            pending.coupling[p, known + j] = -rows[j, p]
    subtract(pending.coupling, 0, deep, deep, known + samples, rows, rows)


@compiled
def learn_stream(
    arrays: Arrays,
    settings: Settings,
    progress: Progress,
    inputs: Array,
    errors: Array,
    allocated: Booleans,
) -> int:
    """Learn scaled inputs (N, d), errors (N, m) holding the targets, which become the errors.

    There must be room for N more pending samples. Returns how many points are waiting then.
    """
    units, pending, scratch, noise, waiting = arrays
    first, waits, trials, room = progress
    spread = np.empty(PANEL)
    for start in range(0, len(inputs), PANEL):
        stop = min(start + PANEL, len(inputs))
        known = first + start
        _solve_panel(units, pending, known, scratch, inputs[start:stop], errors[start:stop], spread)
        for j in range(stop - start):
            i, q = start + j, known + j
            row = scratch.coupled[j : j + 1]
            substitute(pending.coupling, known // DEPTH * DEPTH, q, row)
            # Sample q is divided by forgetting^(q + 1) instead of everything before it multiplied.
            own = settings.forgetting ** (q + 1)
            variance = own + max(spread[j] - squared_norm(row[0], q), 0.0)
            deviation = np.sqrt(variance)
            pending.coupling[q, q] = deviation
            for p in range(known // DEPTH * DEPTH, q):
                pending.coupling[p, q] = -row[0, p]
            for p in range(q):
                for k in range(errors.shape[1]):
                    errors[i, k] += row[0, p] * pending.innovations[p, k]
            size = 0.0
            gain = max(1.0 / (trials + i + 1.0), 1.0 / NOISE_WINDOW)
            for k in range(errors.shape[1]):
                e = errors[i, k]
                pending.innovations[q, k] = e / deviation
                noise[k] += gain * (e * e * own / variance - noise[k])
                size += e * e
            nearest = scratch.nearest[j]
            for w in range(waits):
                z = 0.0
                for a in range(inputs.shape[1]):
                    z += (waiting[w, a] - inputs[i, a]) ** 2
                nearest = min(nearest, z)
            allocated[i] = (
                waits < room
                and nearest > settings.distance_threshold**2
                and np.sqrt(size) > settings.error_threshold
            )
            if allocated[i]:
                waiting[waits] = inputs[i]
                waits += 1
    return waits
