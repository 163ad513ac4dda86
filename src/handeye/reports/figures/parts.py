"""Pieces that several figures share: words at line ends, marks, windows, thinned-out dots."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import GridSpec
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter
from numpy.typing import ArrayLike

from handeye.arrays import Array, Integers
from handeye.errors import InvalidInput
from handeye.reports.style import Unit, color, filled, name_y, nice_below


class Label(NamedTuple):
    """Words for a height of the vertical axis, in the colour of what they name."""

    height: float
    text: str
    color: str


class Windows(NamedTuple):
    """Statistics over consecutive windows of a stream: middle, mean and middle half of each."""

    middle: Array
    mean: Array
    low: Array
    high: Array


def label_ends(axes: Axes, labels: Sequence[Label], height: float) -> None:
    """Write labels right of `axes`, `height` px tall, moved apart where they would overlap.

    Call it when scale and limits are final.
    """
    to_axes = axes.transData + axes.transAxes.inverted()
    left = axes.get_xlim()[0]
    entries = sorted(
        (float(to_axes.transform((left, label.height))[1]), i) for i, label in enumerate(labels)
    )
    heights = np.array([place for place, _ in entries])
    gaps = np.array([1.0 + labels[i].text.count("\n") for _, i in entries]) * 16.5 / height
    for i in range(1, len(heights)):
        heights[i] = max(heights[i], heights[i - 1] + (gaps[i] + gaps[i - 1]) / 2)
    heights -= max(0.0, heights[-1] - 1.0) if len(heights) else 0.0
    for place, (_, i) in zip(heights, entries, strict=True):
        text, shade = labels[i].text, labels[i].color
        axes.text(
            1.015, place, text, color=shade, transform=axes.transAxes, va="center", fontsize=12.5
        )


def draw_marks(axes: Axes, marks: Sequence[tuple[float, str]], *, words: bool = True) -> None:
    """Thin upright lines at each mark, with its words beside the top."""
    left, right = axes.get_xlim()
    for x, text in marks:
        axes.axvline(x, color=color("axis"), linewidth=1.2, linestyle=(0, (4, 3)), zorder=1)
        if words:
            late = x > left + 0.6 * (right - left)
            axes.annotate(
                text,
                (x, 1.0),
                xycoords=("data", "axes fraction"),
                xytext=(-7 if late else 7, -2),
                textcoords="offset points",
                ha="right" if late else "left",
                va="top",
                color=color("ink"),
                fontsize=12.5,
            )


def scale_error_axis(axes: Axes, lowest: float, highest: float) -> None:
    """From zero for errors of one size; logarithmic when they span more than a factor of ten."""
    if lowest > 0 and highest / lowest > 10:
        axes.set_yscale("log")
        axes.set_ylim(lowest * 0.8, highest * 1.25)
        axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.yaxis.set_major_formatter(FuncFormatter(_plain))
        axes.yaxis.set_minor_formatter(NullFormatter())
    else:
        axes.set_ylim(0.0, highest * 1.12 or 1.0)
        axes.yaxis.set_major_locator(MaxNLocator(6, steps=[1, 2, 5, 10]))


def _with_commas(value: float, _position: int | None = None) -> str:
    return f"{value:,.0f}"


def _plain(value: float, _position: int | None = None) -> str:
    return f"{value:g}"


def thousands(axes: Axes) -> None:
    """Write large counts along x as in 5,000."""
    axes.xaxis.set_major_locator(MaxNLocator(6, integer=True))
    axes.xaxis.set_major_formatter(FuncFormatter(_with_commas))


def panels(figure: Figure, with_counts: bool) -> tuple[Axes, Axes | None]:
    """One panel, or two that share x: errors above, a low one for counts below."""
    if not with_counts:
        return figure.add_subplot(), None
    grid = GridSpec(2, 1, figure=figure, height_ratios=(3.2, 1.0))
    upper = figure.add_subplot(grid[0])
    lower = figure.add_subplot(grid[1], sharex=upper)
    upper.tick_params(axis="x", labelbottom=False, length=0)
    return upper, lower


def draw_counts(axes: Axes, x: Array, counts: Array, end: float) -> None:
    """The number of neurons over the run, as steps with the last count in words."""
    shade = color("soft")
    axes.step(x, counts, where="post", color=shade, linewidth=1.8)
    axes.fill_between(x, counts, step="post", color=shade, alpha=0.12, linewidth=0)
    axes.set_ylim(0.0, max(float(counts.max()), 1.0) * 1.15)
    axes.set_yticks([0.0, nice_below(max(float(counts.max()), 1.0))])
    axes.yaxis.set_major_formatter(FuncFormatter(_with_commas))
    axes.set_xlim(right=end)
    name_y(axes, "Neurons in use")
    label_ends(axes, [Label(float(counts[-1]), f"{int(counts[-1]):,} neurons", shade)], 80.0)


def windows_of(values: Array, count: int) -> tuple[Array, Windows]:
    """The last place (1 ... N) of each of about `count` equal windows, and what is in each."""
    n = len(values)
    edges = np.unique(np.linspace(0, n, min(count, n) + 1).round().astype(int))
    parts = [values[a:b] for a, b in pairwise(edges)]
    quarters = np.array([np.percentile(part, (25, 50, 75)) for part in parts])
    means = np.array([part.mean() for part in parts])
    places = edges[1:].astype(np.float64)
    return places, Windows(quarters[:, 1], means, quarters[:, 0], quarters[:, 2])


def thinned(n: int, most: int) -> Integers:
    """Row numbers, evenly spread over 0 ... n - 1, of which there are no more than `most`."""
    return np.unique(np.linspace(0, n - 1, min(n, most)).round().astype(np.int64))


def vectors(value: ArrayLike, name: str, rows: int | None = None) -> Array:
    """Finite vectors (N, 2) or (N, 3), N >= 1, as (N, 3) with z = 0 added."""
    array = filled(value, name)
    if array.ndim != 2 or array.shape[1] not in (2, 3):
        raise InvalidInput(f"{name} must have shape (N, 2) or (N, 3), got {array.shape}")
    same_length(name, array, rows)
    return np.pad(array, ((0, 0), (0, 3 - array.shape[1])))


def lengths_of(value: ArrayLike, name: str, rows: int | None = None) -> Array:
    """Error lengths (N,), taken as given or as the norms of error vectors (N, k)."""
    array = filled(value, name)
    if array.ndim not in (1, 2):
        raise InvalidInput(f"{name} must have shape (N,) or (N, k), got {array.shape}")
    same_length(name, array, rows)
    return np.abs(array) if array.ndim == 1 else np.linalg.norm(array, axis=1)


def same_length(name: str, array: Array, rows: int | None) -> None:
    """Refuse an array that does not have `rows` rows, if that is given."""
    if rows is not None and len(array) != rows:
        raise InvalidInput(f"{name} must have {rows} rows like the others, got {len(array)}")


def in_unit(values: Array, unit: Unit) -> Array:
    """Lengths [m] in `unit`."""
    return values * unit.per_metre
