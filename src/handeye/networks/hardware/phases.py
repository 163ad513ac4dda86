"""The phases of appendix B: what every neuron does at once, and what is gathered in between.

A chip presents an input, reads its neurons out, and, to learn, compares, gates the active ones,
sizes the virtual neuron by the nearest, sums, divides once, and broadcasts the change.
"""

from typing import Any, NamedTuple

from handeye._compiled import compiled
from handeye.networks.hardware.arithmetic import (
    activity,
    change_of,
    changed,
    output_word,
    part,
    quotient,
)
from handeye.networks.hardware.operations import Tally, above, minus, plus, times

PHASES = (
    "distances",
    "responses",
    "outputs",
    "errors",
    "gates",
    "nearest",
    "virtual width",
    "virtual responses",
    "overlap",
    "quotient",
    "changes",
)
"""In the order of a trial; what they cost is counted one by one."""

(
    DISTANCES, RESPONSES, OUTPUTS, ERRORS, GATES, NEAREST, WIDTH, IMITATION, OVERLAP, QUOTIENT,
    CHANGES,
) = range(len(PHASES))  # fmt: skip


class Cells(NamedTuple):
    """What a chip keeps: centers (d, n), gains (n,), shifts (n,), weights (m, n)."""

    centers: Any
    gains: Any
    shifts: Any
    weights: Any


class Registers(NamedTuple):
    """What a chip holds during a trial.

    z, own, partner (n,)    squared distance, response, and response as the virtual neuron
    active (n,)             gates
    outputs, errors (m,)
    noise (1,)              the shift register of random bits
    tallies (phases, kinds) operations since they were last set to zero
    """

    z: Any
    own: Any
    partner: Any
    active: Any
    outputs: Any
    errors: Any
    noise: Any
    tallies: Any


class Tables(NamedTuple):
    """Responses and reciprocals."""

    responses: Any
    reciprocals: Any


@compiled
def present(cells: Cells, x: Any, registers: Registers, tally: Tally) -> None:
    """z_j = |c_j - x|^2 in every neuron at once; the pair shares it."""
    for j in range(registers.z.size):
        z = registers.z[j]
        z -= z
        for i in range(x.size):
            away = minus(cells.centers[i, j], x[i], tally)
            z = plus(z, times(away, away, tally), tally)
        registers.z[j] = z


@compiled
def respond(
    numbers: NamedTuple, table: Any, cells: Cells, registers: Registers, tally: Tally
) -> None:
    """Every neuron's response to the input (eq 3.45)."""
    for j in range(registers.z.size):
        registers.own[j] = activity(
            numbers, table, registers.z[j], cells.gains[j], cells.shifts[j], tally
        )


@compiled
def read_out(numbers: NamedTuple, cells: Cells, registers: Registers, tally: Tally) -> None:
    """Outputs (eq 3.58)."""
    for k in range(registers.outputs.size):
        total = registers.own[0] - registers.own[0]
        for j in range(registers.own.size):
            total = plus(total, times(cells.weights[k, j], registers.own[j], tally), tally)
        registers.outputs[k] = output_word(numbers, total, tally)


@compiled
def compare(numbers: Any, target: Any, registers: Registers, tally: Tally) -> bool:
    """Errors, and whether they are large enough to learn from (theta_l)."""
    total = target[0] - target[0]
    for k in range(target.size):
        error = minus(target[k], registers.outputs[k], tally)
        registers.errors[k] = error
        total = plus(total, times(error, error, tally), tally)
    return above(total, numbers.learning, tally)


@compiled
def gate(numbers: Any, registers: Registers, tally: Tally) -> bool:
    """Opens the neurons that are active (theta_o); false if there are none."""
    any_open = False
    for j in range(registers.own.size):
        registers.active[j] = above(registers.own[j], numbers.on_threshold, tally)
        any_open |= registers.active[j]
    return any_open


@compiled
def nearest_active(registers: Registers, tally: Tally) -> Any:
    """The smallest squared distance of an active neuron: the winner if all were equally wide."""
    found = False
    nearest = registers.z[0]
    for j in range(registers.z.size):
        if registers.active[j]:
            if not found or above(nearest, registers.z[j], tally):
                nearest = registers.z[j]
            found = True
    return nearest


@compiled
def imitate(
    numbers: NamedTuple, table: Any, gain: Any, shift: Any, registers: Registers, tally: Tally
) -> None:
    """Every active neuron's response to the input if it had the virtual neuron's width."""
    for j in range(registers.z.size):
        if registers.active[j]:
            registers.partner[j] = activity(numbers, table, registers.z[j], gain, shift, tally)


@compiled
def overlap_of(registers: Registers, tally: Tally) -> Any:
    """sum_l V_l o_l over the active neurons (eq 3.68)."""
    total = registers.own[0] - registers.own[0]
    for j in range(registers.own.size):
        if registers.active[j]:
            total = plus(total, times(registers.partner[j], registers.own[j], tally), tally)
    return total


@compiled
def spread_out(numbers: NamedTuple, tables: Tables, cells: Cells, registers: Registers) -> None:
    """Divide once and broadcast: delta w_kj = (rate / overlap) e_k V_j (eq 3.69)."""
    overlap = overlap_of(registers, registers.tallies[OVERLAP])
    # A curve with an end and h < 1/2 reaches no active neuron: nothing to correct.
    if overlap <= 0:
        return
    q, shift = quotient(numbers, tables.reciprocals, overlap, registers.tallies[QUOTIENT])
    tally = registers.tallies[CHANGES]
    for k in range(registers.errors.size):
        common = part(numbers, q, registers.errors[k], tally)
        for j in range(registers.own.size):
            if registers.active[j]:
                step = change_of(
                    numbers, common, registers.partner[j], shift, registers.noise, tally
                )
                cells.weights[k, j] = changed(numbers, cells.weights[k, j], step, tally)
