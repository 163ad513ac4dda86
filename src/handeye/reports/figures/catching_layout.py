"""The catching place with its dimensions, as in figure 4.1."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle

from handeye.catching.ball import BALLS
from handeye.catching.layout import Interval, Layout
from handeye.catching.play import Recording
from handeye.reports.figures.catching_parts import draw_cup, undisturbed, view_of
from handeye.reports.figures.parts import thinned
from handeye.reports.style import WIDE, color, new_figure, styled

_PATHS = 24
_BELOW = 0.42
_FIRST_BAR = -0.1


@styled
def catching_layout(layout: Layout, recording: Recording) -> Figure:
    """Where balls are launched, how high they fly, where they cross, and where the cup can go.

    The paths are some of the throws in `recording`, until they end or touch the cup.
    """
    left, right = view_of(layout)
    top = layout.apex[1] + 0.12
    figure = new_figure(WIDE, WIDE * (top + _BELOW) / (right - left) + 50.0)
    axes = figure.add_subplot()
    axes.axhspan(*layout.apex, color=color("line"), alpha=0.45, linewidth=0, zorder=0)
    _say(axes, (left + 0.02, sum(layout.apex) / 2), f"apex\n{_range(layout.apex)}", "left")
    _paths(axes, recording)
    axes.plot([left, right], [0.0, 0.0], color=color("axis"), linewidth=1.4, zorder=1)
    corner = (layout.launch_x[0], layout.launch_z[0])
    size = (np.ptp(layout.launch_x), np.ptp(layout.launch_z))
    axes.add_patch(Rectangle(corner, *size, facecolor=color("before"), alpha=0.35, linewidth=0))
    _cup(axes, layout)
    _bar(axes, 0, layout.launch_x, "launch", "before")
    _bar(axes, 1, layout.crossing_x, "crossing", "third")
    _bar(axes, 2, layout.arm_travel, "travel of the cup's centre", "after")
    axes.set_xlim(left, right)
    axes.set_ylim(-_BELOW, top)
    axes.set_aspect("equal")
    axes.spines["left"].set_visible(False)
    axes.grid(visible=False)
    axes.set_yticks([])
    axes.set_xlabel("x [m]")
    return figure


def _paths(axes: Axes, recording: Recording) -> None:
    sensed = recording.sensed
    during = undisturbed(recording)
    for throw in thinned(len(recording.throws), _PATHS).tolist():
        rows = during[:, throw]
        path = sensed.ball_x[rows, throw], sensed.ball_z[rows, throw]
        axes.plot(*path, color=color("before"), linewidth=1.0, alpha=0.35, zorder=2)


def _cup(axes: Axes, layout: Layout) -> None:
    """The cup in the middle of its travel, with a ball above it, to scale."""
    x = sum(layout.arm_travel) / 2.0
    draw_cup(axes, x, layout, color("after"), width=3.5)
    radius = BALLS[0].radius
    axes.add_patch(
        Circle((x, layout.cup.height + 3.0 * radius), radius, color=color("before"), zorder=6)
    )
    size = (
        f"cup {100 * layout.cup.width:g} × {100 * layout.cup.height:g} cm, ball {200 * radius:g} cm"
    )
    _say(axes, (x + layout.cup.width / 2 + 0.04, layout.cup.height + 0.05), size, "left", "ink")


def _bar(axes: Axes, row: int, span: Interval, name: str, shade: str) -> None:
    """An interval of x below the ground, with its name in it or, if it is short, beside it."""
    height = _FIRST_BAR - 0.115 * row
    axes.barh(height, np.ptp(span), left=span[0], height=0.085, color=color(shade), linewidth=0)
    words = f"{name}: {_range(span)}"
    if np.ptp(span) < 1.0:
        _say(axes, (span[1] + 0.04, height), words, "left", shade)
    else:
        axes.text(
            sum(span) / 2.0, height, words, ha="center", va="center", fontsize=12.5,
            color=color("card"),
        )  # fmt: skip


def _range(span: Interval) -> str:
    return f"{span[0]:g} to {span[1]:g} m"


def _say(
    axes: Axes, place: tuple[float, float], words: str, side: str, shade: str = "soft"
) -> None:
    axes.annotate(
        words, place, ha=side, va="center", fontsize=12.5, color=color(shade), zorder=7,
        bbox={"facecolor": color("card"), "alpha": 0.75, "linewidth": 0, "pad": 1.5},
    )  # fmt: skip
