"""Sections 4.6 and 4.7: one throw, again and again, as the heavy arm practises."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

from collections.abc import Mapping
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from handeye.arrays import Array
from handeye.catching.layout import Layout
from handeye.reports.figures.catching_parts import draw_cup, draw_ground
from handeye.reports.figures.parts import Label, draw_marks, label_ends
from handeye.reports.style import WIDE, color, name_y, new_figure, styled
from handeye.thesis.figures.figure import Drawn
from handeye.thesis.records import Records

_LEARNED = "catching/thesis"
_STAGES: Mapping[str, str] = {
    "10": "10 pursuits", "100": "100 pursuits", "500": "500 pursuits", "1000": "1000 pursuits",
}  # fmt: skip
_ASIDE, _ABOVE = 50.0, 42.0
"""What is shown around the cup [cm]."""
_HEIGHTS = (2.0, 1.2, 1.2)
_TALL = 620.0


def _stream(records: Records, stage: str, name: str) -> tuple[Array, Array]:
    """Times (M,) [s] and values (M,) of one throw."""
    at, values = records.curve(f"{_LEARNED}/{stage}_{name}")
    return at, values[0]


def _end(records: Records, stage: str) -> float:
    """When the throw is over [s]."""
    return float(records.values(f"{_LEARNED}/{stage}_end")[0])


def _grid(height: float) -> tuple[Figure, dict[str, Axes]]:
    figure = new_figure(WIDE, height)
    axes = figure.subplots(2, 2, sharex=True, sharey=True)
    return figure, dict(zip(_STAGES, axes.ravel(), strict=True))


@styled
def _voltages(records: Records) -> Figure:
    figure, panels = _grid(480.0)
    for stage, axes in panels.items():
        at, voltage = _stream(records, stage, "voltage")
        during = at <= _end(records, stage)
        axes.axhline(0.0, color=color("axis"), linewidth=1.0)
        axes.step(at[during], voltage[during], where="post", color=color("after"), linewidth=1.8)
        axes.set_title(
            f"After {_STAGES[stage]}\nCommand voltage [V]", fontsize=12.5, fontweight="normal"
        )
        axes.yaxis.set_major_locator(MaxNLocator(5, symmetric=True))
        axes.margins(y=0.1)
    for stage in ("500", "1000"):
        panels[stage].set_xlabel("Time of flight [s]")
    return figure


@styled
def _paths(records: Records) -> Figure:
    figure, panels = _grid(560.0)
    for stage, axes in panels.items():
        ball, height, arm = (
            100.0 * _stream(records, stage, name)[1] for name in ("ball_x", "ball_z", "arm_x")
        )
        axes.plot(ball - arm, height, color=color("before"), marker="o", markersize=3.2)
        draw_ground(axes)
        draw_cup(axes, 0.0, Layout(), color("after"), per_metre=100.0)
        axes.set_xlim(-_ASIDE, _ASIDE)
        axes.set_ylim(-2.0, _ABOVE)
        axes.set_aspect("equal")
        axes.set_title(f"After {_STAGES[stage]}\nHeight [cm]", fontsize=12.5, fontweight="normal")
    for stage in ("500", "1000"):
        panels[stage].set_xlabel("Ball ahead of the cup's centre [cm]")
    return figure


@styled
def _response(records: Records, stage: str) -> Figure:
    """Places, velocity and voltage over the time of one throw, on the axes of both figures."""
    figure = new_figure(WIDE, _TALL)
    places, speeds, volts = figure.subplots(3, 1, sharex=True, height_ratios=_HEIGHTS)
    shown = ("1000", "mentored")
    latest = max(_end(records, one) for one in shown) + 0.02
    at, ball = _stream(records, stage, "ball_x")
    during = at <= _end(records, stage)
    _, arm = _stream(records, stage, "arm_x")
    places.plot(at[during], ball[during], color=color("before"))
    places.plot(at[during], arm[during], color=color("after"))
    speeds.plot(at[during], _stream(records, stage, "arm_v")[1][during], color=color("after"))
    volts.step(
        at[during], _stream(records, stage, "voltage")[1][during], where="post",
        color=color("ink"), linewidth=1.6,
    )  # fmt: skip
    crossing = float(records.values(f"{_LEARNED}/{stage}_crossing_time")[0])
    for axes, name, words in (
        (places, "arm_x", "Position [m]"),
        (speeds, "arm_v", "Velocity of the arm [m/s]"),
        (volts, "voltage", "Command voltage [V]"),
    ):
        axes.set_xlim(0.0, latest)
        both = np.concatenate([_stream(records, one, name)[1] for one in shown])
        low, high = float(both.min()), float(both.max())
        if axes is places:
            low, high = min(low, float(ball[during].min())), max(high, float(ball[during].max()))
        else:
            axes.axhline(0.0, color=color("axis"), linewidth=1.0)
        room = 0.12 * (high - low or 1.0)
        axes.set_ylim(low - room, high + room)
        axes.yaxis.set_major_locator(MaxNLocator(4))
        name_y(axes, words)
        axes.axvline(crossing - 0.1, color=color("axis"), linewidth=1.2, linestyle=(0, (1, 2)))
        draw_marks(axes, [(crossing, "the ball crosses")], words=axes is places)
        if axes is not volts:
            axes.tick_params(axis="x", labelbottom=False, length=0)
    ends = [Label(float(v[during][-1]), n, color(c))
            for v, n, c in ((ball, "ball", "before"), (arm, "arm", "after"))]  # fmt: skip
    label_ends(places, ends, _TALL * _HEIGHTS[0] / sum(_HEIGHTS) - 40.0)
    volts.set_xlabel("Time of flight [s]")
    return figure


_SAME = "The first throw of the first replicate, heavy arm and ball, both known."

EXAMPLES = [
    Drawn(
        "4.12",
        "Commands for the same throw after more and more practice",
        f"{_SAME} The motor command network is asked anew at every tick, so that its voltages are "
        "spiky.",
        _voltages,
        ("catching",),
        ("arm-learning-curve", "smooth-commands"),
    ),
    Drawn(
        "4.13",
        "The ball as the cup sees it, after more and more practice",
        f"{_SAME} One dot for each tick, until half a second after the end of the throw.",
        _paths,
        ("catching",),
        ("arm-learning-curve",),
    ),
]
RESPONSES = [
    Drawn(
        number,
        title,
        f"{_SAME} Dotted: a tenth of a second before the ball crosses. Figures 4.15 and 4.16 have "
        "the same axes.",
        partial(_response, stage=stage),
        ("catching",),
    )
    for number, stage, title in (
        ("4.15", "1000", "A throw after 1000 pursuits, without the mentor"),
        ("4.16", "mentored", "The same throw after 100 more with the mentor's advice"),
    )
]
