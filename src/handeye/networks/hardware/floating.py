"""Double precision: the same phases as a processor with floating point would run them."""
# ruff: noqa: ARG001 (every implementation has the arguments of its declaration)

from typing import NamedTuple

from handeye.arrays import Array, Integers
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
from handeye.networks.hardware.curves import curve
from handeye.networks.hardware.operations import DIVIDE, LOOK_UP, Tally, plus, tick, times


class Floating(NamedTuple):
    """The constants of a chip in floating point; shifts are always 0.

    response        the kind of curve
    on_threshold    theta_o
    learning        theta_l squared
    rate            the learning rate
    spread          1 / h^2
    floor           smallest squared distance from which a virtual width is made
    gain            the fixed virtual width
    """

    response: NamedTuple
    on_threshold: float
    learning: float
    rate: float
    spread: float
    floor: float
    gain: float


@activity.of(Floating)
def floating_activity(
    numbers: Floating,
    table: Array,
    z: float,
    gain: float,
    shift: int,
    tally: Tally,
) -> float:
    """One call of the curve's function."""
    tick(tally, LOOK_UP)
    return curve(numbers.response, times(z, gain, tally))


@output_word.of(Floating)
def floating_output_word(numbers: Floating, total: float, tally: Tally) -> float:
    """As it is."""
    return total


@virtual_width.of(Floating)
def floating_virtual_width(numbers: Floating, nearest: float, tally: Tally) -> tuple[float, int]:
    """A second division takes the place of the feedback."""
    tick(tally, DIVIDE)
    return numbers.spread / max(nearest, numbers.floor), 0


@fixed_width.of(Floating)
def floating_fixed_width(numbers: Floating) -> tuple[float, int]:
    """A constant."""
    return numbers.gain, 0


@alike.of(Floating)
def floating_alike(numbers: Floating, total: float) -> float:
    """The same units."""
    return total


@quotient.of(Floating)
def floating_quotient(
    numbers: Floating,
    table: Array,
    overlap: float,
    tally: Tally,
) -> tuple[float, int]:
    """One division."""
    tick(tally, DIVIDE)
    return numbers.rate / overlap, 0


@part.of(Floating)
def floating_part(numbers: Floating, q: float, error: float, tally: Tally) -> float:
    """One product."""
    return times(q, error, tally)


@change_alike.of(Floating)
def floating_change_alike(
    numbers: Floating,
    part: float,
    shift: int,
    noise: Integers,
    tally: Tally,
) -> float:
    """As it is."""
    return part


@change_of.of(Floating)
def floating_change_of(
    numbers: Floating,
    part: float,
    response: float,
    shift: int,
    noise: Integers,
    tally: Tally,
) -> float:
    """One product."""
    return times(part, response, tally)


@changed.of(Floating)
def floating_changed(
    numbers: Floating,
    weight: float,
    change: float,
    tally: Tally,
) -> float:
    """One sum."""
    return plus(weight, change, tally)
