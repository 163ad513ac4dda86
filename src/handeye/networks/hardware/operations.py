"""The operations of a chip. Each passes through here once, so what a rule costs can be counted.

`tally` counts them by kind, (len(KINDS),).
"""

from typing import TypeVar

from handeye._compiled import compiled
from handeye.arrays import Integers

KINDS: tuple[str, ...] = ("multiply", "add", "compare", "shift", "look up", "divide")
"""What is counted: products, sums and differences, comparisons, rounded shifts, responses taken
from a table (or from a function, on a chip with floating point), and quotients."""

MULTIPLY, ADD, COMPARE, SHIFT, LOOK_UP, DIVIDE = range(len(KINDS))

Tally = Integers
"""Counts of one phase."""

Number = TypeVar("Number", int, float)

WIDEST = 62
"""Shifts by more leave nothing of an accumulator."""


@compiled
def tick(tally: Tally, kind: int) -> None:
    """One more operation of a kind."""
    tally[kind] += 1


@compiled
def times(a: Number, b: Number, tally: Tally) -> Number:
    """The product."""
    tick(tally, MULTIPLY)
    return a * b


@compiled
def plus(a: Number, b: Number, tally: Tally) -> Number:
    """The sum."""
    tick(tally, ADD)
    return a + b


@compiled
def minus(a: Number, b: Number, tally: Tally) -> Number:
    """The difference."""
    tick(tally, ADD)
    return a - b


@compiled
def above(a: float, b: float, tally: Tally) -> bool:
    """Whether a > b."""
    tick(tally, COMPARE)
    return a > b


@compiled
def kept_within(value: int, limit: int, tally: Tally) -> int:
    """Saturation: the nearest whole number from -limit to limit."""
    tick(tally, COMPARE)
    return min(max(value, -limit), limit)


@compiled
def rounded(value: int, shift: int, tally: Tally) -> int:
    """value / 2^shift to the nearest whole number, halves up; a negative shift multiplies."""
    tick(tally, SHIFT)
    if shift > WIDEST:
        return 0
    if shift > 0:
        return (value + (1 << (shift - 1))) >> shift
    return value << -shift


@compiled
def bit_length(value: int) -> int:
    """Bits of a whole number that is not negative: the priority encoder of a shifter."""
    length = 0
    while value > 0:
        value >>= 1
        length += 1
    return length


@compiled
def normalised(value: int, bits: int, tally: Tally) -> tuple[int, int]:
    """(mantissa, k): value > 0 rounded to `bits` bits, 2^(bits-1) <= mantissa < 2^bits.

    value is about mantissa * 2^(k - bits), k its bit length.
    """
    k = bit_length(value)
    return min(rounded(value, k - bits, tally), (1 << bits) - 1), k


@compiled
def next_noise(register: Integers) -> int:
    """32 random bits: a step of the shift register (1,) that Marsaglia (2003) calls xorshift32."""
    bits = register[0]
    bits = (bits ^ (bits << 13)) & 0xFFFFFFFF
    bits ^= bits >> 17
    bits = (bits ^ (bits << 5)) & 0xFFFFFFFF
    register[0] = bits
    return int(bits)


@compiled
def scattered(value: int, shift: int, register: Integers, tally: Tally) -> int:
    """value / 2^shift, up or down at random so that its mean over the register is exact."""
    if shift <= 0 or shift > WIDEST:
        return rounded(value, shift, tally)
    tick(tally, SHIFT)
    bits = next_noise(register)
    bits = bits >> (32 - shift) if shift < 32 else bits << (shift - 32)
    return (value + bits) >> shift
