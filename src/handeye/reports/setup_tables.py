"""Tables of the page about a described set-up."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from handeye.calibration.results import ErrorSummary
from handeye.calibration.setups.left_out import ChannelErrors
from handeye.calibration.setups.run import SetupResult
from handeye.calibration.setups.words import SHOWN, found_words
from handeye.reports.page import Badge, Notes, Section, Table
from handeye.reports.style import Unit, length_unit, significant

_PARTS, _ROWS, _FOLDED = 12, 8, 8
# Noise that is less than this part of an error is none.
_NOTHING = 1e-3


class Channel(NamedTuple):
    """What is measured of one kind, by one instrument, and how it is shown."""

    name: str
    errors: ChannelErrors
    unit: Unit
    before: ErrorSummary
    after: ErrorSummary
    medians: tuple[float, float]


def channel_of(name: str, errors: ChannelErrors) -> Channel:
    """A channel in the unit that suits its size."""
    before, after = errors.summaries()
    if errors.unit == "m":
        unit = length_unit(max(before.mean, after.mean))
    else:
        unit = {"rad": Unit("°", 180.0 / np.pi), "px": Unit("px", 1.0)}[errors.unit]
    return Channel(name, errors, unit, before, after, errors.medians())


def in_words(value: float, unit: Unit, digits: int = 2) -> str:
    """A value with its unit."""
    space = "" if unit.name == "°" else "\N{NO-BREAK SPACE}"
    return f"{significant(value * unit.per_metre, digits)}{space}{unit.name}"


def numbers(channels: list[Channel], result: SetupResult) -> Table:
    """Mean, spread and noise of every channel."""
    rows: list[list[str]] = []
    for one in channels:
        stages = zip(
            ("nominal robot", "as found"), one.medians, (one.before, one.after), strict=True
        )
        for stage, median, summary in stages:
            numbers = (median, summary.mean, summary.rms, summary.p95, summary.max)
            between = ""
            if summary.interval is not None:
                ends = [significant(end * one.unit.per_metre, 3) for end in summary.interval]
                between = " to ".join(ends)
            beyond = result.fit.noise[one.name]
            noise = "" if stage == "nominal robot" else "less than stated"
            if noise and beyond > _NOTHING * summary.mean:
                noise = significant(beyond * one.unit.per_metre, 2)
            rows.append(
                [
                    f"{one.name} [{one.unit.name}], {stage}", f"{summary.n:,}",
                    *(significant(v * one.unit.per_metre, 3) for v in numbers), between,
                    noise,
                ]
            )  # fmt: skip
    return Table(
        ("Error", "Rows", "Median", "Mean", "RMS", "95 %", "Max", "Interval of the mean", "Noise"),
        rows,
        caption="Lengths of what was measured minus what was predicted. Noise: standard deviation "
        "of a single value beyond what the description states.",
        emphasis=frozenset(range(1, len(rows), 2)),
    )


def found(result: SetupResult) -> Table:
    """Frames, points and cameras, with standard deviations."""
    rows = [
        ["" if i else result.titled(name), *found_words(name, one)]
        for name, parameters in result.beside.items()
        for i, one in enumerate(parameters)
    ]
    return Table(
        ("", "", "Found", "±", "Stated"),
        rows,
        caption="Positions are in the frame of the link that carries it: of the base, or of the "
        "flange; "
        "turns are from where a frame was stated or placed at first. ±: standard deviation.",
        words=frozenset({0, 1}),
    )


def open_section(result: SetupResult) -> list[Section]:
    """What the rows do not determine."""
    lines = result.undetermined
    if not lines:
        return []
    title = "The rows leave these open, so that ordinary tolerances decide"
    notes = Notes(title, lines, folded=len(lines) > _FOLDED)
    return [Section("What is not determined", [notes])]


def worst(result: SetupResult) -> Table:
    """The rows that fit least."""
    rows: list[list[str | Badge]] = []
    for channel, k in result.worst(_ROWS):
        errors = result.errors[channel]
        file, row = result.source(channel, k)
        unit, times = SHOWN[errors.unit]
        size = times * float(np.linalg.norm(errors.after[k]))
        bad = bool(result.doubts(channel)[k])
        rows.append(
            [
                Path(file).name, str(row), channel,
                f"{significant(size, 3)} {unit}", significant(float(errors.times[k]), 2),
                Badge("not believed", "bad") if bad else Badge("used"),
            ]
        )  # fmt: skip
    return Table(
        ("Table", "Row", "", "Error", "Times the ordinary", ""),
        rows,
        caption="The rows that fit the others least. An ordinary row has 1; look at those far "
        "above. What is not believed hardly counts in the fit.",
        words=frozenset({0, 2, 5}),
    )


def rejected(result: SetupResult) -> list[Section]:
    """Rows that were left out."""
    lines = result.rejected
    if not lines:
        return []
    title = f"{len(lines):,} {'row was' if len(lines) == 1 else 'rows were'} rejected"
    return [Section("Rejected rows", [Notes(title, lines, folded=len(lines) > _FOLDED)])]
