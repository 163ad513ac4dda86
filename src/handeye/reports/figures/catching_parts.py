"""Pieces that the pictures of catching share: the cup, the outcome, the events of a throw."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes

from handeye.arrays import Array, Booleans
from handeye.catching.layout import Layout
from handeye.catching.play import Recording
from handeye.catching.results import Mark
from handeye.errors import InvalidInput
from handeye.reports.style import color

_ROOM = 0.1
CAUGHT, MISSED = "after", "before"
"""Colours of what was caught and what was not."""


class Event(NamedTuple):
    """Something that happened at a time [s] since launch."""

    time: float
    words: str


def chosen(recording: Recording, throw: int) -> Booleans:
    """The ticks (T,) at which this throw was watched, or InvalidInput if there is no such throw."""
    n = len(recording.throws)
    if not 0 <= throw < n:
        raise InvalidInput(f"throw {throw} is not there: the recording has {n} throws")
    return np.isfinite(recording.sensed.time[:, throw])


def undisturbed(recording: Recording) -> Booleans:
    """The ticks (T, N) before a throw has ended and before the ball has touched the cup."""
    return recording.sensed.time <= np.minimum(recording.final.time, recording.contact_time)


def verdict_color(recording: Recording, throw: int) -> str:
    """The colour that says whether the throw was caught."""
    return color(CAUGHT if recording.caught[throw] else MISSED)


def events_of(recording: Recording, throw: int) -> list[Event]:
    """First contact with the cup, the end of the trial, and the first bounce after it, in order.

    What happens within a tick of something more telling is left out.
    """
    sensed = recording.sensed
    end = float(recording.final.time[throw])
    found = [Event(end, "caught" if recording.caught[throw] else "missed")]
    contact = float(recording.contact_time[throw])
    if np.isfinite(contact):
        found.append(Event(contact, "touches the cup"))
    rising = np.flatnonzero((sensed.ball_vz[:-1, throw] < 0.0) & (sensed.ball_vz[1:, throw] > 0.0))
    bounces = sensed.time[rising + 1, throw]
    if len(bounces) and not recording.caught[throw]:
        found.append(Event(float(bounces[0]), "bounces"))
    kept: list[Event] = []
    for event in found:
        if all(abs(event.time - other.time) > 0.03 for other in kept):
            kept.append(event)
    return sorted(kept)


def draw_cup(
    axes: Axes, x: float, layout: Layout, shade: str, *, width: float = 3.0, per_metre: float = 1.0
) -> None:
    """The cup's walls and floor with its centre line at `x` [m], on axes of any unit."""
    half = layout.cup.width / 2.0
    axes.plot(
        per_metre * np.array([x - half, x - half, x + half, x + half]),
        per_metre * np.array([layout.cup.height, 0.0, 0.0, layout.cup.height]),
        color=shade,
        linewidth=width,
        solid_capstyle="round",
        solid_joinstyle="round",
        clip_on=False,
        zorder=5,
    )


def draw_ground(axes: Axes) -> None:
    """The ground, which is all that remains of the axes."""
    axes.axhline(0.0, color=color("axis"), linewidth=1.2, zorder=1)


def relative_path(recording: Recording, throw: int) -> tuple[Array, Array]:
    """The ball's centre as seen from the cup, (M,) each [m]."""
    here = chosen(recording, throw)
    sensed = recording.sensed
    return (sensed.ball_x - sensed.arm_x)[here, throw], sensed.ball_z[here, throw]


def percent(share: float) -> str:
    """A share in words, as in "99.5 %"; only what is exactly so is called 0 % or 100 %."""
    for digits in (1, 2):
        text = f"{100.0 * share:.{digits}f}"
        text = text.rstrip("0").rstrip(".") if "." in text else text
        if text not in {"0", "100"} or share in {0.0, 1.0}:
            return f"{text}\N{NO-BREAK SPACE}%"
    return f"{'more than 99.99' if share > 0.5 else 'less than 0.01'}\N{NO-BREAK SPACE}%"


def practised(mark: Mark) -> str:
    """How much has been practised at a mark, in two short lines."""
    if mark.mentored:
        return f"{mark.pursuits:,} and\nmentor"
    return f"{mark.pursuits:,}\npursuits" if mark.pursuits else "no\npursuit"


def view_of(layout: Layout) -> tuple[float, float]:
    """From left to right [m]: the launch region and wherever the cup can be, with some room."""
    half = layout.cup.width / 2.0
    places = (*layout.launch_x, layout.arm_travel[0] - half, layout.arm_travel[1] + half)
    return min(places) - _ROOM, max(places) + _ROOM
