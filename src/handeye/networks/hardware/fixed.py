"""Fixed point: words of W bits, accumulators of 64, two small tables.

Words are two's complement and saturate at +-(2^(W-1) - 1). Responses are never negative and have
all W bits, W - 1 of them fraction bits. Products and sums stand in accumulators and are rounded to
the nearest word, halves up, only where they become words.
"""

from typing import NamedTuple

from handeye._compiled import compiled
from handeye.arrays import Integers
from handeye.networks.hardware.arithmetic import (
    activity,
    alike,
    change_alike,
    change_of,
    changed,
    fixed_width,
    output_word,
    part,
    quotient,
    virtual_width,
)
from handeye.networks.hardware.curves import SPAN
from handeye.networks.hardware.operations import (
    COMPARE,
    DIVIDE,
    LOOK_UP,
    Tally,
    above,
    kept_within,
    normalised,
    plus,
    rounded,
    scattered,
    tick,
    times,
)

GUARD = 8
"""Bits that `part` keeps below the step of an error: a small quotient must not round it away."""

UNITS = 6
"""Bits of u before the point: beyond, every response is nothing."""


class Fixed(NamedTuple):
    """The constants of a chip in fixed point.

    word                    W, bits of a word
    index_bits              log2 of the table entries for one unit
    folds                   1 if the response halves with each unit of u, else 0: it ends at u = 4
    on_threshold            theta_o as a response
    learning                theta_l squared, in squared steps of an output
    weight_shift            log2 of the step of a weight over the step of an output
    rate, rate_shift        the learning rate is rate / 2^rate_shift
    spread, spread_shift    1 / h^2 is spread / 2^spread_shift
    floor                   smallest squared distance from which a virtual width is made
    gain, gain_shift        the fixed virtual width
    scatters                1 if weights are rounded at random, else 0
    """

    word: int
    index_bits: int
    folds: int
    on_threshold: int
    learning: int
    weight_shift: int
    rate: int
    rate_shift: int
    spread: int
    spread_shift: int
    floor: int
    gain: int
    gain_shift: int
    scatters: int


@activity.of(Fixed)
def fixed_activity(
    numbers: Fixed, table: Integers, z: int, gain: int, shift: int, tally: Tally
) -> int:
    """Within three steps of a word of the exact curve at z.

    A half each comes from the table's entry, the line between two entries, and the rounding of
    the result (twice); the rest from u, whose gain has W - 1 bits.
    """
    W = numbers.word
    before = max(shift - 2 * W + 2, 0)
    near = kept_within(rounded(z, before, tally), 1 << (W + UNITS), tally)
    u = rounded(times(near, gain, tally), shift - before - W, tally)
    tick(tally, COMPARE)
    halvings = 0
    if numbers.folds:
        halvings = u >> W
        u &= (1 << W) - 1
    else:
        u = min(u, (SPAN << W) - 1)
    return rounded(between(table, u, W, numbers.index_bits, tally), halvings, tally)


@compiled
def between(table: Integers, at: int, W: int, index_bits: int, tally: Tally) -> int:
    """The table read at `at` / 2^W units by a straight line."""
    tick(tally, LOOK_UP)
    rest_bits = W - index_bits
    low = table[at >> rest_bits]
    slope = table[(at >> rest_bits) + 1] - low
    rest = at & ((1 << rest_bits) - 1)
    return plus(low, rounded(times(slope, rest, tally), rest_bits, tally), tally)


@output_word.of(Fixed)
def fixed_output_word(numbers: Fixed, total: int, tally: Tally) -> int:
    """Rounded once, after the whole sum."""
    value = rounded(total, numbers.word - 1 - numbers.weight_shift, tally)
    return kept_within(value, largest(numbers.word), tally)


@compiled
def largest(W: int) -> int:
    """The largest word."""
    return (1 << (W - 1)) - 1


@virtual_width.of(Fixed)
def fixed_virtual_width(numbers: Fixed, nearest: int, tally: Tally) -> tuple[int, int]:
    """By feedback: the gain is approached bit by bit until the response is one half (u = 1).

    That takes W - 1 products and comparisons and no division. 1 / h^2 is a constant of the chip.
    """
    W = numbers.word
    tick(tally, COMPARE)
    z, k = normalised(max(nearest, numbers.floor), W, tally)
    gain = 0
    for i in range(W - 1):
        raised = gain | (1 << (W - 2 - i))
        if not above(times(raised, z, tally), 1 << (2 * W - 2), tally):
            gain = raised
    product = times(gain, numbers.spread, tally)
    drop = W - 1 if product >= 1 << (2 * W - 3) else W - 2
    return rounded(product, drop, tally), W - 2 + k + numbers.spread_shift - drop


@fixed_width.of(Fixed)
def fixed_fixed_width(numbers: Fixed) -> tuple[int, int]:
    """A constant of the chip."""
    return numbers.gain, numbers.gain_shift


@alike.of(Fixed)
def fixed_alike(numbers: Fixed, total: int) -> int:
    """Wired one word higher."""
    return total << (numbers.word - 1)


@quotient.of(Fixed)
def fixed_quotient(numbers: Fixed, table: Integers, overlap: int, tally: Tally) -> tuple[int, int]:
    """The table's reciprocal of the overlap's leading bits times the rate."""
    W = numbers.word
    tick(tally, DIVIDE)
    mantissa, k = normalised(overlap, W + 1, tally)
    reciprocal = between(table, mantissa - (1 << W), W, numbers.index_bits, tally)
    q = rounded(times(reciprocal, numbers.rate, tally), W - 1, tally)
    return q, k + numbers.rate_shift + 2 - 2 * W


@part.of(Fixed)
def fixed_part(numbers: Fixed, q: int, error: int, tally: Tally) -> int:
    """With GUARD bits below the step of an error."""
    return rounded(times(q, error, tally), numbers.word - GUARD, tally)


@compiled
def _step(numbers: Fixed, value: int, shift: int, noise: Integers, tally: Tally) -> int:
    """A change of a weight from an accumulator, saturated."""
    limit = largest(numbers.word)
    if shift < 0:
        value = min(max(value, -limit), limit) << min(-shift, numbers.word)
    if numbers.scatters:
        value = scattered(value, max(shift, 0), noise, tally)
    else:
        value = rounded(value, max(shift, 0), tally)
    return kept_within(value, limit, tally)


@change_alike.of(Fixed)
def fixed_change_alike(numbers: Fixed, part: int, shift: int, noise: Integers, tally: Tally) -> int:
    """Rounded once for all neurons."""
    shift += GUARD + numbers.weight_shift - numbers.word
    return _step(numbers, part, shift, noise, tally)


@change_of.of(Fixed)
def fixed_change_of(
    numbers: Fixed, part: int, response: int, shift: int, noise: Integers, tally: Tally
) -> int:
    """Rounded once."""
    product = times(part, response, tally)
    return _step(numbers, product, shift + GUARD - 1 + numbers.weight_shift, noise, tally)


@changed.of(Fixed)
def fixed_changed(numbers: Fixed, weight: int, change: int, tally: Tally) -> int:
    """Saturating."""
    return kept_within(plus(weight, change, tally), largest(numbers.word), tally)
