"""Where along each joint the error sits."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

from collections.abc import Collection, Sequence
from math import ceil
from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
from numpy.typing import ArrayLike

from handeye.arrays import Array, shaped
from handeye.errors import InvalidInput
from handeye.reports.figures.parts import in_unit, lengths_of, thinned, vectors
from handeye.reports.style import WIDE, Unit, color, length_unit, new_figure, styled

_DOTS = 320

Component = Literal["length", "x", "y", "z"]


@styled
def residuals_by_joint(
    joint_names: Sequence[str],
    joints: ArrayLike,
    before: ArrayLike,
    after: ArrayLike,
    *,
    component: Component = "length",
    unit: Unit | None = None,
    what: str = "Position error",
    sliding: Collection[str] = (),
) -> Figure:
    """One small panel per joint: the error over that joint's reading, before and after learning.

    joints (N, n) [rad], in [m] those named in `sliding`; before, after (N, k) error vectors [m],
    or what else has a `unit`. `component` picks the length of each vector or one signed component.
    Dots are an evenly spread choice of the observations, the lines are medians of bins over the
    reading. A slope or wave shows that this joint is in error.
    Raises InvalidInput for empty arrays, values that are not finite or shapes that do not match.
    """
    readings = shaped(joints, (None, len(joint_names)), "joints")
    if readings.size == 0:
        raise InvalidInput("joints is empty: there is nothing to draw")
    pair = [_picked(before, "before", component, len(readings))]
    pair.append(_picked(after, "after", component, len(readings)))
    highest = max(float(np.percentile(np.abs(values), 99)) for values in pair)
    unit = unit or length_unit(highest)
    n = len(joint_names)
    columns = n if n < 4 else 2 if n == 4 else 3
    rows = ceil(n / columns)
    figure = new_figure(WIDE, 62.0 + (230.0 if rows == 1 else 196.0 * rows))
    grid = figure.subplots(rows, columns, sharey=True, squeeze=False)
    for i, axes in enumerate(grid.ravel()):
        if i >= n:
            axes.set_axis_off()
            continue
        slides = joint_names[i] in sliding
        along = 1e3 * readings[:, i] if slides else np.degrees(readings[:, i])
        for values, shade in zip(pair, ("before", "after"), strict=True):
            _draw(axes, along, in_unit(values, unit), shade)
        axes.set_title(joint_names[i], fontsize=12.5, pad=6)
        axes.set_xlabel("Position [mm]" if slides else "Angle [°]", labelpad=2)
        steps = [1, 2, 5, 10] if slides else [1, 1.5, 3, 4.5, 6, 9, 10]
        axes.xaxis.set_major_locator(MaxNLocator(5, steps=steps))
        axes.yaxis.set_major_locator(MaxNLocator(4))
    top = highest * unit.per_metre * 1.15 or 1.0
    grid[0, 0].set_ylim(0.0 if component == "length" else -top, top)
    what = what if component == "length" else f"Error along {component}"
    figure.supylabel(f"{what} [{unit.name}]", fontsize=12.5, color=color("soft"))
    handles = [
        Line2D([], [], color=color("before"), marker="o", markersize=4, label="Before learning"),
        Line2D([], [], color=color("after"), marker="o", markersize=4, label="After learning"),
    ]
    figure.legend(handles=handles, loc="outside upper right", ncols=2)
    return figure


def _draw(axes: Axes, along: Array, values: Array, shade: str) -> None:
    shown = thinned(len(along), _DOTS)
    axes.plot(
        along[shown], values[shown], "o", color=color(shade), alpha=0.2, markersize=3.2, mew=0
    )
    count = int(np.clip(len(along) // 40, 6, 24))
    inner = np.linspace(float(along.min()), float(along.max()), count + 1)[1:-1]
    groups = [np.searchsorted(inner, along) == i for i in range(count)]
    least = min(8, ceil(len(along) / count))
    bins = [group for group in groups if np.count_nonzero(group) >= least]
    middles = np.array([(np.median(along[part]), np.median(values[part])) for part in bins])
    axes.plot(middles[:, 0], middles[:, 1], color=color(shade), linewidth=2.0, zorder=4)


def _picked(errors: ArrayLike, name: str, component: Component, rows: int) -> Array:
    if component == "length":
        return lengths_of(errors, name, rows)
    return vectors(errors, name, rows)[:, "xyz".index(component)]
