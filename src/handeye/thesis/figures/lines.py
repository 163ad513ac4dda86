"""Lines with bands over replicates, in one panel: what most figures are made of."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter, NullLocator
from scipy.special import stdtrit

from handeye.arrays import Array
from handeye.intervals import CONFIDENCE
from handeye.reports.figures.parts import Label, draw_marks, label_ends, scale_error_axis, thousands
from handeye.reports.style import SERIES, color, length_unit, name_y
from handeye.thesis.records import Records

ORDERED = ("error1", "error2", "error3", "error4", "error5")
"""Colours of settings that are more or less of the same, from less to more."""

Style = Literal["-", "--", ":"]
STATED = "stated in the thesis"
_NOTHING = 1e-9
_SMALLEST = 1e-9
_FEW = 10.0
"""Up to here an axis may have ticks between whole numbers."""
_LENGTHS = ((1.0, "m"), (1e-2, "cm"), (1e-3, "mm"), (1e-6, "µm"), (1e-9, "nm"))


@dataclass(frozen=True)
class Line:
    """A quantity over something, in SI units: x, mean, low, high (M,).

    name    what a reader should call it; no label when empty
    color   of the palette
    style   as matplotlib names it
    """

    name: str
    x: Array
    mean: Array
    low: Array
    high: Array
    color: str
    style: Style = "-"


@dataclass(frozen=True)
class Panel:
    """What an upright axis shows.

    name      of the quantity
    unit      "m" for a length that is shown in cm, mm or µm, else any unit or none
    stated    points (x, value, colour) that the thesis gives
    levels    (value, words) of levels to compare with
    marks     (x, words) of events
    x         name of the other axis, with its unit
    ends      the last x, by default that of the lines
    key       names stand in a key, in order, and not at line ends
    x_ticks   for a logarithmic other axis, what to write there
    scale     "zero" begins at none, "log" is logarithmic, "auto" is one of them, by the span;
              "decades" is for lengths of very different size, each tick with its own unit
    height    of the panel [px], by which labels at line ends are moved apart
    """

    name: str = "Mean position error"
    unit: str = "m"
    stated: Sequence[tuple[float, float, str]] = ()
    levels: Sequence[tuple[float, str]] = ()
    marks: Sequence[tuple[float, str]] = ()
    x: str = "Trials"
    ends: float | None = None
    key: bool = False
    x_ticks: Sequence[float] = ()
    scale: Literal["zero", "log", "auto", "decades"] = "auto"
    height: float = 250.0


ERRORS = Panel()
"""Mean position errors over trials."""


def band(values: Array) -> tuple[Array, Array, Array]:
    """Mean (M,) of values (replicates, M), and Student's 95 % interval of it, low and high (M,)."""
    n, mean = len(values), values.mean(axis=0)
    if n < 2:
        return mean, mean, mean
    half = float(stdtrit(n - 1, 0.5 + CONFIDENCE / 2.0)) * values.std(axis=0, ddof=1) / np.sqrt(n)
    return mean, mean - half, mean + half


def line(records: Records, path: str, name: str, color: str, style: Style = "-") -> Line:
    """The curve at a path of the records."""
    x, values = records.curve(path)
    return Line(name, x, *band(values), color, style)


def lines(
    records: Records, named: Mapping[str, str], colors: Sequence[str] = SERIES, style: Style = "-"
) -> list[Line]:
    """The curve at each path, by what a reader should call it."""
    return [
        line(records, path, name, colors[i % len(colors)], style)
        for i, (name, path) in enumerate(named.items())
    ]


def ends(records: Records, at: Mapping[float, str], name: str, color: str) -> Line:
    """What quantities ended with, over a number for each path."""
    values = np.array([records.values(path) for path in at.values()]).T
    return Line(name, np.array(list(at), np.float64), *band(values), color)


def function(name: str, x: Array, y: Array, color: str, style: Style = "--") -> Line:
    """A line that has no spread, such as a model."""
    return Line(name, x, y, y, y, color, style)


def until(drawn: Line, last: float) -> Line:
    """The part of a line up to some x."""
    keep = drawn.x <= last
    parts = {name: getattr(drawn, name)[keep] for name in ("x", "mean", "low", "high")}
    return replace(drawn, **parts)


def draw(axes: Axes, drawn: Sequence[Line], panel: Panel) -> None:
    """Draw lines into axes, name what they show, and mark what was stated."""
    least = _SMALLEST if panel.scale == "decades" else 0.0
    given = [value for _, value, _ in panel.stated] + [value for value, _ in panel.levels]
    shown = np.concatenate([_visible(one.mean, least) for one in drawn] + [np.array(given)])
    lowest, highest = float(np.min(shown)), float(np.max(shown))
    unit, factor = panel.unit, 1.0
    if panel.scale == "decades":
        unit = "units as written"
    elif panel.unit == "m":
        unit, factor = length_unit(highest)
    labels = [_draw_line(axes, one, factor, least) for one in drawn]
    for value, words in panel.levels:
        axes.axhline(value * factor, color=color("soft"), linewidth=1.4, linestyle=(0, (1.5, 2.5)))
        labels.append(Label(value * factor, words, color("soft")))
    _scale(axes, panel.scale, lowest * factor, highest * factor, _top(drawn, highest) * factor)
    _scale_x(axes, drawn, panel)
    name_y(axes, f"{panel.name} [{unit}]" if unit else panel.name)
    # A shortened run does not reach all that is to be marked.
    last = axes.get_xlim()[1]
    draw_marks(axes, [mark for mark in panel.marks if mark[0] <= last])
    points = [(x, max(value, least) * factor, c) for x, value, c in panel.stated if x <= last]
    _explain(axes, drawn if panel.key else (), draw_stated(axes, points))
    if panel.key:
        labels = labels[len(drawn) :]
    label_ends(axes, [label for label in labels if label.text], panel.height)


def draw_stated(axes: Axes, points: Sequence[tuple[float, float, str]]) -> list[Line2D]:
    """Hollow diamonds at (x, y) in a colour."""
    return [
        diamond
        for x, y, shade in points
        for diamond in axes.plot(
            x, y, "D", markersize=8.5, markeredgewidth=1.8, markerfacecolor=color("card"),
            markeredgecolor=color(shade), clip_on=False, zorder=6, label=STATED,
        )
    ]  # fmt: skip


def _explain(axes: Axes, keyed: Sequence[Line], diamonds: Sequence[Line2D]) -> None:
    """A legend of keyed lines, and of the diamonds once."""
    handles = [
        Line2D([], [], color=color(one.color), linestyle=one.style, label=one.name)
        for one in keyed
        if one.name
    ]
    if keyed:
        handles += diamonds[:1]
        axes.legend(handles=handles, loc="center left", bbox_to_anchor=(1.01, 0.5))
    elif diamonds:
        axes.legend(handles=diamonds[:1], loc="upper right", labelcolor=color("soft"))


def _draw_line(axes: Axes, one: Line, factor: float, least: float) -> Label:
    shade, mean = color(one.color), _visible(one.mean, least) * factor
    if np.any(one.high > one.low):
        low, high = np.maximum(one.low, 0.0) if np.all(one.mean >= 0.0) else one.low, one.high
        axes.fill_between(
            one.x, _visible(low, least) * factor, _visible(high, least) * factor,
            color=shade, alpha=0.18, linewidth=0,
        )  # fmt: skip
    axes.plot(one.x, mean, color=shade, linestyle=one.style, zorder=3)
    return Label(float(mean[-1]), one.name, shade)


def _visible(values: Array, least: float) -> Array:
    """Rounding errors are nothing: they would stretch a logarithmic axis over many decades."""
    return np.maximum(np.where(np.abs(values) < _NOTHING, 0.0, values), least or -np.inf)


def _top(drawn: Sequence[Line], highest: float) -> float:
    """The top of all bands, unless they would press the lines into the lower half."""
    bands = max(float(np.max(one.high)) for one in drawn)
    return min(max(bands, highest), 2.0 * max(highest, 0.0))


def _scale(axes: Axes, scale: str, lowest: float, highest: float, top: float) -> None:
    if scale == "decades":
        axes.set_yscale("log")
        axes.set_ylim(lowest * 0.6, highest * 1.6)
        axes.yaxis.set_major_locator(LogLocator(numticks=11))
        axes.yaxis.set_major_formatter(FuncFormatter(_as_length))
        axes.yaxis.set_minor_formatter(NullFormatter())
    elif scale == "log" or (scale == "auto" and lowest > 0.0 and highest > 10.0 * lowest):
        scale_error_axis(axes, lowest, max(highest, 10.01 * lowest))
    else:
        axes.set_ylim(min(lowest * 1.12, 0.0), max(highest * 1.12, top) or 1.0)
        axes.yaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
        axes.yaxis.set_major_formatter(FuncFormatter(_plain))


def _scale_x(axes: Axes, drawn: Sequence[Line], panel: Panel) -> None:
    start, end = min(float(one.x[0]) for one in drawn), max(float(one.x[-1]) for one in drawn)
    axes.grid(axis="x", visible=False)
    axes.set_xlabel(panel.x)
    if panel.x_ticks:
        axes.set_xscale("log")
        axes.set_xlim(start, panel.ends or end)
        axes.set_xticks(panel.x_ticks, [f"{tick:g}" for tick in panel.x_ticks])
        axes.xaxis.set_minor_locator(NullLocator())
        return
    axes.set_xlim(min(start, 0.0), panel.ends or end)
    if axes.get_xlim()[1] > _FEW:
        thousands(axes)


def _plain(value: float, _position: int | None = None) -> str:
    return f"{value:,.6g}".replace("-", "\N{MINUS SIGN}")


def _as_length(value: float, _position: int | None = None) -> str:
    size, name = next((u for u in _LENGTHS if value >= 0.999 * u[0]), _LENGTHS[-1])
    return f"{value / size:.3g} {name}"
