"""One sample after the other through the phases: what each adaptation rule makes of them."""
# ruff: noqa: ARG001 (every implementation has the arguments of its declaration)

from typing import Any, NamedTuple

from handeye._compiled import by_kind, compiled
from handeye.networks.adaptation import CMAC, NoAdaptation, VirtualNeuron
from handeye.networks.hardware.arithmetic import (
    alike,
    change_alike,
    changed,
    fixed_width,
    part,
    quotient,
    virtual_width,
)
from handeye.networks.hardware.fixed_width import FixedVirtualNeuron
from handeye.networks.hardware.operations import plus
from handeye.networks.hardware.phases import (
    CHANGES,
    DISTANCES,
    ERRORS,
    GATES,
    IMITATION,
    NEAREST,
    OUTPUTS,
    OVERLAP,
    QUOTIENT,
    RESPONSES,
    WIDTH,
    Cells,
    Registers,
    Tables,
    compare,
    gate,
    imitate,
    nearest_active,
    present,
    read_out,
    respond,
    spread_out,
)


@by_kind
def teach(
    rule: NamedTuple,
    numbers: NamedTuple,
    tables: Tables,
    cells: Cells,
    registers: Registers,
) -> None:
    """The phases of a rule once the active neurons are gated."""


@teach.of(VirtualNeuron)
def teach_virtual(
    rule: VirtualNeuron,
    numbers: NamedTuple,
    tables: Tables,
    cells: Cells,
    registers: Registers,
) -> None:
    """The virtual neuron is as wide as its distance to the nearest active neuron says."""
    nearest = nearest_active(registers, registers.tallies[NEAREST])
    gain, shift = virtual_width(numbers, nearest, registers.tallies[WIDTH])
    imitate(numbers, tables.responses, gain, shift, registers, registers.tallies[IMITATION])
    spread_out(numbers, tables, cells, registers)


@teach.of(FixedVirtualNeuron)
def teach_fixed(
    rule: FixedVirtualNeuron,
    numbers: NamedTuple,
    tables: Tables,
    cells: Cells,
    registers: Registers,
) -> None:
    """Without the search for the nearest and without feedback."""
    gain, shift = fixed_width(numbers)
    imitate(numbers, tables.responses, gain, shift, registers, registers.tallies[IMITATION])
    spread_out(numbers, tables, cells, registers)


@teach.of(CMAC)
def teach_cmac(
    rule: CMAC,
    numbers: NamedTuple,
    tables: Tables,
    cells: Cells,
    registers: Registers,
) -> None:
    """The same change for all: delta w_kj = (rate / sum_l o_l) e_k (eq 3.73)."""
    total = registers.own[0] - registers.own[0]
    for j in range(registers.own.size):
        if registers.active[j]:
            total = plus(total, registers.own[j], registers.tallies[OVERLAP])
    q, shift = quotient(
        numbers, tables.reciprocals, alike(numbers, total), registers.tallies[QUOTIENT]
    )
    tally = registers.tallies[CHANGES]
    for k in range(registers.errors.size):
        common = part(numbers, q, registers.errors[k], tally)
        step = change_alike(numbers, common, shift, registers.noise, tally)
        for j in range(registers.own.size):
            if registers.active[j]:
                cells.weights[k, j] = changed(numbers, cells.weights[k, j], step, tally)


@teach.of(NoAdaptation)
def teach_nothing(
    rule: NoAdaptation,
    numbers: NamedTuple,
    tables: Tables,
    cells: Cells,
    registers: Registers,
) -> None:
    """Nothing changes."""


@compiled
def trial(
    rule: NamedTuple,
    numbers: NamedTuple,
    tables: Tables,
    cells: Cells,
    registers: Registers,
    x: Any,
    target: Any,
) -> None:
    """One sample: predict, and learn if the error is large enough and a neuron is active."""
    answer(numbers, tables, cells, registers, x)
    if compare(numbers, target, registers, registers.tallies[ERRORS]) and gate(
        numbers, registers, registers.tallies[GATES]
    ):
        teach(rule, numbers, tables, cells, registers)


@compiled
def answer(numbers: NamedTuple, tables: Tables, cells: Cells, registers: Registers, x: Any) -> None:
    """One output, in `registers.outputs`."""
    present(cells, x, registers, registers.tallies[DISTANCES])
    respond(numbers, tables.responses, cells, registers, registers.tallies[RESPONSES])
    read_out(numbers, cells, registers, registers.tallies[OUTPUTS])


@compiled
def answer_stream(
    numbers: NamedTuple,
    tables: Tables,
    cells: Cells,
    registers: Registers,
    inputs: Any,
    outputs: Any,
) -> None:
    """Outputs (N, m), overwritten, at inputs (N, d)."""
    for i in range(len(inputs)):
        answer(numbers, tables, cells, registers, inputs[i])
        outputs[i] = registers.outputs


@compiled
def trial_stream(
    rule: NamedTuple,
    numbers: NamedTuple,
    tables: Tables,
    cells: Cells,
    registers: Registers,
    inputs: Any,
    targets: Any,
    outputs: Any,
) -> None:
    """Learn inputs (N, d), targets (N, m) in order; outputs (N, m) are those before learning."""
    for i in range(len(inputs)):
        trial(rule, numbers, tables, cells, registers, inputs[i], targets[i])
        outputs[i] = registers.outputs
