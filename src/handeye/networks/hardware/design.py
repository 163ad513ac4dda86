"""What never changes in a chip, and the constants, tables and cells that follow from it."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from handeye.arrays import Array
from handeye.errors import InvalidInput
from handeye.networks.adaptation import CMAC, NoAdaptation, VirtualNeuron
from handeye.networks.hardware.curves import (
    CURVES,
    reciprocal_table,
    response_table,
    squared_half_distances,
)
from handeye.networks.hardware.fixed import Fixed
from handeye.networks.hardware.fixed_width import FixedVirtualNeuron
from handeye.networks.hardware.floating import Floating
from handeye.networks.hardware.formats import FixedPoint, Ranges, as_mantissa, step_of, words
from handeye.networks.hardware.operations import KINDS
from handeye.networks.hardware.phases import PHASES, Cells, Registers, Tables
from handeye.networks.inputs import InputSpace
from handeye.networks.units import Settings

if TYPE_CHECKING:
    from handeye.networks.network import ResourceAllocatingNetwork

TAUGHT = (VirtualNeuron, CMAC, FixedVirtualNeuron, NoAdaptation)
"""The adaptation rules that a chip has."""

MOST_INPUTS, MOST_NEURONS = 256, 8192
"""Sums of so many products of words stay inside 64 bits."""

_NARROWEST = 2.0
"""Least half-maximum distance, in steps of an input: u must not outgrow its accumulator."""

_WIDEST = 2.0**100
"""Largest square of it: wider neurons answer 1 everywhere just as well."""


@dataclass(frozen=True, eq=False)
class Design:
    """One chip: the network it came from, and its arithmetic (None: double precision)."""

    inputs: InputSpace
    response: NamedTuple
    adaptation: NamedTuple
    settings: Settings
    fixed: FixedPoint | None
    ranges: Ranges | None

    @classmethod
    def of(
        cls, network: "ResourceAllocatingNetwork", fixed: FixedPoint | None, *, learns: bool
    ) -> "Design":
        """The design for a network.

        Raises:
            InvalidInput: no neurons or too many, or a kind that a chip does not have.
        """
        if type(network.response) not in CURVES:
            raise InvalidInput(
                f"a chip has no {type(network.response).__name__} response, only {_names(CURVES)}"
            )
        adaptation = network.adaptation if learns else NoAdaptation()
        if type(adaptation) not in TAUGHT:
            raise InvalidInput(
                f"a chip cannot learn by {type(adaptation).__name__}: it has {_names(TAUGHT)}, "
                "which need no derivatives. Without learning, any network can be had."
            )
        if not 0 < network.n_neurons <= MOST_NEURONS or network.n_inputs > MOST_INPUTS:
            raise InvalidInput(
                f"a chip has 1 to {MOST_NEURONS} neurons and at most {MOST_INPUTS} inputs, this "
                f"network has {network.n_neurons} and {network.n_inputs}: let it learn first, or "
                "give it a capacity"
            )
        ranges = None
        if fixed is not None:
            centers = network.centers / network.inputs.scales
            box = network.inputs
            outputs = network.predict_many(network.centers)
            ranges = Ranges.of(
                np.minimum(box.low / box.scales, centers.min(axis=0)),
                np.maximum(box.high / box.scales, centers.max(axis=0)),
                float(np.abs(network.weights).max()),
                float(np.abs(outputs).max()),
                fixed,
            )
        return cls(network.inputs, network.response, adaptation, network.settings, fixed, ranges)

    @property
    def output_step(self) -> float:
        """What the last bit of an output means; 1 in floating point."""
        if self.fixed is None or self.ranges is None:
            return 1.0
        return step_of(self.ranges.outputs, self.fixed.word_length)

    def input_words(self, scaled: Array) -> Any:
        """Scaled inputs (N, d) as the chip takes them."""
        if self.fixed is None or self.ranges is None:
            return scaled
        return self.ranges.input_words(scaled, self.fixed.word_length)

    def output_words(self, values: Array) -> Any:
        """Outputs or targets (N, m) as the chip has them."""
        if self.fixed is None:
            return values
        return words(values / self.output_step, self.fixed.word_length)

    def numbers(self) -> NamedTuple:
        """The constants of the chip's arithmetic."""
        rule, settings = self.adaptation, self.settings
        smallest = (settings.smallest_width * settings.diameter) ** 2
        h2 = settings.half_max_fraction**2
        rate, on = getattr(rule, "rate", 1.0), getattr(rule, "on_threshold", 0.0)
        fixed_h2 = max(getattr(rule, "half_distance", 1.0) ** 2, smallest)
        if self.fixed is None or self.ranges is None:
            return Floating(
                response=self.response,
                on_threshold=float(on),
                learning=settings.learning_threshold**2,
                rate=float(rate),
                spread=1.0 / h2,
                floor=smallest / h2,
                gain=1.0 / fixed_h2,
            )
        W = self.fixed.word_length
        gain, gain_shift = self._width(fixed_h2)
        rate_mantissa, rate_shift = as_mantissa(rate, W)
        spread, spread_shift = as_mantissa(1.0 / h2, W)
        return Fixed(
            word=W,
            index_bits=self.fixed.index_bits,
            folds=int(CURVES[type(self.response)]),
            on_threshold=int(np.clip(np.floor(on * 2.0 ** (W - 1)), -1, 2 ** (W - 1))),
            learning=int(min((settings.learning_threshold / self.output_step) ** 2, 2.0**62)),
            weight_shift=self.ranges.weight_shift,
            rate=rate_mantissa,
            rate_shift=rate_shift,
            spread=spread,
            spread_shift=spread_shift,
            floor=int(np.ceil(_NARROWEST**2 / h2)),
            gain=gain,
            gain_shift=gain_shift,
            scatters=int(self.fixed.rounding == "random"),
        )

    def tables(self) -> Tables:
        """Responses and reciprocals; empty in floating point."""
        if self.fixed is None:
            return Tables(np.empty(0), np.empty(0))
        bits, W = self.fixed.index_bits, self.fixed.word_length
        return Tables(response_table(self.response, bits, W), reciprocal_table(bits, W))

    def cells(self, network: "ResourceAllocatingNetwork") -> Cells:
        """The neurons of a network."""
        centers = network.centers / network.inputs.scales
        squares = squared_half_distances(self.response, network.widths)
        if self.fixed is None or self.ranges is None:
            shifts = np.zeros(len(squares), np.int64)
            weights = np.ascontiguousarray(network.weights.T)
            return Cells(np.ascontiguousarray(centers.T), 1.0 / squares, shifts, weights)
        widths = np.array([self._width(square) for square in squares])
        step = step_of(self.ranges.weights, self.fixed.word_length)
        return Cells(
            np.ascontiguousarray(self.input_words(centers).T),
            np.ascontiguousarray(widths[:, 0]),
            np.ascontiguousarray(widths[:, 1]),
            np.ascontiguousarray(words(network.weights.T / step, self.fixed.word_length)),
        )

    def registers(self, n_neurons: int, n_outputs: int) -> Registers:
        """Empty ones."""
        kind = np.float64 if self.fixed is None else np.int64
        seed = 0 if self.fixed is None else self.fixed.seed
        z, own, partner = np.zeros((3, n_neurons), kind)
        outputs, errors = np.zeros((2, n_outputs), kind)
        return Registers(
            z,
            own,
            partner,
            active=np.zeros(n_neurons, np.bool_),
            outputs=outputs,
            errors=errors,
            noise=np.array([seed]),
            tallies=np.zeros((len(PHASES), len(KINDS)), np.int64),
        )

    def _width(self, squared: float) -> tuple[int, int]:
        """(gain, shift) of a squared half-maximum distance in scaled units."""
        assert self.fixed is not None
        assert self.ranges is not None
        steps = squared / self.ranges.input_step(self.fixed.word_length) ** 2
        return as_mantissa(1.0 / np.clip(steps, _NARROWEST**2, _WIDEST), self.fixed.word_length)


def _names(kinds: Any) -> str:
    return ", ".join(kind.__name__ for kind in kinds)
