"""A trained network as a chip would run it, and teach it."""

from dataclasses import asdict
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from handeye.arrays import Array
from handeye.io.tensors import Parts
from handeye.networks.adaptation import RULES
from handeye.networks.checked import CheckedLearner
from handeye.networks.hardware import trials
from handeye.networks.hardware.design import Design
from handeye.networks.hardware.formats import FixedPoint, Ranges
from handeye.networks.hardware.phases import Cells
from handeye.networks.inputs import InputSpace
from handeye.networks.kinds import restored_kind, stored_kind
from handeye.networks.outcomes import LearnedMany, LearningDiverged
from handeye.networks.responses import RESPONSES
from handeye.networks.units import Settings

if TYPE_CHECKING:
    from handeye.networks.network import ResourceAllocatingNetwork


class HardwareNetwork(CheckedLearner):
    """The phased computation of appendix B: a fixed number of neurons, each with its processor.

    It predicts with eq 3.58 and learns by the network's own rule, VirtualNeuron (eq 3.69),
    FixedVirtualNeuron or CMAC (eq 3.73), from errors above the network's theta_l. No neuron is
    ever added. In double precision it equals the network without room for more neurons, to
    rounding; in fixed point it equals what `handeye export --c` writes, to the bit.

    Inputs beyond the box saturate in fixed point. Make one with `of`.

    Raises:
        LearningDiverged: in learning, where outputs in double precision grew beyond all bounds;
            nothing of these samples is learned then.
    """

    FORMAT = "handeye.chip"

    def __init__(self, design: Design, cells: Cells, noise: int | None = None) -> None:
        super().__init__(len(cells.centers), len(cells.weights))
        self.design = design
        self.cells = cells
        self.n_neurons = len(cells.centers[0])
        self.numbers: Any = design.numbers()
        self.tables = design.tables()
        self.registers = design.registers(self.n_neurons, self.n_outputs)
        if noise is not None:
            self.registers.noise[0] = noise

    @classmethod
    def of(
        cls,
        network: "ResourceAllocatingNetwork",
        fixed: FixedPoint | None = FixedPoint(),  # noqa: B008 (immutable)
        *,
        learns: bool = True,
    ) -> "HardwareNetwork":
        """A network, as it is now, on a chip.

        Args:
            network: with at least one neuron.
            fixed: word length and ranges; None for double precision.
            learns: false for a chip that only predicts, whatever rule the network has.

        Raises:
            InvalidInput: no neurons, too many, or a rule or response that a chip does not have.
        """
        design = Design.of(network, fixed, learns=learns)
        return cls(design, design.cells(network))

    @property
    def weights(self) -> Array:
        """Output weights (N, m) in output units; a copy."""
        return self.cells.weights.T * self._weight_step

    def __repr__(self) -> str:
        """Shape, rule and arithmetic."""
        fixed = self.design.fixed
        return (
            f"HardwareNetwork({self.n_inputs} inputs, {self.n_outputs} outputs, "
            f"{self.n_neurons} neurons, {self.design.response!r}, {self.design.adaptation!r}, "
            f"{'double precision' if fixed is None else fixed!r})"
        )

    @property
    def _weight_step(self) -> float:
        return self.design.output_step * 2.0 ** getattr(self.numbers, "weight_shift", 0)

    def _inputs(self, x: Array) -> Array:
        return self.design.inputs.scaled_inputs(x)

    def _predict(self, inputs: Array) -> Array:
        given = self.design.input_words(inputs)
        outputs = np.empty((len(inputs), self.n_outputs), self.cells.weights.dtype)
        trials.answer_stream(self.numbers, self.tables, self.cells, self.registers, given, outputs)
        return outputs * self.design.output_step

    def _learn(self, inputs: Array, targets: Array) -> LearnedMany:
        given, wanted = self.design.input_words(inputs), self.design.output_words(targets)
        outputs = np.empty(wanted.shape, self.cells.weights.dtype)
        before = self.cells.weights.copy()
        # What is compiled does not warn; with compilation off it must not either.
        with np.errstate(over="ignore", invalid="ignore"):
            trials.trial_stream(
                self.design.adaptation, self.numbers, self.tables, self.cells, self.registers,
                given, wanted, outputs,
            )  # fmt: skip
        if not np.isfinite(outputs).all():
            self.cells.weights[:] = before
            raise LearningDiverged(
                f"outputs grew beyond all bounds: {self.design.adaptation!r} diverged. Learn "
                "again with a smaller rate."
            )
        self._trials += len(inputs)
        error = targets - outputs * self.design.output_step
        return LearnedMany(error, np.zeros(len(inputs), np.bool_))

    def _parts(self) -> Parts:
        design, ranges = self.design, self.design.ranges
        arrays: dict[str, Any] = {**self.cells._asdict(), **design.inputs.arrays}
        rest: dict[str, Any] = {
            "settings": design.settings._asdict(),
            "response": stored_kind(design.response),
            "adaptation": stored_kind(design.adaptation),
            "fixed": None if design.fixed is None else asdict(design.fixed),
            "noise": int(self.registers.noise[0]),
        }
        if ranges is not None:
            arrays["middle"] = ranges.middle
            rest["ranges"] = {
                name: float(getattr(ranges, name)) for name in ("half", "weights", "outputs")
            }
        return arrays, rest

    @classmethod
    def _restored(cls, arrays: dict[str, Array], rest: dict[str, Any]) -> Self:
        fixed = None if rest["fixed"] is None else FixedPoint(**rest["fixed"])
        design = Design(
            InputSpace.of_arrays(arrays),
            restored_kind("response", rest["response"], RESPONSES),
            restored_kind("adaptation", rest["adaptation"], RULES),
            Settings(**rest["settings"]),
            fixed,
            None if fixed is None else Ranges(arrays["middle"], **rest["ranges"]),
        )
        cells = Cells(*(np.ascontiguousarray(arrays[name]) for name in Cells._fields))
        return cls(design, cells, int(rest["noise"]))

    @classmethod
    def of_parts(cls, arrays: dict[str, Array], rest: dict[str, Any]) -> Self:
        """As of every learner; a file of before chips counted their trials has none of them."""
        return super().of_parts(arrays, {"trials": 0, **rest})
