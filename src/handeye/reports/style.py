"""One look for every figure and page: colours, type, sizes and how lengths are written.

Figures are laid out in CSS pixels: one matplotlib point is one pixel of the page at full width.
"""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

from collections.abc import Callable, Generator
from contextlib import contextmanager
from functools import wraps
from typing import Any, NamedTuple, ParamSpec

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from handeye.arrays import Array, finite
from handeye.errors import InvalidInput

P = ParamSpec("P")

WIDE = 912
"""Width of a figure on the page [px]."""

PALETTE: dict[str, tuple[str, str]] = {
    "ink": ("#1c2530", "#e8ecf1"),
    "soft": ("#566373", "#a4b0bd"),
    "line": ("#dfe4ea", "#323c47"),
    "axis": ("#aab4c0", "#596675"),
    "paper": ("#f5f7f9", "#10151b"),
    "card": ("#fefefe", "#181f27"),
    "before": ("#b4500e", "#f0a268"),
    "after": ("#1263a3", "#71b7f0"),
    "third": ("#24745a", "#68c8a4"),
    "fourth": ("#76509a", "#c2a3e0"),
    "error0": ("#8fbbdf", "#4a769c"),
    "error1": ("#c6b48c", "#7f7a68"),
    "error2": ("#dfa055", "#a98149"),
    "error3": ("#cd762a", "#cf8a48"),
    "error4": ("#a34a0f", "#efa562"),
    "error5": ("#672606", "#ffdcb8"),
}
"""Each colour on light and on dark ground.

Blue and orange stay apart for every common kind of colour blindness, all colours of lines and
words have a contrast above 4.5 to the card, and the scale `error0` ... `error5` steps evenly away
from the card, so that large errors stand out in grey as well.
"""

ERROR_SCALE = tuple(light for name, (light, _) in PALETTE.items() if name.startswith("error"))
SERIES = ("after", "before", "third", "fourth", "soft")


def color(name: str) -> str:
    """The palette's colour `name` for light ground; inline SVG follows the reader's scheme."""
    return PALETTE[name][0]


_RC: dict[Any, Any] = {
    "svg.fonttype": "none",
    "text.parse_math": False,
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 13.0,
    "text.color": color("ink"),
    "figure.facecolor": "none",
    "axes.facecolor": "none",
    "axes.edgecolor": color("axis"),
    "axes.labelcolor": color("soft"),
    "axes.labelsize": 12.5,
    "axes.titlesize": 13.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.titlepad": 10.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 1.0,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.unicode_minus": True,
    "grid.color": color("line"),
    "grid.linewidth": 1.0,
    "xtick.color": color("axis"),
    "ytick.color": color("axis"),
    "xtick.labelcolor": color("soft"),
    "ytick.labelcolor": color("soft"),
    "xtick.labelsize": 12.0,
    "ytick.labelsize": 12.0,
    "xtick.major.size": 4.0,
    "ytick.major.size": 0.0,
    "ytick.minor.size": 0.0,
    "lines.linewidth": 2.2,
    "lines.solid_capstyle": "round",
    "legend.frameon": False,
    "legend.fontsize": 12.5,
    "legend.handlelength": 1.6,
    "figure.constrained_layout.h_pad": 0.06,
    "figure.constrained_layout.w_pad": 0.08,
}


@contextmanager
def rc() -> Generator[None]:
    """Use this package's settings inside the block and give back the caller's after it."""
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(_RC)
        yield


def styled(function: Callable[P, Figure]) -> Callable[P, Figure]:
    """Run a figure function under `rc`, whatever the caller has set for itself."""

    @wraps(function)
    def inside(*args: P.args, **kwargs: P.kwargs) -> Figure:
        with rc():
            return function(*args, **kwargs)

    return inside


def new_figure(width: float, height: float) -> Figure:
    """An empty figure of `width` by `height` [px] that belongs to no window."""
    figure = Figure(figsize=(width / 72, height / 72), dpi=72, layout="constrained")
    FigureCanvasAgg(figure)
    return figure


class Unit(NamedTuple):
    """A unit of length: its name and how many make a metre."""

    name: str
    per_metre: float


_UNITS = (Unit("cm", 1e2), Unit("mm", 1e3), Unit("µm", 1e6))


def length_unit(largest: float) -> Unit:
    """The unit that writes lengths up to `largest` [m] with few digits: cm, mm or micrometres."""
    return _UNITS[0 if largest >= 0.02 else 1 if largest >= 2e-5 or largest == 0 else 2]


def length(value: float, beside: float = 0.0, digits: int = 2) -> str:
    """A length [m] in words, as in "4.5 cm" or "0.39 mm", to `digits` significant digits.

    The unit also suits a length `beside` it, so that the two can be compared at a glance.
    """
    unit = length_unit(max(value, beside))
    return f"{significant(value * unit.per_metre, digits)}\N{NO-BREAK SPACE}{unit.name}"


def significant(value: float, digits: int) -> str:
    """`value` rounded to `digits` significant digits, never in powers of ten."""
    if value == 0:
        return "0"
    decimals = digits - 1 - int(np.floor(np.log10(abs(value))))
    return f"{round(value, decimals):,.{max(decimals, 0)}f}"


def nice_below(value: float) -> float:
    """The largest number of the kind 1, 1.5, 2, 3, 4, 5, 6, 8, 10, 15, ... at or below `value`."""
    power = 10.0 ** np.floor(np.log10(value) + 1e-9)
    steps = (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0)
    return float(power * max(step for step in steps if step * power <= value * (1 + 1e-9)))


def nice_above(value: float) -> float:
    """The smallest number of the kind 1, 2, 2.5, 5, 10, 20, ... at or above `value`."""
    power = 10.0 ** np.floor(np.log10(value))
    steps = (1.0, 2.0, 2.5, 5.0, 10.0)
    return float(power * min(step for step in steps if step * power >= value * (1 - 1e-9)))


def filled(value: Any, name: str) -> Array:
    """`value` as a finite array with at least one entry, or InvalidInput."""
    array = finite(value, name)
    if array.size == 0:
        raise InvalidInput(f"{name} is empty: there is nothing to draw")
    return array


def name_y(axes: Axes, text: str) -> None:
    """Write what the vertical axis shows above it, where it reads without turning the head."""
    axes.set_title(text, fontsize=12.5, fontweight="normal", color=color("soft"))
