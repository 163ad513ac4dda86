"""Where in a camera's picture its points are missed, and which way."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import ArrayLike

from handeye.arrays import shaped
from handeye.errors import InvalidInput
from handeye.reports.figures.maps import spread
from handeye.reports.style import (
    WIDE,
    color,
    new_figure,
    nice_below,
    significant,
    styled,
)

_ARROW = 0.09
_HEIGHT, _ROOM = 440.0, 96.0


@styled
def errors_in_picture(
    pixels: ArrayLike, before: ArrayLike, after: ArrayLike, *, size: tuple[int, int] | None = None
) -> Figure:
    """Arrows over the picture, from where points were expected towards where they were seen.

    pixels (N, 2) as seen; before, after (N, 2), measured minus predicted [px]. Each panel has a
    scale of its own: what is left is much smaller. size: width and height of the picture, by
    default the box of the points. When N is large, one point is drawn for each cell of a grid.
    Raises InvalidInput for empty arrays, values that are not finite or shapes that do not match.
    """
    where = shaped(pixels, (None, 2), "pixels")
    if not len(where):
        raise InvalidInput("pixels is empty: there is nothing to draw")
    pair = [shaped(one, where.shape, name) for one, name in ((before, "before"), (after, "after"))]
    low, high = where.min(axis=0), where.max(axis=0)
    if size is not None:
        low, high = np.full(2, -0.5), np.array(size) - 0.5
    extent = np.maximum(high - low, 1.0)
    shown = spread(where)
    height = min(0.5 * WIDE * float(extent[1] / extent[0]), _HEIGHT)
    figure = new_figure(WIDE, height + _ROOM)
    panels = figure.subplots(1, 2, sharex=True, sharey=True)
    for axes, errors, name, shade in zip(
        panels, pair, ("Before", "After"), ("before", "after"), strict=True
    ):
        large = float(np.percentile(np.linalg.norm(errors, axis=1), 95)) or 1.0
        times = nice_below(max(_ARROW * float(extent.max()) / large, 1e-6))
        start, end = where[shown] - times * errors[shown], where[shown]
        arrows = axes.quiver(
            *start.T, *(end - start).T, angles="xy", scale_units="xy", scale=1.0,
            color=color(shade), units="inches", width=2.0 / 72.0, headwidth=3.6, headlength=4.2,
            headaxislength=3.8, minlength=0.4, zorder=3,
        )  # fmt: skip
        arrows.set_in_layout(False)
        axes.set_title(
            f"{name}: 95 % below {significant(large, 2)} px, drawn {times:,g}× as long",
            fontsize=12.5, fontweight="normal", color=color("soft"),
        )  # fmt: skip
        axes.set_xlabel("u [px]")
        axes.set_aspect("equal", adjustable="box")
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(MaxNLocator(5, steps=[1, 2, 2.5, 5, 10]))
    # As in a picture, v counts downwards.
    margin = 0.0 if size is not None else 0.08
    panels[0].set_xlim(low[0] - margin * extent[0], high[0] + margin * extent[0])
    panels[0].set_ylim(high[1] + margin * extent[1], low[1] - margin * extent[1])
    panels[0].set_ylabel("v [px]")
    return figure
