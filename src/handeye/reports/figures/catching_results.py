"""How well crossings are predicted, and how catching grows with practice."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter, StrMethodFormatter

from handeye.arrays import Array, Booleans
from handeye.catching.play import Recording
from handeye.catching.results import IDENTITIES, Mark
from handeye.errors import InvalidInput
from handeye.reports.figures.catching_parts import practised, undisturbed
from handeye.reports.figures.parts import scale_error_axis
from handeye.reports.style import SERIES, WIDE, color, name_y, new_figure, styled

_SHADES = ("before", "after")
_LEAST = 5
"""Throws that a median over them needs."""


@styled
def prediction_error(recording: Recording) -> Figure:
    """How far off the predicted crossing is over the time of flight, in place and in time.

    Medians over the throws of each ball, and above them the band below which 95 % of them stay, on
    logarithmic axes. Predictions after a throw has ended or the cup was touched do not count.
    Raises InvalidInput for a controller that predicts no crossing.
    """
    if "crossing_x" not in recording.traces or "crossing_time" not in recording.traces:
        raise InvalidInput("the controller did not record crossing_x and crossing_time")
    throws, sensed = recording.throws, recording.sensed
    during = undisturbed(recording)
    place = 100 * np.abs(recording.traces["crossing_x"] - throws.crossing_x)
    moment = 1000 * np.abs(recording.traces["crossing_time"] - throws.crossing_time)
    figure = new_figure(WIDE, 340)
    left, right = figure.subplots(1, 2)
    for axes, errors, what in (
        (left, place, "Error of the predicted place [cm]"),
        (right, moment, "Error of the predicted time [ms]"),
    ):
        drawn = np.where(during, errors, np.nan)
        if not np.isfinite(drawn).any():
            raise InvalidInput("no crossing was predicted in any throw: there is nothing to draw")
        for ball in sorted(set(throws.ball.tolist())):
            _spread(axes, sensed.time, drawn, throws.ball == ball, ball)
        axes.set_yscale("log")
        axes.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axes.yaxis.set_minor_formatter(NullFormatter())
        axes.set_xlim(left=0.0)
        axes.set_xlabel("Time since launch [s]")
        axes.grid(axis="x", visible=False)
        name_y(axes, what)
    right.legend(loc="upper right")
    return figure


def _spread(axes: Axes, time: Array, errors: Array, rows: Booleans, ball: int) -> None:
    """Median and 95 % level over the throws `rows` at every tick with enough of them."""
    shade = color(_SHADES[ball])
    enough = np.isfinite(errors[:, rows]).sum(axis=1) >= min(_LEAST, np.count_nonzero(rows))
    if not enough.any():
        return
    at = np.nanmax(time[enough][:, rows], axis=1)
    middle, high = np.nanpercentile(errors[enough][:, rows], (50, 95), axis=1)
    axes.fill_between(at, middle, high, color=shade, alpha=0.16, linewidth=0)
    axes.plot(at, middle, color=shade, label=f"{IDENTITIES[ball]} ball")


@styled
def catching_curve(marks: Sequence[Mark]) -> Figure:
    """Caught share, with its 95 % interval, and position error at every mark of the training.

    One line for each pair of ball and arm, over evenly spaced marks.
    Raises InvalidInput without marks.
    """
    if not marks:
        raise InvalidInput("a learning curve needs at least one mark, got none")
    figure = new_figure(WIDE, 400)
    left, right = figure.subplots(1, 2)
    names = list(dict.fromkeys(score.name for mark in marks for score in mark.scores))
    worst = 0.0
    best = np.inf
    for i, name in enumerate(names):
        shade = color(SERIES[i % len(SERIES)])
        found = [(k, s) for k, mark in enumerate(marks) for s in mark.scores if s.name == name]
        # Side by side, so that intervals that are the same can be told apart.
        places = [k + 0.07 * (i - (len(names) - 1) / 2.0) for k, _ in found]
        share = np.array([score.share for _, score in found])
        low, high = np.array([score.interval for _, score in found]).T
        rms = 100.0 * np.array([score.rms for _, score in found])
        left.errorbar(
            places, 100 * share, yerr=(100 * (share - low), 100 * (high - share)), color=shade,
            linewidth=2.0, elinewidth=1.3, marker="o", markersize=5,
        )  # fmt: skip
        right.plot(places, rms, "o-", color=shade, linewidth=2.0, markersize=5, label=name)
        worst, best = max(worst, float(rms.max())), min(best, float(rms.min()))
    for axes in (left, right):
        axes.set_xticks(range(len(marks)), [practised(mark) for mark in marks])
        axes.set_xlim(-0.4, len(marks) - 0.6)
        axes.grid(axis="x", visible=False)
        axes.set_xlabel("Practised so far")
    left.set_ylim(-4.0, 104.0)
    left.set_yticks([0, 25, 50, 75, 100])
    scale_error_axis(right, best, worst)
    right.legend(loc="upper right")
    name_y(left, "Caught [% of the test throws]")
    name_y(right, "Cup off the crossing, rms [cm]")
    return figure
