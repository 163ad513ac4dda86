"""How far the hand is expected to miss, all over what the arm can reach."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import ArrayLike

from handeye.arrays import Array, Booleans, shaped
from handeye.errors import InvalidInput
from handeye.reports.figures.maps import ErrorScale
from handeye.reports.figures.parts import thinned, vectors
from handeye.reports.style import (
    ERROR_SCALE,
    WIDE,
    color,
    length_unit,
    new_figure,
    nice_above,
    styled,
)

_CELLS, _DOTS = 24, 250
_LEAST = 2  # poses in a cell that is shown
_FLAT = 0.05  # differences below this share of the largest miss are not worth colours
_NAMES = ("Postures like those of the log", "Other postures")


class _View(NamedTuple):
    """Two coordinates (N, 2) of each place, what they are, and their limits (2, 2)."""

    places: Array
    seen: Array
    names: tuple[str, str]
    box: Array


@styled
def expected_map(
    positions: ArrayLike, expected: ArrayLike, worked: ArrayLike, seen: ArrayLike
) -> Figure:
    """Expected misses from the side and from the top, for postures as were seen and for others.

    positions (N, 3) of the marker in the base frame [m]; expected (N,) root mean square miss
    there [m]; worked (N,) whether the posture is in the range that was seen; seen (M, 3) where the
    marker was measured. Each cell has the colour of the median of the poses that bring the marker
    there; dots are measurements.
    Raises InvalidInput for empty arrays, values that are not finite or shapes that do not match.
    """
    where, measured = vectors(positions, "positions"), vectors(seen, "seen")
    lengths = shaped(expected, (len(where),), "expected")
    within: Booleans = np.asarray(worked, np.bool_)
    if within.shape != lengths.shape:
        raise InvalidInput(f"worked must have shape {lengths.shape}, got {within.shape}")
    kinds = [(w, n) for w, n in zip((within, ~within), _NAMES, strict=True) if w.any()]
    views = [_side(where, measured), _top(where, measured)]
    scale = _scale(lengths)
    heights = [min(400.0 * np.ptp(v.box[:, 1]) / np.ptp(v.box[:, 0]), 440.0) for v in views]
    figure = new_figure(WIDE, sum(heights) + 210.0)
    grid = figure.subplots(
        2, len(kinds), sharex="row", sharey="row", squeeze=False, height_ratios=heights
    )
    for row, view in zip(grid, views, strict=True):
        for axes, (which, name) in zip(row, kinds, strict=True):
            _draw(axes, view, which, lengths, scale)
            axes.set_title(name if view is views[0] else "The same, seen from the top")
    bar = figure.colorbar(
        ScalarMappable(scale.norm, scale.colors),
        ax=[axes for row in grid for axes in row],
        location="bottom", shrink=0.42, aspect=38, pad=0.03,
    )  # fmt: skip
    bar.set_ticks(list(scale.edges), labels=[f"{e:g}" for e in scale.edges[:-1]] + ["more"])
    bar.ax.tick_params(length=0, pad=5)
    bar.ax.grid(visible=False)
    for spine in bar.ax.spines.values():
        spine.set_visible(False)
    bar.set_label(f"Expected miss, root mean square [{scale.unit.name}]")
    return figure


def _scale(lengths: Array) -> ErrorScale:
    """Round steps from the least to the largest: nobody expects to miss by nothing."""
    low, high = np.percentile(lengths, [2, 97])
    unit = length_unit(float(high))
    low, high = float(low) * unit.per_metre, float(high) * unit.per_metre
    step = nice_above(max(high - low, _FLAT * high) / (len(ERROR_SCALE) - 1))
    edges = step * (np.floor(low / step) + np.arange(len(ERROR_SCALE) + 1.0))
    return ErrorScale(unit, edges, 1.0, float(high))


def _side(where: Array, seen: Array) -> _View:
    """Distance from the axis of the base, and height."""
    flat = [np.column_stack([np.hypot(p[:, 0], p[:, 1]), p[:, 2]]) for p in (where, seen)]
    box = _box(flat[0])
    box[0, 0] = 0.0
    return _View(flat[0], flat[1], ("Distance from the base's axis [m]", "Height [m]"), box)


def _top(where: Array, seen: Array) -> _View:
    return _View(where[:, :2], seen[:, :2], ("x of the base [m]", "y of the base [m]"),
                 _box(where[:, :2]))  # fmt: skip


def _box(places: Array) -> Array:
    margin = 0.03 * float(np.ptp(places, axis=0).max())
    return np.stack([places.min(axis=0) - margin, places.max(axis=0) + margin])


def _draw(axes: Axes, view: _View, which: Booleans, lengths: Array, scale: ErrorScale) -> None:
    size = float(np.ptp(view.box, axis=0).max()) / _CELLS
    columns, rows = (max(int(np.ceil(span / size)), 1) for span in np.ptp(view.box, axis=0))
    across: Array = view.box[0, 0] + size * np.arange(columns + 1.0)
    up: Array = view.box[0, 1] + size * np.arange(rows + 1.0)
    cell = ((view.places - view.box[0]) / size).astype(int)
    median = np.full((rows, columns), np.nan)
    for i, j in np.unique(cell[which], axis=0):
        inside = which & (cell[:, 0] == i) & (cell[:, 1] == j)
        if np.count_nonzero(inside) >= _LEAST:
            median[j, i] = np.median(lengths[inside]) * scale.unit.per_metre
    axes.pcolormesh(
        across, up, np.ma.masked_invalid(median), cmap=scale.colors, norm=scale.norm,
        edgecolors="face", linewidth=0.5, zorder=2,
    )  # fmt: skip
    shown = thinned(len(view.seen), _DOTS)
    axes.plot(*view.seen[shown].T, "o", color=color("ink"), markersize=1.6, mew=0, zorder=3)
    axes.set_xlabel(view.names[0])
    axes.set_ylabel(view.names[1])
    axes.set_xlim(*view.box[:, 0])
    axes.set_ylim(*view.box[:, 1])
    axes.set_aspect("equal", adjustable="box")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(5, steps=[1, 2, 2.5, 5, 10]))
