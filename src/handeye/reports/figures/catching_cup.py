"""What a ball does as seen from the cup: into it, past it, or off its rim."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from handeye.catching.layout import Layout
from handeye.catching.play import Recording
from handeye.catching.results import IDENTITIES, Take
from handeye.errors import InvalidInput
from handeye.reports.figures.catching_parts import (
    chosen,
    draw_cup,
    draw_ground,
    relative_path,
    verdict_color,
)
from handeye.reports.figures.parts import thinned
from handeye.reports.style import WIDE, color, new_figure, styled

_ASIDE, _ABOVE = 0.5, 0.42
_MOST = 60


@styled
def seen_from_the_cup(recording: Recording, layout: Layout) -> Figure:
    """The last half metre of each throw relative to the cup, by ball and arm.

    Of more than 60 catches or misses, an even choice is drawn. Raises InvalidInput without throws.
    """
    pairs = pairs_of(recording)
    figure = new_figure(WIDE, 310 if len(pairs) < 3 else 540)
    grid = figure.subplots(-(-len(pairs) // 2), min(len(pairs), 2), squeeze=False, sharex=True)
    for axes, (ball, arm) in zip(grid.ravel(), pairs, strict=False):
        throws = recording.throws
        rows = np.flatnonzero((throws.ball == ball) & (throws.arm == arm))
        caught = rows[recording.caught[rows]]
        missed = rows[~recording.caught[rows]]
        for some in (caught, missed):
            for throw in some[thinned(len(some), _MOST)].tolist() if len(some) else ():
                _path(axes, recording, throw)
        _scene(axes, layout)
        axes.set_title(f"{IDENTITIES[ball]} ball, {IDENTITIES[arm]} arm", pad=22)
        axes.annotate(
            f"{len(caught)} of {len(rows)} caught",
            (0.0, 1.0), xycoords="axes fraction", xytext=(0, 4), textcoords="offset points",
            fontsize=12.5, color=color("after" if len(caught) >= len(missed) else "before"),
        )  # fmt: skip
    for axes in grid[-1]:
        axes.set_xlabel("Ahead of the cup's centre [cm]")
    return figure


@styled
def early_and_late(takes: Sequence[Take], throw: int, layout: Layout) -> Figure:
    """The same throw at several moments of training: command voltage, and the ball from the cup.

    takes  the same throws at different moments. Raises InvalidInput without takes, or for a
           throw that is not there.
    """
    if not takes:
        raise InvalidInput("there is nothing to compare: give at least one recording")
    for take in takes:
        chosen(take.recording, throw)
    figure = new_figure(WIDE, 380)
    grid = figure.subplots(
        2, len(takes), squeeze=False, sharex="row", sharey="row", height_ratios=(1.0, 1.1)
    )
    for column, take in enumerate(takes):
        recording = take.recording
        upper, lower = grid[:, column]
        here = chosen(recording, throw)
        time = recording.sensed.time[here, throw]
        during = time <= recording.final.time[throw]
        volts = recording.voltage[here, throw][during]
        upper.axhline(0.0, color=color("axis"), linewidth=1.0, zorder=1)
        upper.step(time[during], volts, where="post", color=color("ink"), linewidth=1.5)
        upper.grid(axis="x", visible=False)
        upper.set_title(take.title, pad=24)
        upper.set_xlabel("Time since launch [s]")
        upper.yaxis.set_major_locator(MaxNLocator(4, symmetric=True))
        upper.margins(x=0.0, y=0.12)
        _path(lower, recording, throw)
        _scene(lower, layout)
        lower.set_xlabel("Ahead of the cup's centre [cm]")
        said = "caught" if recording.caught[throw] else "missed"
        lower.annotate(
            said,
            (1.0, 1.0),
            xycoords="axes fraction",
            ha="right",
            va="top",
            color=verdict_color(recording, throw),
            fontsize=13,
            fontweight="bold",
        )
        if column == 0:
            upper.annotate(
                "Command voltage [V]",
                (0.0, 1.0),
                xycoords="axes fraction",
                xytext=(0, 8),
                textcoords="offset points",
                fontsize=12.5,
                color=color("soft"),
            )
    return figure


def pairs_of(recording: Recording) -> list[tuple[int, int]]:
    """Which identities of ball and arm a recording has together, in order."""
    throws = recording.throws
    if not len(throws):
        raise InvalidInput("the recording has no throws: there is nothing to draw")
    return sorted(set(zip(throws.ball.tolist(), throws.arm.tolist(), strict=True)))


def _path(axes: Axes, recording: Recording, throw: int) -> None:
    x, z = relative_path(recording, throw)
    caught = bool(recording.caught[throw])
    axes.plot(
        100 * x,
        100 * z,
        color=verdict_color(recording, throw),
        lw=1.1 if caught else 1.6,
        alpha=0.45 if caught else 0.9,
        zorder=2 if caught else 3,
        solid_joinstyle="round",
    )


def _scene(axes: Axes, layout: Layout) -> None:
    draw_ground(axes)
    draw_cup(axes, 0.0, layout, color("ink"), per_metre=100.0)
    axes.set_xlim(-100 * _ASIDE, 100 * _ASIDE)
    axes.set_ylim(-1.0, 100 * _ABOVE)
    axes.set_aspect("equal")
    axes.spines["left"].set_visible(False)
    axes.spines["bottom"].set_visible(False)
    axes.set_yticks([])
    axes.grid(visible=False)
