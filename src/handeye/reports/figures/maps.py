"""Where in the workspace the hand misses, and which way."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure, SubFigure
from matplotlib.quiver import Quiver
from matplotlib.ticker import MaxNLocator
from numpy.typing import ArrayLike

from handeye.arrays import Array, Integers
from handeye.reports.figures.parts import vectors
from handeye.reports.style import (
    ERROR_SCALE,
    WIDE,
    Unit,
    color,
    length,
    length_unit,
    new_figure,
    nice_above,
    nice_below,
    styled,
)

_CELLS = 18
_PANEL = 400.0


@dataclass(frozen=True)
class ErrorScale:
    """How errors become colours and arrows: the same for every panel of a figure.

    edges          lengths at which the colour changes, in `unit`; the last class has no upper end
    magnification  drawn length of an arrow over its true length
    sample         a round length near the upper end, for the key [m]
    """

    unit: Unit
    edges: Array
    magnification: float
    sample: float

    @classmethod
    def of(cls, lengths: Array, extent: float, arrow: float = 0.12) -> "ErrorScale":
        """A scale in round steps that tells errors up to the 95th percentile of `lengths` apart.

        Such an arrow is drawn about `arrow` of the `extent` [m] of the map.
        """
        large = float(np.percentile(lengths, 95)) or 1e-3
        unit = length_unit(large)
        classes = len(ERROR_SCALE)
        step = nice_above(large * unit.per_metre / (classes - 1))
        edges = step * np.arange(classes + 1.0)
        magnification = nice_below(max(arrow * extent / large, 1.0))
        return cls(unit, edges, magnification, nice_below(large))

    @property
    def norm(self) -> BoundaryNorm:
        """Which class a length in `unit` falls in."""
        return BoundaryNorm(self.edges, len(ERROR_SCALE), clip=True)

    @property
    def colors(self) -> ListedColormap:
        """The colour of each class."""
        return ListedColormap(list(ERROR_SCALE))


@styled
def error_map(positions: ArrayLike, before: ArrayLike, after: ArrayLike) -> Figure:
    """Error arrows over the workspace, before and after learning, on one scale of colour.

    positions (N, 2) or (N, 3) [m]; before, after (N, 2) or (N, 3) error vectors [m].
    Arrows start at the observed position and point along the error, magnified by the factor that
    the key states. Colour gives the full length. Positions in space are seen from the top (x, y)
    and from the side (x, z). When N is large, one observation is drawn for each cell of a grid,
    the same ones before and after, so that noise is not averaged away.
    Raises InvalidInput for empty arrays, values that are not finite or shapes that do not match.
    """
    where = vectors(positions, "positions")
    pair = [vectors(before, "before", len(where)), vectors(after, "after", len(where))]
    spans = np.ptp(where, axis=0)
    views = [(0, 1)] if spans[2] <= 0.02 * spans.max() else [(0, 1), (0, 2)]
    extent = float(max(spans.max(), 0.05))
    scale = ErrorScale.of(np.linalg.norm(pair[0], axis=1), extent)
    box = np.stack([where.min(axis=0), where.max(axis=0)]) + 0.1 * extent * np.array([[-1], [1]])
    heights = [_height(box, view) for view in views]
    figure = new_figure(WIDE, sum(heights) + 70.0 * len(views) + 80.0)
    grid = figure.subplots(
        len(views), 2, sharex="row", sharey="row", squeeze=False, height_ratios=heights
    )
    drawn: list[Quiver] = []
    for row, view in zip(grid, views, strict=True):
        shown = spread(where[:, view])
        for axes, errors, name in zip(row, pair, ("Before", "After"), strict=True):
            drawn.append(draw_errors(axes, where[shown], errors[shown], view, scale))
            side = {(0, 1): ", seen from the top", (0, 2): ", from the side"}[view]
            axes.set_title(name + (side if len(views) > 1 else " learning"))
            axes.set_xlabel(f"{'xyz'[view[0]]} [m]")
            _frame(axes, box, view)
        row[0].set_ylabel(f"{'xyz'[view[1]]} [m]")
    draw_scale(figure, [axes for row in grid for axes in row], drawn[0], scale)
    return figure


def draw_errors(
    axes: Axes, where: Array, errors: Array, view: tuple[int, int], scale: ErrorScale
) -> Quiver:
    """Arrows of `errors` (N, 3) at `where` (N, 3), seen along the axis that `view` leaves out."""
    arrows = axes.quiver(
        where[:, view[0]],
        where[:, view[1]],
        errors[:, view[0]],
        errors[:, view[1]],
        np.linalg.norm(errors, axis=1) * scale.unit.per_metre,
        cmap=scale.colors,
        norm=scale.norm,
        angles="xy",
        scale_units="xy",
        scale=1.0 / scale.magnification,
        units="inches",
        width=2.2 / 72.0,
        headwidth=3.6,
        headlength=4.2,
        headaxislength=3.8,
        minlength=0.6,
        clip_on=False,
        zorder=3,
    )
    arrows.set_in_layout(False)
    return arrows


def draw_scale(
    figure: Figure | SubFigure, panels: list[Axes], arrows: Quiver, scale: ErrorScale
) -> None:
    """Below the panels: a sample arrow with its magnification, and the classes of length."""
    bar = figure.colorbar(
        ScalarMappable(scale.norm, scale.colors),
        ax=panels,
        location="bottom",
        shrink=0.42,
        aspect=38,
        pad=0.04,
        anchor=(1.0, 0.0),
    )
    bar.set_ticks(list(scale.edges), labels=[f"{e:g}" for e in scale.edges[:-1]] + ["more"])
    bar.ax.tick_params(length=0, pad=5)
    bar.ax.grid(visible=False)
    for spine in bar.ax.spines.values():
        spine.set_visible(False)
    bar.set_label(f"Position error [{scale.unit.name}]")
    whole = figure.figure.bbox
    panels[0].quiverkey(
        arrows,
        80.0 / whole.width,
        (figure.bbox.y0 + 36.0) / whole.height,
        scale.sample,
        f"{length(scale.sample)}, drawn {scale.magnification:,g}× as long",
        labelpos="E",
        coordinates="figure",
        color=color("soft"),
        labelcolor=color("soft"),
        fontproperties={"size": 12.5},
    )


def spread(places: Array, cells: int = _CELLS) -> Integers:
    """Rows of `places` (N, 2) to draw: all of few, else the first in each cell of a grid."""
    if len(places) <= cells * cells // 2:
        return np.arange(len(places))
    low, span = places.min(axis=0), max(float(np.ptp(places, axis=0).max()), 1e-12)
    cell = np.minimum((places - low) / span * cells, cells - 1).astype(int)
    return np.sort(np.unique(cell, axis=0, return_index=True)[1]).astype(np.int64)


def _height(box: Array, view: tuple[int, int]) -> float:
    across, up = np.ptp(box[:, view], axis=0)
    return float(min(_PANEL * up / across, 440.0))


def _frame(axes: Axes, box: Array, view: tuple[int, int]) -> None:
    axes.set_xlim(*box[:, view[0]])
    axes.set_ylim(*box[:, view[1]])
    axes.set_aspect("equal", adjustable="box")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(5, steps=[1, 2, 2.5, 5, 10]))
