"""Every observation's error, and how the typical one changes."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from handeye.reports.figures.parts import (
    Label,
    draw_counts,
    in_unit,
    label_ends,
    lengths_of,
    panels,
    same_length,
    scale_error_axis,
    thinned,
    thousands,
    windows_of,
)
from handeye.reports.style import WIDE, color, filled, length_unit, name_y, new_figure, styled

_DOTS = 900


@styled
def running_error(
    before: ArrayLike,
    online: ArrayLike,
    *,
    neurons: ArrayLike | None = None,
    names: tuple[str, str] = ("without learning", "with learning"),
) -> Figure:
    """Position errors [m] in the order of observation: faint dots, and the mean of each window.

    before, online  error lengths (N,) or error vectors (N, k), both of the same N observations
    neurons         network size after each observation (N,), drawn in a panel below

    A long run shows an evenly spread choice of its dots; the means use every observation.
    Raises InvalidInput for empty arrays, values that are not finite or lengths that differ.
    """
    first = lengths_of(before, "before")
    second = lengths_of(online, "online", len(first))
    tall = 440.0 if neurons is not None else 360.0
    figure = new_figure(WIDE, tall)
    upper, lower = panels(figure, neurons is not None)
    everything = np.concatenate([first, second])
    unit = length_unit(float(np.percentile(everything, 90)))
    shown = thinned(len(first), _DOTS)
    labels: list[Label] = []
    extremes: list[float] = []
    for lengths, name, shade in zip((first, second), names, ("before", "after"), strict=True):
        values = in_unit(lengths, unit)
        upper.plot(
            shown + 1, values[shown], "o", color=color(shade), alpha=0.22, markersize=3.4, mew=0
        )
        places, windows = windows_of(values, int(np.clip(len(values) // 60, 8, 40)))
        upper.plot(places, windows.mean, color=color(shade), label=name, zorder=4)
        labels.append(Label(float(windows.mean[-1]), name, color(shade)))
        extremes += [float(windows.low.min()), float(np.percentile(values, 99.5))]
    scale_error_axis(upper, min(extremes), max(extremes))
    upper.set_xlim(0.0, max(len(first), 2))
    upper.grid(axis="x", visible=False)
    name_y(upper, f"Position error [{unit.name}]")
    label_ends(upper, labels, 0.55 * tall)
    if lower is not None and neurons is not None:
        counts = filled(neurons, "neurons")
        same_length("neurons", counts, len(first))
        draw_counts(lower, np.arange(1.0, len(first) + 1), counts, float(len(first)))
    bottom = lower or upper
    bottom.set_xlabel("Observations")
    thousands(bottom)
    return figure
