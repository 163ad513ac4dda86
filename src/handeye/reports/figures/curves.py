"""How the error falls while the robot works."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from handeye.arrays import Array
from handeye.errors import InvalidInput
from handeye.reports.figures.parts import (
    Label,
    draw_counts,
    draw_marks,
    label_ends,
    panels,
    same_length,
    scale_error_axis,
    thousands,
)
from handeye.reports.style import (
    SERIES,
    WIDE,
    Unit,
    color,
    filled,
    length_unit,
    name_y,
    new_figure,
    styled,
)


@dataclass(frozen=True)
class Curve:
    """A named mean error over a run.

    name   what a reader should call it, such as "with learning"
    x      trials or observations seen so far, (M,)
    mean   mean error [m], (M,)
    low, high  optional band around the mean [m], (M,) each
    color  a name of the palette ("before", "after", "third", ...); by position when None
    """

    name: str
    x: ArrayLike
    mean: ArrayLike
    low: ArrayLike | None = None
    high: ArrayLike | None = None
    color: str | None = None


@dataclass(frozen=True)
class _Drawn:
    name: str
    x: Array
    mean: Array
    band: tuple[Array, Array] | None
    color: str


@styled
def learning_curve(
    curves: Sequence[Curve],
    *,
    x_label: str = "Trials",
    marks: Sequence[tuple[float, str]] = (),
    references: Sequence[tuple[float, str]] = (),
    neurons: tuple[ArrayLike, ArrayLike] | None = None,
    height: float | None = None,
) -> Figure:
    """Mean position error over trials or observations, each curve named at its end.

    marks       (x, words) of events, such as (5000, "encoder slips by 2 degrees")
    references  (error [m], words) of levels to compare with, such as the sensor noise
    neurons     (x, count) drawn in a panel below
    height      of the figure [px]

    Raises InvalidInput for no curves, empty curves, values that are not finite or whose lengths
    differ.
    """
    tall = height or (440.0 if neurons is not None else 360.0)
    figure = new_figure(WIDE, tall)
    upper, lower = panels(figure, neurons is not None)
    end = draw_curves(upper, curves, marks, references, 0.55 * tall)
    if lower is not None and neurons is not None:
        x = filled(neurons[0], "neurons x")
        counts = filled(neurons[1], "neurons")
        same_length("neurons", counts, len(x))
        draw_counts(lower, x, counts, end)
        draw_marks(lower, marks, words=False)
    bottom = lower or upper
    bottom.set_xlabel(x_label)
    thousands(bottom)
    return figure


def draw_curves(
    axes: Axes,
    curves: Sequence[Curve],
    marks: Sequence[tuple[float, str]],
    references: Sequence[tuple[float, str]],
    height: float,
) -> float:
    """Draw into `axes`, about `height` px tall; returns the last x."""
    if not curves:
        raise InvalidInput("a learning curve needs at least one curve, got none")
    drawn = [_checked(curve, SERIES[i % len(SERIES)]) for i, curve in enumerate(curves)]
    levels = [float(filled(level, "reference level")) for level, _ in references]
    means = np.concatenate([curve.mean for curve in drawn])
    highest = max(float(means.max()), *levels) if levels else float(means.max())
    positive = np.concatenate([means, np.array(levels)])
    unit = length_unit(highest)
    labels = [_draw_curve(axes, curve, unit) for curve in drawn]
    for level, (_, words) in zip(levels, references, strict=True):
        height_in_unit = level * unit.per_metre
        axes.axhline(
            height_in_unit, color=color("soft"), linewidth=1.4, linestyle=(0, (1.5, 2.5)), zorder=2
        )
        labels.append(Label(height_in_unit, words, color("soft")))
    lowest = float(positive.min()) * unit.per_metre
    scale_error_axis(axes, lowest, highest * unit.per_metre)
    start = min(float(curve.x.min()) for curve in drawn)
    end = max(float(curve.x.max()) for curve in drawn)
    axes.set_xlim(min(start, 0.0), end if end > start else start + 1.0)
    axes.grid(axis="x", visible=False)
    name_y(axes, f"Mean position error [{unit.name}]")
    draw_marks(axes, marks)
    label_ends(axes, labels, height)
    return end


def _draw_curve(axes: Axes, curve: _Drawn, unit: Unit) -> Label:
    mean = curve.mean * unit.per_metre
    if curve.band is not None:
        low, high = (edge * unit.per_metre for edge in curve.band)
        axes.fill_between(curve.x, low, high, color=curve.color, alpha=0.14, linewidth=0)
    single = len(mean) == 1
    axes.plot(
        curve.x, mean, color=curve.color, label=curve.name, marker="o" if single else "", zorder=3
    )
    return Label(float(mean[-1]), curve.name, curve.color)


def _checked(curve: Curve, default: str) -> _Drawn:
    x = filled(curve.x, f"x of {curve.name!r}").ravel()
    mean = filled(curve.mean, f"mean of {curve.name!r}").ravel()
    same_length(f"mean of {curve.name!r}", mean, len(x))
    band = None
    if curve.low is not None and curve.high is not None:
        low, high = filled(curve.low, "low").ravel(), filled(curve.high, "high").ravel()
        same_length(f"low of {curve.name!r}", low, len(x))
        same_length(f"high of {curve.name!r}", high, len(x))
        band = (np.maximum(low, 0.0), high)
    return _Drawn(curve.name, x, mean, band, color(curve.color or default))
