"""A trained network as a chip would run it, and teach it."""

from copy import deepcopy
from os import PathLike
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, shaped
from handeye.errors import InvalidInput
from handeye.networks.hardware import files, trials
from handeye.networks.hardware.design import Design
from handeye.networks.hardware.formats import FixedPoint
from handeye.networks.hardware.phases import Cells
from handeye.networks.outcomes import Learned, LearnedMany, LearningDiverged
from handeye.networks.units import moderate

if TYPE_CHECKING:
    from handeye.networks.network import ResourceAllocatingNetwork


class HardwareNetwork:
    """The phased computation of appendix B: a fixed number of neurons, each with its processor.

    It predicts with eq 3.58 and learns by the network's own rule, VirtualNeuron (eq 3.69),
    FixedVirtualNeuron or CMAC (eq 3.73), from errors above the network's theta_l. No neuron is
    ever added. In double precision it equals the network without room for more neurons, to
    rounding; in fixed point it equals what `handeye export --c` writes, to the bit.

    Make one with `of`.
    """

    def __init__(self, design: Design, cells: Cells, noise: int | None = None) -> None:
        self.design = design
        self.cells = cells
        self.n_inputs, self.n_neurons = np.shape(cells.centers)
        self.n_outputs = len(cells.weights)
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

    def predict(self, x: ArrayLike) -> Array:
        """Output (m,) at one input (d,)."""
        return self._predict(shaped(x, (self.n_inputs,), "x")[np.newaxis])[0]

    def predict_many(self, x: ArrayLike) -> Array:
        """Outputs (N, m) at inputs (N, d); inputs beyond the box saturate in fixed point."""
        return self._predict(shaped(x, (None, self.n_inputs), "x"))

    def learn(self, x: ArrayLike, target: ArrayLike) -> Learned:
        """Learn one sample, x (d,) and target (m,)."""
        one = shaped(x, (self.n_inputs,), "x")[np.newaxis]
        error, allocated = self._learn(one, shaped(target, (self.n_outputs,), "target")[np.newaxis])
        return Learned(error[0], bool(allocated[0]))

    def learn_many(self, x: ArrayLike, target: ArrayLike) -> LearnedMany:
        """Learn N samples in order, x (N, d) and target (N, m); the same result as one by one.

        Raises:
            LearningDiverged: outputs in double precision grew beyond all bounds; nothing of these
                samples is learned then.
        """
        inputs = shaped(x, (None, self.n_inputs), "x")
        targets = shaped(target, (None, self.n_outputs), "target")
        if len(inputs) != len(targets):
            raise InvalidInput(f"x has {len(inputs)} samples but target has {len(targets)}")
        return self._learn(inputs, targets)

    def copy(self) -> Self:
        """An independent chip in the same state."""
        return deepcopy(self)

    def save(self, path: str | PathLike[str]) -> None:
        """Write everything to one safetensors file, replacing an old one only once complete."""
        files.save(self, path)

    @staticmethod
    def load(path: str | PathLike[str]) -> "HardwareNetwork":
        """The chip that `save` wrote; FileFormatError says what is wrong with any other file."""
        return files.load(path)

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

    def _predict(self, inputs: Array) -> Array:
        given = self.design.input_words(self.design.inputs.scaled_inputs(inputs))
        outputs = np.empty((len(inputs), self.n_outputs), self.cells.weights.dtype)
        trials.answer_stream(self.numbers, self.tables, self.cells, self.registers, given, outputs)
        return outputs * self.design.output_step

    def _learn(self, inputs: Array, targets: Array) -> LearnedMany:
        given = self.design.input_words(self.design.inputs.scaled_inputs(inputs))
        wanted = self.design.output_words(moderate(targets, "target"))
        outputs = np.empty(wanted.shape, self.cells.weights.dtype)
        before = self.cells.weights.copy()
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
        error = targets - outputs * self.design.output_step
        return LearnedMany(error, np.zeros(len(inputs), np.bool_))
