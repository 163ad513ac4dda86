"""Albus's Cerebellar Model Articulation Controller: overlapping fields, hashed into a table."""

from collections.abc import Sequence
from typing import Any, Self

import numpy as np

from handeye.arrays import Array, count, scalar, shaped
from handeye.errors import InvalidInput
from handeye.io.tensors import Parts
from handeye.networks.checked import CheckedLearner
from handeye.networks.inputs import InputSpace
from handeye.networks.memories import albus_kernels as kernels
from handeye.networks.outcomes import LearnedMany
from handeye.networks.units import LARGEST

FARTHEST = 2.0**52
"""Largest input in quanta: beyond, neighbouring quanta are no longer told apart."""


class AlbusCMAC(CheckedLearner):
    """Learns a mapping from R^d to R^m with a table of fixed size (Albus 1975; section A.6.4).

    The space of inputs is covered by C layers of cells, boxes of the same size, each layer
    displaced by a part of a box against the one before. An input activates the cell of each layer
    that it lies in, and the output is the sum of their weights. So two inputs share the more cells
    the nearer they are, and none once they are a field apart in any direction. For each sample
    with error e = target - output every active weight is changed by

        delta w_k = rate e_k / C                                       (eq A.19)

    which moves the output there by `rate e`, exactly. There is no end to the cells that inputs may
    need, so a cell's weights are found by hashing it into a table; different cells may then share
    a slot, which is noise. Each layer has its own part of the table: cells of the same input never
    collide, which keeps eq A.19 exact.

    This is the network. `handeye.networks.CMAC` is its rule, used with Gaussian neurons.

    Args:
        n_inputs: d.
        n_outputs: m.
        inputs: gives inputs their unit, by default one; inputs need not stay in its box.
        field: side of a receptive field, in these units.
        layers: C; the output is constant within boxes of side field / C.
        slots: in the table for all layers, each with m weights.
        rate: eta, in (0, 1].
        displacements: quanta of field / C by which each layer lies beside the one before, d whole
            numbers; by default ones, Albus's diagonal.

    Raises:
        InvalidInput: a setting out of range, here or in any method an array of the wrong shape or
            type or with values that are not finite; nothing has changed then.
    """

    FORMAT = "handeye.albus-cmac"

    def __init__(
        self,
        n_inputs: int,
        n_outputs: int,
        *,
        inputs: InputSpace | None = None,
        field: float = 0.5,
        layers: int = 16,
        slots: int = 16_384,
        rate: float = 0.5,
        displacements: Sequence[int] | None = None,
    ) -> None:
        super().__init__(n_inputs, n_outputs)
        space = InputSpace.scaled(np.ones(self.n_inputs)) if inputs is None else inputs
        self.inputs = space.of(self.n_inputs)
        self.field = scalar(field, "field", least=1.0 / LARGEST)
        self.layers = count(layers, "layers")
        self.slots = count(slots, "slots")
        if self.slots % self.layers:
            raise InvalidInput(f"slots must be a multiple of the {layers} layers, got {slots}")
        self.rate = scalar(rate, "rate", above=0.0)
        if self.rate > 1.0:
            raise InvalidInput(f"rate must be at most 1, which removes an error at once: {rate}")
        steps = [1] * self.n_inputs if displacements is None else list(displacements)
        if len(steps) != self.n_inputs:
            raise InvalidInput(f"displacements must be {n_inputs} numbers, got {len(steps)}")
        self.displacements = tuple(count(step, "a displacement", least=0) for step in steps)
        self._tiling = kernels.Tiling(
            self.field,
            # A displacement by a whole field is none; so no product leaves the 64 bits.
            np.array([step % self.layers for step in self.displacements], np.int64),
            self.layers,
            self.slots // self.layers,
        )
        self._weights = np.zeros((self.slots, self.n_outputs))
        self._owners = np.full(self.slots, kernels.FREE, np.int64)
        self._collisions = 0

    @property
    def n_cells(self) -> int:
        """Slots that a cell has taken so far."""
        return int(np.count_nonzero(self._owners != kernels.FREE))

    @property
    def collisions(self) -> int:
        """How often in learning an active cell's slot belonged to another cell."""
        return self._collisions

    @property
    def weights(self) -> Array:
        """The table, (slots, m); a copy."""
        return self._weights.copy()

    @property
    def n_bytes(self) -> int:
        """Memory of the table, which never grows: m weights and the name of a cell in each slot."""
        return self._weights.nbytes + self._owners.nbytes

    def __repr__(self) -> str:
        """Shape, state and settings."""
        return (
            f"AlbusCMAC({self.n_inputs} inputs, {self.n_outputs} outputs, {self.n_cells} cells in "
            f"{self.slots} slots, {self.collisions} collisions, {self.trials} trials, "
            f"{self.layers} layers, field {self.field}, rate {self.rate})"
        )

    def _inputs(self, x: Array) -> Array:
        scaled = self.inputs.scaled_inputs(x)
        if np.any(np.abs(scaled) > FARTHEST * self.field / self.layers):
            raise InvalidInput("x is too many fields away: measure inputs from nearby")
        return scaled

    def _predict(self, inputs: Array) -> Array:
        outputs = np.empty((len(inputs), self.n_outputs))
        kernels.predict_stream(self._tiling, self._weights, inputs, outputs)
        return outputs

    def _learn(self, inputs: Array, targets: Array) -> LearnedMany:
        errors, allocated = np.empty_like(targets), np.zeros(len(inputs), np.bool_)
        self._collisions += kernels.learn_stream(
            self._tiling, self.rate, self._weights, self._owners, inputs, targets, errors, allocated
        )
        self._trials += len(inputs)
        return LearnedMany(errors, allocated)

    def _parts(self) -> Parts:
        arrays: dict[str, Any] = {"weights": self._weights, "owners": self._owners}
        settings = {
            "field": self.field, "layers": self.layers, "slots": self.slots, "rate": self.rate,
            "displacements": list(self.displacements),
        }  # fmt: skip
        rest = {"settings": settings, "collisions": self._collisions}
        return {**arrays, **self.inputs.arrays}, rest

    @classmethod
    def _restored(cls, arrays: dict[str, Array], rest: dict[str, Any]) -> Self:
        weights = arrays["weights"]
        space = InputSpace.of_arrays(arrays)
        cmac = cls(space.n_inputs, weights.shape[1], inputs=space, **rest["settings"])
        cmac._weights = shaped(weights, (cmac.slots, None), "weights").copy()
        cmac._owners = shaped(arrays["owners"], (cmac.slots,), "owners").astype(np.int64)
        cmac._collisions = count(rest["collisions"], "collisions", least=0)
        return cmac
