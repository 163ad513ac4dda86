"""How often an error is how large."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import ArrayLike

from handeye.reports.figures.parts import in_unit, lengths_of
from handeye.reports.style import (
    WIDE,
    Unit,
    color,
    length_unit,
    name_y,
    new_figure,
    significant,
    styled,
)


@styled
def error_distribution(
    before: ArrayLike,
    after: ArrayLike,
    *,
    names: tuple[str, str] = ("Before", "After"),
    unit: Unit | None = None,
    what: str = "Position error",
) -> Figure:
    """Share of observations whose error stays below a size, with median and 95 % marked.

    before (N,) or (N, k), after (M,) or (M, k): error lengths or vectors [m], or what else has a
    `unit`.
    Raises InvalidInput for empty arrays or values that are not finite.
    """
    first, second = lengths_of(before, "before"), lengths_of(after, "after")
    end = max(float(np.percentile(errors, 99)) for errors in (first, second))
    unit = unit or length_unit(end)
    figure = new_figure(WIDE, 320)
    axes = figure.add_subplot()
    levels = np.linspace(0.0, 100.0, 201)
    for errors, name, shade in zip((first, second), names, ("before", "after"), strict=True):
        values = in_unit(errors, unit)
        axes.plot(np.percentile(values, levels), levels, color=color(shade), label=name)
        for level in (50.0, 95.0):
            at = float(np.percentile(values, level))
            axes.plot(at, level, "o", color=color(shade), markersize=6.5, zorder=4)
            axes.annotate(
                f"{significant(at, 2)} {unit.name}",
                (at, level),
                xytext=(9, -4),
                textcoords="offset points",
                va="top",
                color=color(shade),
                fontsize=12.5,
            )
    axes.set_xlim(0.0, end * unit.per_metre * 1.12 or 1.0)
    axes.set_ylim(0.0, 103.0)
    axes.set_yticks([0, 25, 50, 75, 95], ["0", "25", "50", "75", "95"])
    axes.xaxis.set_major_locator(MaxNLocator(5))
    axes.set_xlabel(f"{what} [{unit.name}]")
    name_y(axes, "Share of observations with a smaller error [%]")
    axes.legend(loc="lower right")
    return figure
