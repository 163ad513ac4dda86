"""What the numbers of a chip mean: word length, steps of words, ranges."""

from dataclasses import dataclass
from math import ceil, log2
from typing import Any, Literal

import numpy as np

from handeye.arrays import Array, count, scalar
from handeye.errors import InvalidInput

SHORTEST, LONGEST = 8, 24
"""Word lengths: with longer words a product of three would not fit an accumulator of 64 bits."""

HEADROOM = 2.0
"""Room that ranges leave above what a trained network has, for what it learns later."""

_RATIO = 7
"""Largest log2 of the range of weights over that of outputs: sums must not fall below a bit."""


@dataclass(frozen=True)
class FixedPoint:
    """Whole-number arithmetic in words of a few bits.

    word_length    W, 8 to 24 bits
    weight_range   weights saturate here, in output units; by default twice the largest of the
                   network. Made a power of two, as are those of outputs.
    output_range   outputs and targets saturate here; by default twice the largest output at a
                   center
    rounding       of weights: "nearest", or "random", up or down so that the mean is exact: then
                   changes below the step of a word are not lost, only made now and then
    table_bits     log2 of the table entries for one unit; by default as many as make reading
                   between two entries exact to half a step of a word
    seed           of the random bits, 1 to 2^32 - 1

    Raises InvalidInput for a setting out of range.
    """

    word_length: int = 16
    weight_range: float | None = None
    output_range: float | None = None
    rounding: Literal["nearest", "random"] = "nearest"
    table_bits: int | None = None
    seed: int = 1

    def __post_init__(self) -> None:
        words = count(self.word_length, "word_length", least=SHORTEST)
        if words > LONGEST:
            raise InvalidInput(f"word_length must be {SHORTEST} to {LONGEST} bits, got {words}")
        for name in ("weight_range", "output_range"):
            if getattr(self, name) is not None:
                scalar(getattr(self, name), name, above=0.0)
        if self.rounding not in {"nearest", "random"}:
            raise InvalidInput(f'rounding must be "nearest" or "random", got {self.rounding!r}')
        if self.table_bits is not None:
            bits = count(self.table_bits, "table_bits")
            if bits > words - 2:
                raise InvalidInput(f"table_bits must be at most word_length - 2, got {bits}")
        if count(self.seed, "seed") >= 2**32:
            raise InvalidInput(f"seed must be 1 to 2^32 - 1, got {self.seed}")

    @property
    def index_bits(self) -> int:
        """log2 of the table entries for one unit."""
        return -(-(self.word_length - 4) // 2) if self.table_bits is None else self.table_bits

    @property
    def largest(self) -> int:
        """The largest word."""
        return 2 ** (self.word_length - 1) - 1


@dataclass(frozen=True, eq=False)
class Ranges:
    """How quantities become words of a chip in fixed point.

    middle (d,), half  inputs in scaled units lie `half` around the middle
    weights, outputs   largest weight and output, powers of two
    """

    middle: Array
    half: float
    weights: float
    outputs: float

    @classmethod
    def of(
        cls,
        low: Array,
        high: Array,
        largest_weight: float,
        largest_output: float,
        asked: FixedPoint,
    ) -> "Ranges":
        """Ranges that hold the box from low to high (d,), and the weights and outputs given.

        Raises:
            InvalidInput: the range of weights is far from that of outputs.
        """
        weights = asked.weight_range or HEADROOM * largest_weight or 1.0
        outputs = asked.output_range or HEADROOM * largest_output or weights
        ranges = cls(
            0.5 * (low + high),
            0.5 * float(np.max(high - low)),
            2.0 ** ceil(log2(weights)),
            2.0 ** ceil(log2(outputs)),
        )
        if abs(ranges.weight_shift) > _RATIO:
            raise InvalidInput(
                f"weights up to {ranges.weights:g} and outputs up to {ranges.outputs:g} differ by "
                f"more than 2^{_RATIO}: a sum of words cannot span that"
            )
        return ranges

    @property
    def weight_shift(self) -> int:
        """log2 of the step of a weight over the step of an output."""
        return round(log2(self.weights / self.outputs))

    def input_step(self, word_length: int) -> float:
        """What the last bit of an input means, in scaled units."""
        return self.half / (2 ** (word_length - 1) - 1)

    def input_words(self, scaled: Array, word_length: int) -> Any:
        """Scaled inputs (N, d) as words; beyond the box they saturate."""
        return words((scaled - self.middle) / self.input_step(word_length), word_length)


def step_of(largest: float, word_length: int) -> float:
    """What the last bit of a word means whose range is +-largest, a power of two."""
    return largest / 2 ** (word_length - 1)


def words(values: Array, word_length: int) -> Any:
    """Multiples of a step as words: the nearest whole numbers, halves up, saturated."""
    most = 2 ** (word_length - 1) - 1
    return np.clip(np.floor(values + 0.5), -most, most).astype(np.int64)


def as_mantissa(value: float, word_length: int) -> tuple[int, int]:
    """(mantissa, shift) with 2^(W-2) <= mantissa <= 2^(W-1) and value = mantissa / 2^shift."""
    _, exponent = np.frexp(value)
    shift = word_length - 1 - int(exponent)
    return int(np.floor(np.ldexp(value, shift) + 0.5)), shift
