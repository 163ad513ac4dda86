"""One throw from launch to crossing: what moved, what was commanded, what was thought."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from handeye.arrays import Array
from handeye.catching.play import Recording
from handeye.catching.results import IDENTITIES
from handeye.errors import InvalidInput
from handeye.reports.figures.catching_parts import chosen, events_of
from handeye.reports.figures.parts import Label, label_ends
from handeye.reports.style import WIDE, color, name_y, new_figure, styled

_RATIOS = (2.0, 1.1, 1.1, 0.7)
_TALL = 700.0
_BALL, _ARM = "before", "after"
_GOAL = "third"
_HIGHEST_SURPRISE = 4.0
_WORDS, _MARK = 0.15, 0.03
TRACES = ("crossing_x", "crossing_time", "ball", "arm", "ball_surprise", "arm_surprise")
"""What a controller has to record so that its throws can be drawn."""


@styled
def one_throw(recording: Recording, throw: int) -> Figure:
    """Position, voltage, surprise and believed identities over the time of one throw.

    Raises InvalidInput for a throw that is not there, or a recording without the `TRACES`.
    """
    here = chosen(recording, throw)
    missing = [name for name in TRACES if name not in recording.traces]
    if missing:
        raise InvalidInput(f"the controller did not record {', '.join(missing)}")
    time = recording.sensed.time[here, throw]
    figure = new_figure(WIDE, _TALL)
    grid = figure.subplots(4, 1, sharex=True, height_ratios=_RATIOS)
    labels = [
        _positions(grid[0], recording, throw, time),
        _voltage(grid[1], recording.voltage[here, throw], time),
        _surprise(grid[2], recording, throw, time),
        [],
    ]
    _beliefs(grid[3], recording, throw, time)
    for axes, names, share in zip(grid, labels, _RATIOS, strict=True):
        axes.set_xlim(0.0, float(time[-1]))
        axes.grid(axis="x", visible=False)
        label_ends(axes, names, 0.72 * _TALL * share / sum(_RATIOS))
        for event in events_of(recording, throw):
            axes.axvline(event.time, color=color("axis"), lw=1.2, ls=(0, (4, 3)), zorder=1)
    for event in events_of(recording, throw):
        _name_event(grid[0], event.time, event.words)
    grid[-1].set_xlabel("Time since launch [s]")
    return figure


def _name_event(axes: Axes, time: float, words: str) -> None:
    axes.annotate(
        words,
        (time, 1.0),
        xycoords=("data", "axes fraction"),
        xytext=(0, 4),
        textcoords="offset points",
        ha="center",
        va="bottom",
        fontsize=12.5,
        color=color("ink"),
    )


def _positions(axes: Axes, recording: Recording, throw: int, time: Array) -> list[Label]:
    here = chosen(recording, throw)
    ball, cup = (
        values[here, throw] for values in (recording.sensed.ball_x, recording.sensed.arm_x)
    )
    goal = recording.traces["crossing_x"][here, throw]
    thinking = np.isfinite(goal) & (time <= recording.final.time[throw])
    axes.fill_between(time, cup - 0.1, cup + 0.1, color=color(_ARM), alpha=0.14, linewidth=0)
    axes.plot(time, cup, color=color(_ARM))
    axes.plot(time, ball, color=color(_BALL))
    axes.plot(time[thinking], goal[thinking], "o", color=color(_GOAL), ms=3.6, zorder=4)
    crossing = float(recording.throws.crossing_x[throw])
    axes.plot(float(recording.throws.crossing_time[throw]), crossing, "o", mfc="none",
              mec=color("ink"), mew=1.8, ms=12, zorder=6)  # fmt: skip
    axes.yaxis.set_major_locator(MaxNLocator(5))
    name_y(axes, "Position along the rail [m]")
    labels = [
        Label(float(cup[-1]), "cup", color(_ARM)),
        Label(float(ball[-1]), "ball", color(_BALL)),
    ]
    if thinking.any():
        labels.append(Label(float(goal[thinking][-1]), "predicted crossing", color(_GOAL)))
    return labels


def _voltage(axes: Axes, voltage: Array, time: Array) -> list[Label]:
    axes.axhline(0.0, color=color("axis"), linewidth=1.0, zorder=1)
    axes.step(time, voltage, where="post", color=color("ink"), linewidth=1.6)
    axes.fill_between(time, voltage, step="post", color=color("ink"), alpha=0.1, linewidth=0)
    largest = max(float(np.nanmax(np.abs(voltage))), 0.1) * 1.15
    axes.set_ylim(-largest, largest)
    axes.yaxis.set_major_locator(MaxNLocator(3, symmetric=True))
    name_y(axes, "Command voltage [V]")
    return []


def _surprise(axes: Axes, recording: Recording, throw: int, time: Array) -> list[Label]:
    here = chosen(recording, throw)
    labels: list[Label] = []
    highest = 1.5
    for name, shade in (("ball", _BALL), ("arm", _ARM)):
        values = recording.traces[f"{name}_surprise"][here, throw]
        known = np.isfinite(values)
        if known.any():
            highest = max(highest, float(values[known].max()))
            shown = np.minimum(values, _HIGHEST_SURPRISE)
            axes.plot(time, shown, ".-", color=color(shade), linewidth=1.9, markersize=4)
            labels.append(Label(float(shown[known][-1]), name, color(shade)))
    axes.axhline(1.0, color=color("soft"), linewidth=1.4, linestyle=(0, (1.5, 2.5)))
    axes.set_ylim(0.0, min(highest, _HIGHEST_SURPRISE) * 1.1)
    axes.yaxis.set_major_locator(MaxNLocator(3, integer=True))
    name_y(axes, "Surprise (above 1 the predictions do not hold)")
    return labels


def _beliefs(axes: Axes, recording: Recording, throw: int, time: Array) -> None:
    """One strip for the ball and one for the arm, coloured by what it is taken for."""
    here = chosen(recording, throw)
    during = time <= recording.final.time[throw]
    for row, (name, shade) in enumerate((("arm", _ARM), ("ball", _BALL))):
        believed = recording.traces[name][here, throw]
        believed = np.where(np.isfinite(believed), believed, -1).astype(int)[during]
        truth = int(getattr(recording.throws, name)[throw])
        edges = [0, *(np.flatnonzero(np.diff(believed)) + 1).tolist(), len(believed)]
        for start, end in pairwise(edges):
            left = float(time[start])
            right = min(float(time[min(end, len(time) - 1)]), float(recording.final.time[throw]))
            _belief(axes, row, (left, right), int(believed[start]), truth, (name, shade))
    axes.set_yticks([0, 1], ["arm", "ball"])
    axes.set_ylim(-0.5, 1.5)
    axes.grid(visible=False)
    name_y(axes, "What it is taken for (grey: wrong, empty: unknown)")


def _belief(
    axes: Axes,
    row: int,
    span: tuple[float, float],
    identity: int,
    truth: int,
    named: tuple[str, str],
) -> None:
    """A part of a strip, over the times `span`; `named` is the thing and its colour."""
    name, shade = named
    known, right = identity >= 0, identity == truth
    width = span[1] - span[0]
    axes.barh(
        row,
        width,
        left=span[0],
        height=0.62,
        facecolor=color(shade if right else "line") if known else "none",
        edgecolor="none" if known else color("axis"),
        alpha=0.85 if right else 1.0,
    )
    words = f"{IDENTITIES[identity]} {name}" if known else "?"
    if width > (_WORDS if known else _MARK):
        axes.text(
            sum(span) / 2, row, words, ha="center", va="center", fontsize=12,
            color=color("card" if right else "ink"),
        )  # fmt: skip
