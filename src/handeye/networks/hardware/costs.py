"""What a chip costs: operations, counted by running it; phases in a row; words of memory."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Integers, shaped
from handeye.networks.adaptation import CMAC, NoAdaptation, VirtualNeuron
from handeye.networks.hardware import trials
from handeye.networks.hardware.chip import HardwareNetwork
from handeye.networks.hardware.fixed_width import FixedVirtualNeuron
from handeye.networks.hardware.operations import KINDS
from handeye.networks.hardware.phases import OUTPUTS

Counts = Mapping[str, int]
"""Operations by kind."""


class Operations(NamedTuple):
    """What one prediction costs, and one trial at most: with every neuron active."""

    predict: Counts
    learn: Counts


def count_trial(chip: HardwareNetwork, x: ArrayLike, target: ArrayLike) -> Integers:
    """Operations (phases, kinds) of learning one sample, in the order of PHASES and KINDS.

    Counted while a copy of the chip learns x (d,), target (m,).
    """
    one = shaped(x, (chip.n_inputs,), "x")[np.newaxis]
    wanted = shaped(target, (chip.n_outputs,), "target")[np.newaxis]
    design = chip.design
    given = design.input_words(design.inputs.scaled_inputs(one))
    return _counted(chip.copy(), given, design.output_words(wanted))


def most_operations(chip: HardwareNetwork) -> Operations:
    """What a chip's work costs: a prediction always, a trial at most.

    Counted in a trial with all neurons active; no operation depends on the input otherwise.
    """
    made = chip.copy()
    made.numbers = made.numbers._replace(on_threshold=-1, learning=-1)
    # At a center the overlap is not zero, however narrow the virtual neuron is.
    center = np.ascontiguousarray(made.cells.centers.T[:1])
    counts = _counted(made, center, np.zeros((1, made.n_outputs), center.dtype))
    predict = counts[: OUTPUTS + 1].sum(axis=0)
    return Operations(*(
        dict(zip(KINDS, (int(n) for n in row), strict=True))
        for row in (predict, counts.sum(axis=0))
    ))  # fmt: skip


def _counted(chip: HardwareNetwork, x: Any, target: Any) -> Integers:
    """Of learning x (1, d), target (1, m), as the chip has them."""
    chip.registers.tallies[:] = 0
    outputs = np.empty_like(target)
    trials.trial_stream(
        chip.design.adaptation, chip.numbers, chip.tables, chip.cells, chip.registers,
        x, target, outputs,
    )  # fmt: skip
    return chip.registers.tallies


_READING = {"distances": (), "responses": ("distances",), "outputs": ("responses",)}
_COMMON = {**_READING, "errors": ("outputs",), "gates": ("responses",)}
_SUMMED = {"quotient": ("overlap",), "changes": ("quotient", "errors")}
_VIRTUAL = {**_COMMON, "overlap": ("virtual responses",), **_SUMMED}

_AFTER: dict[type, dict[str, tuple[str, ...]]] = {
    NoAdaptation: _READING,
    CMAC: {**_COMMON, "overlap": ("gates",), **_SUMMED},
    FixedVirtualNeuron: {**_VIRTUAL, "virtual responses": ("gates",)},
    VirtualNeuron: {
        **_VIRTUAL,
        "nearest": ("gates",),
        "virtual width": ("nearest",),
        "virtual responses": ("virtual width",),
    },
}
"""The phases of a trial of each rule, and what must come before."""

_BORROWS = ("nearest", "virtual width", "virtual responses")
"""Phases in which a neuron responds with a width that is not its own."""


def phases_in_a_row(rule: type, *, paired: bool) -> int:
    """Length of the longest chain of phases of a trial, if all that can run at once does.

    In a pair one neuron keeps its width and gives the outputs, the other has the virtual neuron's
    width; both see the same distance. A single neuron can lend its response only once its outputs
    are read and its response and width are stored, and has to restore its width in the end.
    """
    after = dict(_AFTER[rule])
    if not paired and any(name in after for name in _BORROWS):
        after["store"] = ("outputs", "gates")
        for name in _BORROWS:
            if name in after:
                after[name] = (*after[name], "store")
        after["restore"] = ("changes",)

    def depth(name: str) -> int:
        return 1 + max((depth(before) for before in after[name]), default=0)

    return max(map(depth, after))


def words_per_neuron(n_inputs: int, n_outputs: int, rule: type, *, paired: bool) -> int:
    """Words of memory of a neuron: center, width and weights; a single one also stores two."""
    lends = any(name in _AFTER[rule] for name in _BORROWS)
    return n_inputs + 1 + n_outputs + (2 if lends and not paired else 0)
