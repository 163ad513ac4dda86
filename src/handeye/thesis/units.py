"""Numbers as people read them."""

import math
from typing import NamedTuple


class Scale(NamedTuple):
    """A unit to show values in: values are multiplied by `factor`."""

    name: str
    factor: float


_LENGTHS = (
    (1.0, Scale("m", 1.0)),
    (1e-2, Scale("cm", 1e2)),
    (1e-4, Scale("mm", 1e3)),
    (1e-7, Scale("µm", 1e6)),
)
_COUNTS = ("neurons", "trials")


def scale_for(value: float, unit: str) -> Scale:
    """The unit in which a value, given in `unit`, is easiest to read."""
    if unit == "m":
        return next((s for least, s in _LENGTHS if abs(value) >= least), Scale("m", 1.0))
    if unit.startswith("fraction"):
        return Scale("%", 1e2)
    if unit == "ratio":
        return Scale("", 1.0)
    return Scale(unit, 1.0)


def show(value: float, unit: str, scale: Scale | None = None) -> str:
    """A measured value to three digits, counts to the next whole number: `1.17 cm`."""
    name, factor = scale or scale_for(value, unit)
    text = f"{value:,.0f}" if unit in _COUNTS else digits(value * factor, 3)
    return f"{text} {name}".rstrip()


def show_stated(value: float, unit: str, scale: Scale | None = None) -> str:
    """A value as it was given: no digit more or less."""
    name, factor = scale or scale_for(value, unit)
    return f"{value * factor:,.10g} {name}".rstrip()


def show_interval(middle: float, half: float, unit: str, scale: Scale | None = None) -> str:
    """A mean and half its interval, to the interval's first digit: `1.172 ± 0.006 cm`."""
    name, factor = scale or scale_for(middle, unit)
    if not half * factor > 1e-4:
        return show(middle, unit, scale)
    places = max(-math.floor(math.log10(half * factor)), 0)
    return f"{middle * factor:,.{places}f} ± {half * factor:.{places}f} {name}".rstrip()


def digits(value: float, n: int) -> str:
    """`value` to n digits; whole digits are all kept, and tiny or vast values have an exponent."""
    if value == 0.0:
        return "0"
    power = int(f"{value:.{n - 1}e}".split("e")[1])
    if not -4 <= power < 7:
        return f"{value:.{n - 1}e}"
    return f"{value:,.{max(n - 1 - power, 0)}f}"
