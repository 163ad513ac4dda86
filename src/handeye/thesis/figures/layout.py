"""Figures of one or several panels of lines."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

from collections.abc import Sequence
from dataclasses import replace

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from handeye.reports.style import WIDE, new_figure, styled
from handeye.thesis.figures.lines import ERRORS, Line, Panel, draw

Titled = tuple[str, Sequence[Line], Panel]
"""A panel with its title."""

_DECORATION = 85.0
"""What title and axis take of a panel's height [px]."""


@styled
def single(drawn: Sequence[Line], panel: Panel = ERRORS, height: float = 360.0) -> Figure:
    """One panel."""
    figure = new_figure(WIDE, height)
    draw(figure.add_subplot(), drawn, replace(panel, height=height - _DECORATION))
    return figure


@styled
def stacked(
    panels: Sequence[tuple[Sequence[Line], Panel]], heights: Sequence[float], height: float = 480.0
) -> Figure:
    """Panels above each other over the same x."""
    figure = new_figure(WIDE, height)
    axes: list[Axes] = list(
        figure.subplots(len(panels), 1, sharex=True, height_ratios=heights, squeeze=False)[:, 0]
    )
    for one, (drawn, panel), share in zip(axes, panels, heights, strict=True):
        tall = (height - _DECORATION) * share / sum(heights)
        draw(one, drawn, replace(panel, height=tall))
        if one is not axes[-1]:
            one.set_xlabel("")
            one.tick_params(axis="x", labelbottom=False, length=0)
    return figure


@styled
def beside(
    panels: Sequence[Titled],
    columns: int = 2,
    height: float = 360.0,
    shared: bool = True,
) -> Figure:
    """Panels beside each other under titles, by default with the same upright axis."""
    rows = -(-len(panels) // columns)
    figure = new_figure(WIDE, height)
    axes: list[Axes] = list(figure.subplots(rows, columns, sharey=shared, squeeze=False).ravel())
    tall = height / rows - _DECORATION - 25.0
    for one, (title, drawn, panel) in zip(axes, panels, strict=False):
        draw(one, drawn, replace(panel, height=tall))
        quantity = one.get_title(loc="left")
        one.set_title(f"{title}\n{quantity}", fontsize=12.5, fontweight="normal", loc="left")
        one.tick_params(axis="y", labelleft=True)
    for unused in axes[len(panels) :]:
        unused.remove()
    if shared:
        drawn_axes = axes[: len(panels)]
        lows, highs = zip(*(one.get_ylim() for one in drawn_axes), strict=True)
        drawn_axes[0].set_ylim(min(lows), max(highs))
    return figure
