"""The workspace in three dimensions, with the error at each place."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

from typing import Any

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import ArrayLike

from handeye.arrays import Array
from handeye.reports.figures.maps import ErrorScale, spread
from handeye.reports.figures.parts import vectors
from handeye.reports.style import WIDE, color, new_figure, styled

_CELLS = 12
_CLEAR = (0.0, 0.0, 0.0, 0.0)


@styled
def error_in_space(positions: ArrayLike, before: ArrayLike, after: ArrayLike) -> Figure:
    """Error arrows in space, before and after learning, on one scale of colour and length.

    positions (N, 3) [m]; before, after (N, 3) error vectors [m]. Arrows start at the observed
    position, as in `error_map`, which shows the same from the top and from the side. When N is
    large, one observation is drawn for each cell of a grid.
    Raises InvalidInput for empty arrays, values that are not finite or shapes that do not match.
    """
    where = vectors(positions, "positions")
    pair = [vectors(before, "before", len(where)), vectors(after, "after", len(where))]
    extent = float(max(np.ptp(where, axis=0).max(), 0.05))
    scale = ErrorScale.of(np.linalg.norm(pair[0], axis=1), extent)
    shown = spread(where, _CELLS)
    figure = new_figure(WIDE, 430)
    panels: list[Any] = []
    for i, (errors, name) in enumerate(zip(pair, ("Before", "After"), strict=True), start=1):
        axes: Any = figure.add_subplot(1, 2, i, projection="3d")
        _draw(axes, where[shown], errors[shown], scale)
        axes.set_title(f"{name} learning")
        panels.append(axes)
    low, high = where.min(axis=0), where.max(axis=0)
    middle, half = 0.5 * (low + high), 0.5 * np.maximum(high - low, 0.3 * extent) * 1.08
    for axes in panels:
        for axis, m, h in zip("xyz", middle, half, strict=True):
            getattr(axes, f"set_{axis}lim")(m - h, m + h)
            getattr(axes, f"set_{axis}label")(f"{axis} [m]", labelpad=9.0)
            getattr(axes, f"{axis}axis").set_major_locator(MaxNLocator(4, steps=[1, 2, 5, 10]))
        axes.set_box_aspect(tuple(half), zoom=1.12)
    bar = figure.colorbar(
        ScalarMappable(scale.norm, scale.colors),
        ax=panels, location="bottom", shrink=0.42, aspect=38, pad=0.02,
    )  # fmt: skip
    bar.set_ticks(list(scale.edges), labels=[f"{e:g}" for e in scale.edges[:-1]] + ["more"])
    bar.ax.tick_params(length=0, pad=5)
    bar.ax.grid(visible=False)
    for spine in bar.ax.spines.values():
        spine.set_visible(False)
    bar.set_label(f"Position error [{scale.unit.name}], drawn {scale.magnification:,g}× as long")
    return figure


def _draw(axes: Any, where: Array, errors: Array, scale: ErrorScale) -> None:
    lengths = np.linalg.norm(errors, axis=1) * scale.unit.per_metre
    norm: Any = scale.norm
    palette: Any = scale.colors
    shades: list[Any] = list(palette(norm(lengths)))
    for begin, error, shade in zip(where, errors, shades, strict=True):
        path = np.stack([begin, begin + scale.magnification * error])
        axes.plot(*path.T, color=shade, linewidth=2.0)
    axes.scatter(*where.T, c=shades, s=9.0, depthshade=False, linewidths=0.0)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_pane_color(_CLEAR)
        axis.line.set_color(color("axis"))
        axis._axinfo["grid"].update(color=color("line"), linewidth=1.0)
    axes.view_init(elev=22.0, azim=-58.0)
