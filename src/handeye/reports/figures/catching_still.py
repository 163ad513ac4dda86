"""Learning to catch at a glance: throws at moments of training, and the curve below them."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import GridSpec

from handeye.catching.layout import Layout
from handeye.catching.play import Recording
from handeye.catching.results import Mark, Score, Take, sum_of
from handeye.errors import InvalidInput
from handeye.reports.figures.catching_parts import (
    draw_cup,
    draw_ground,
    percent,
    practised,
    verdict_color,
    view_of,
)
from handeye.reports.figures.parts import thinned
from handeye.reports.style import color, name_y, new_figure, styled

_PANELS = 4


@styled
def catching_still(marks: Sequence[Mark], takes: Sequence[Take], layout: Layout) -> Figure:
    """A picture twice as wide as high, for a document: throws above, the share of catches below.

    marks, takes  of the same moments, in order.
    Raises InvalidInput for no moments, or marks and takes that do not go together.
    """
    if not marks or len(marks) != len(takes):
        raise InvalidInput(f"{len(marks)} marks and {len(takes)} takes do not go together")
    figure = new_figure(1000, 500)
    figure.set_layout_engine("constrained", rect=(0.012, 0.015, 0.976, 0.97))
    shown = thinned(len(marks), _PANELS).tolist()
    grid = GridSpec(2, len(shown), figure=figure, height_ratios=(0.85, 0.9))
    for column in range(len(shown)):
        i = int(shown[column])
        axes = figure.add_subplot(grid[0, column])
        _throws(axes, takes[i].recording, layout)
        total = sum_of(marks[i].scores)
        axes.set_title(
            takes[i].title, fontsize=13, fontweight="normal", color=color("soft"), pad=34
        )
        axes.annotate(
            f"{percent(total.share)} caught", (0.0, 1.0), xycoords="axes fraction",
            xytext=(0, 6), textcoords="offset points", fontsize=20, fontweight="bold",
            color=color("after" if total.share > 0.5 else "before"),
        )  # fmt: skip
    _curve(figure.add_subplot(grid[1, :]), marks, [sum_of(mark.scores) for mark in marks])
    return figure


def _throws(axes: Axes, recording: Recording, layout: Layout) -> None:
    """Every throw up to its end, and the cup as it was then."""
    draw_ground(axes)
    sensed = recording.sensed
    for throw in range(len(recording)):
        during = sensed.time[:, throw] <= recording.final.time[throw]
        shade = verdict_color(recording, throw)
        path = sensed.ball_x[during, throw], sensed.ball_z[during, throw]
        axes.plot(*path, color=shade, linewidth=1.3, alpha=0.75, zorder=2)
        draw_cup(axes, float(recording.final.arm_x[throw]), layout, shade, width=2.2)
    axes.set_xlim(*view_of(layout))
    axes.set_ylim(-0.03, layout.apex[1] + 0.05)
    axes.set_aspect("equal")
    axes.set_axis_off()


def _curve(axes: Axes, marks: Sequence[Mark], totals: Sequence[Score]) -> None:
    places = np.arange(len(marks), dtype=np.float64)
    share = 100.0 * np.array([total.share for total in totals])
    low, high = 100.0 * np.array([total.interval for total in totals]).T
    axes.fill_between(places, low, high, color=color("after"), alpha=0.16, linewidth=0)
    axes.plot(places, share, "o-", color=color("after"), markersize=6)
    axes.set_xticks(places.tolist(), [practised(mark) for mark in marks])
    axes.set_xlim(-0.15, len(marks) - 0.85)
    axes.set_ylim(-4.0, 104.0)
    axes.set_yticks([0, 25, 50, 75, 100])
    axes.grid(axis="x", visible=False)
    name_y(axes, f"Caught [% of {totals[0].n} test throws, with 95 % interval]")
