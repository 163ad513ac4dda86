"""Sections 4.4.1 and 4.6: where balls fly, how they bounce, and how the arm answers a pulse."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from handeye.arrays import Array
from handeye.catching.layout import Interval, Layout
from handeye.reports.figures.catching_parts import draw_cup, draw_ground
from handeye.reports.style import WIDE, color, name_y, new_figure, styled
from handeye.thesis.experiments.catch_flights import FINER
from handeye.thesis.figures.figure import Drawn
from handeye.thesis.records import Records

_LAYOUT = Layout()
_FLIGHTS = "catch-flights"
_SHADES = {"light": "third", "heavy": "before"}
_WIDEST, _FARTHEST = (-0.15, 2.75), (-0.15, 3.15)
_BARS = -0.1, 0.13
"""Height of the first bar below the ground, and from bar to bar [m]."""


def _path(records: Records, ball: str) -> tuple[Array, Array]:
    """The flight of a ball, x and z (M,) [m]."""
    x, z = (records.curve(f"{_FLIGHTS}/{ball}-ball/{name}")[1][0] for name in ("x", "z"))
    return x, z


@styled
def _layout(records: Records) -> Figure:
    figure = new_figure(WIDE, 520)
    axes = figure.add_subplot()
    lowest = _BARS[0] - 2.6 * _BARS[1]
    axes.axhspan(*_LAYOUT.apex, color=color("line"), alpha=0.6, linewidth=0)
    axes.text(
        _WIDEST[0] + 0.03, sum(_LAYOUT.apex) / 2.0, f"top of the flights,\n{_span(_LAYOUT.apex)}",
        va="center", color=color("soft"),
    )  # fmt: skip
    for ball, shade in _SHADES.items():
        x, z = _path(records, ball)
        top = int(np.argmax(z))
        landed = top + int(np.argmax(np.diff(z[top:]) > 0.0)) + 1
        axes.plot(x[:landed], z[:landed], color=color(shade), label=f"{ball} ball")
    corner, size = (_LAYOUT.launch_x[0], _LAYOUT.launch_z[0]), (_LAYOUT.launch_x, _LAYOUT.launch_z)
    axes.add_patch(
        Rectangle(corner, *(b - a for a, b in size), facecolor=color("soft"), alpha=0.35, lw=0)
    )
    draw_ground(axes)
    draw_cup(axes, sum(_LAYOUT.arm_travel) / 2.0, _LAYOUT, color("after"))
    bars = {
        "launch of the ball": (_LAYOUT.launch_x, "soft"),
        "where balls come down": (_LAYOUT.crossing_x, "error4"),
        "travel of the cup's centre": (_LAYOUT.arm_travel, "after"),
    }
    for row, (words, (span, shade)) in enumerate(bars.items()):
        _bar(axes, _BARS[0] - row * _BARS[1], span, words, shade)
    axes.set_xlim(*_WIDEST)
    axes.set_ylim(lowest, 1.62)
    axes.set_yticks(np.arange(0.0, 1.6, 0.25))
    axes.set_aspect("equal")
    axes.legend(loc="upper left", bbox_to_anchor=(0.82, 0.8))
    axes.set_xlabel("x [m]")
    name_y(axes, "Height [m]")
    return figure


def _bar(axes: Axes, height: float, span: Interval, words: str, shade: str) -> None:
    """An interval of x with its name in it, or beside it where it is short."""
    axes.barh(height, span[1] - span[0], left=span[0], height=0.095, color=color(shade), lw=0)
    if span[1] - span[0] > 1.0:
        place, side, ink = sum(span) / 2.0, "center", "card"
    else:
        place, side, ink = span[1] + 0.04, "left", shade
    axes.text(place, height, f"{words}, {_span(span)}", va="center", ha=side, color=color(ink))


def _span(span: Interval) -> str:
    return f"{span[0]:g} to {span[1]:g} m"


@styled
def _bounces(records: Records, ball: str) -> Figure:
    """The whole path of a ball, to the same scale for both."""
    figure = new_figure(WIDE, 420)
    axes = figure.add_subplot()
    x, z = _path(records, ball)
    axes.plot(x, z, color=color(_SHADES[ball]), zorder=3)
    axes.plot(x[::FINER], z[::FINER], "o", color=color(_SHADES[ball]), markersize=3.6, zorder=3)
    draw_ground(axes)
    axes.set_xlim(*_FARTHEST)
    axes.set_ylim(-0.03, 1.55)
    axes.set_aspect("equal")
    axes.set_xlabel("x [m]")
    name_y(axes, "Height of the ball's centre [m]")
    return figure


def _pulse(records: Records, name: str) -> tuple[Array, Array]:
    at, values = records.curve(f"{_FLIGHTS}/heavy-arm/{name}")
    return at, values[0]


@styled
def _voltage(records: Records) -> Figure:
    figure = new_figure(WIDE, 300)
    axes = figure.add_subplot()
    at, voltage = _pulse(records, "voltage")
    axes.axhline(0.0, color=color("axis"), linewidth=1.0)
    # The command is none before the pursuit and after it.
    at = np.concatenate([[-0.05, 0.0], at[1:], [at[-1] + 0.05]])
    voltage = np.concatenate([[0.0], voltage, [0.0]])
    axes.step(at, voltage, where="post", color=color("after"))
    axes.set_xlim(at[0], at[-1])
    axes.set_ylim(-1.25 * max(voltage), 1.25 * max(voltage))
    axes.set_xlabel("Time [s]")
    name_y(axes, "Command voltage [V]")
    return figure


@styled
def _answer(records: Records) -> Figure:
    figure = new_figure(WIDE, 460)
    upper, lower = figure.subplots(2, 1, sharex=True)
    for axes, name, words in (
        (upper, "arm_x", "Position of the arm [m]"),
        (lower, "arm_v", "Velocity of the arm [m/s]"),
    ):
        at, values = _pulse(records, name)
        axes.plot(at, values, color=color("after"), marker="o", markersize=3.2)
        axes.set_xlim(-0.05, at[-1] + 0.05)
        axes.margins(y=0.12)
        name_y(axes, words)
    lower.set_xlabel("Time [s]")
    upper.tick_params(axis="x", labelbottom=False, length=0)
    return figure


LAYOUT = Drawn(
    "4.1",
    "Where catching takes place",
    "The thesis's dimensions are lost with its drawing; these are ours (note E9). A ball is "
    "launched in the rectangle. The two flights have the same start, top and end.",
    _layout,
    (_FLIGHTS,),
)
WORLD = [
    LAYOUT,
    *(
        Drawn(
            number,
            f"A typical flight of the {ball} ball, with bounces",
            f"One dot for each tick of the clock. {seen} Figures 4.3 and 4.4 have the same axes "
            "and show throws with the same start, top and end.",
            lambda records, ball=ball: _bounces(records, ball),
            (_FLIGHTS,),
        )
        for number, ball, seen in (
            ("4.3", "light", "Drag bends the path, and leaves the ball little speed across."),
            ("4.4", "heavy", "Drag is next to nothing: the path is a parabola."),
        )
    ),
]
PULSE = [
    Drawn(
        "4.9",
        "The voltage of a training pursuit",
        "A pulse drives the arm to the middle of the way and its mirror image stops it; the "
        "amplitude and both ends are drawn at random.",
        _voltage,
        (_FLIGHTS,),
    ),
    Drawn(
        "4.10",
        "The heavy arm's answer to that voltage",
        "One dot for each tick of the clock, and one where the arm comes to rest. Damping lets it "
        "stop short of its target of 2.2 m: what it learns from is where it did stop.",
        _answer,
        (_FLIGHTS,),
    ),
]
