"""The page that tells how the calibration of a described set-up went."""

import numpy as np

from handeye.arrays import Array
from handeye.calibration.arm.measurements import (
    Instrument,
    PixelSightings,
    PointSightings,
    PoseSightings,
)
from handeye.calibration.setups.run import SetupResult
from handeye.calibration.setups.words import advice
from handeye.reports.calibration_parts import parts_table
from handeye.reports.figures import (
    error_distribution,
    error_in_space,
    errors_in_picture,
    residuals_by_joint,
)
from handeye.reports.page import FigureBlock, Page, Prose, Section, StatTiles, Tile
from handeye.reports.setup_tables import (
    Channel,
    channel_of,
    found,
    in_words,
    numbers,
    open_section,
    rejected,
    worst,
)

_TILES = 4


def setup_page(result: SetupResult, name: str, *, date: str = "") -> Page:
    """Headline, numbers and pictures of one run over the set-up that a file `name` describes."""
    channels = [channel_of(name, errors) for name, errors in result.errors.items()]
    arm = result.described.arm
    where = "rows held out" if result.held_out else "rows that were fitted"
    return Page(
        title="Calibration of a set-up",
        headline=_headline(channels),
        subtitle=f"{arm.name}, {name}: {result.n_rows:,} rows of "
        f"{len(result.described.sources)} tables.",
        sections=[
            Section("", [_tiles(channels, where), Prose(_said(advice(held_out=result.held_out)))]),
            Section("In numbers", [numbers(channels, result)]),
            Section("What was found beside the arm", [found(result)]),
            Section("Which part of the arm was off", [parts_table(result.parts)]),
            *open_section(result),
            *(_pictures(channel, result) for channel in channels),
            Section("Rows to look at first", [worst(result)]),
            *rejected(result),
        ],
        settings={
            "description": name,
            "robot": arm.name,
            "validation": "blocks" if result.held_out else "none",
        },
        date=date,
    )


def _said(words: str) -> str:
    return f"{words[0].upper()}{words[1:]}."


def _headline(channels: list[Channel]) -> str:
    first = channels[0]
    before, after = first.medians
    now, was = in_words(after, first.unit), in_words(before, first.unit)
    what = f"{first.name[0].upper()}{first.name[1:]}"
    if after < 0.95 * before:
        return f"{what}: the middle error is now {now}; it was {was}."
    if after <= 1.05 * before:
        return f"{what}: calibrating changed little; the middle error is {now}, as before."
    return f"{what}: calibrating did not help; the middle error is {now}, and was {was}."


def _tiles(channels: list[Channel], where: str) -> StatTiles:
    tiles: list[Tile] = []
    for one in channels[:_TILES]:
        before, after = one.medians
        value, unit = in_words(after, one.unit).replace("°", " °").split()
        note = f"it was {in_words(before, one.unit)}; {one.after.n:,} {where}"
        tiles.append(
            Tile(
                f"Median error: {one.name}", value, unit, note, "good" if after < before else "bad"
            )
        )
    return StatTiles(tiles)


def _pictures(channel: Channel, result: SetupResult) -> Section:
    doubted = result.doubts(channel.name)
    if doubted.any() and not doubted.all():
        channel = channel._replace(errors=channel.errors.only(~doubted))
    errors, unit = channel.errors, channel.unit
    what = f"Error of {channel.name}"
    return Section(
        channel.name[0].upper() + channel.name[1:],
        [
            *_where(channel, result),
            *_by_joint(channel, result),
            FigureBlock(
                error_distribution(errors.before, errors.after, unit=unit, what=what),
                "Further left is better. Dots mark the median and what 95 % stay below. Rows that "
                "are not believed are left out of these pictures, not of the numbers above.",
                f"Cumulative distribution of the error of {channel.name} in {unit.name}.",
            ),
        ],
    )


def _by_joint(channel: Channel, result: SetupResult) -> list[FigureBlock]:
    """Errors over the joints of each chain of links that the channel has rows of."""
    out: list[FigureBlock] = []
    what, joints = f"Error of {channel.name}", result.joints_of(channel.errors)
    for names, rows in joints.items():
        errors = channel.errors.only(np.isin(channel.errors.measurement, rows))
        own: Array = np.empty((len(errors.row), len(names)))
        for one in rows:
            at = errors.measurement == one
            own[at] = result.fit.given[one].joints[errors.row[at]]
        ends = " and ".join(dict.fromkeys(result.ends[one] for one in rows))
        told = f"Of {ends}: a" if len(joints) > 1 else "A"
        out.append(
            FigureBlock(
                residuals_by_joint(
                    names,
                    own,
                    errors.before,
                    errors.after,
                    unit=channel.unit,
                    what=what,
                    sliding=result.sliding,
                ),
                f"{told} slope or a wave along one joint says that this joint is part of the "
                "error.",
                f"{what} over the reading of each joint, {ends}, before and after.",
            )
        )
    return out


def _where(channel: Channel, result: SetupResult) -> list[FigureBlock]:
    """Maps of the error of each instrument that sees points in space, or pixels."""
    out: list[FigureBlock] = []
    used: list[int] = np.unique(channel.errors.measurement).tolist()
    for i in used:
        errors = channel.errors.only(channel.errors.measurement == i)
        one = result.fit.given[i]
        if isinstance(one, PixelSightings):
            size = result.described.sizes.get(one.camera.name)
            out.append(
                FigureBlock(
                    errors_in_picture(
                        one.measured[errors.row], errors.before, errors.after, size=size
                    ),
                    f"Errors over the picture of {one.camera.name}, which shows {_target(one)}. "
                    "Order among the arrows is what lens, camera or arm still do wrong; what is "
                    "left should point every way.",
                    "Maps of the error over the picture before and after.",
                )
            )
        elif channel.errors.unit == "m" and (places := _places(one)) is not None:
            out.append(
                FigureBlock(
                    error_in_space(places[errors.row], errors.before, errors.after),
                    f"Each line begins where {one.sight.sensor.name} saw {_target(one)}, in the "
                    "sensor's frame, and points along the error.",
                    "Error lines in space before and after.",
                )
            )
    return out


def _target(one: Instrument) -> str:
    """What is seen, by its name."""
    seen = one.sight.target
    return seen.name if seen.free.any() else one.sight.points.name


def _places(one: Instrument) -> Array | None:
    """Where a sensor saw its target, (N, 3)."""
    if isinstance(one, PointSightings):
        return one.measured
    return one.measured[:, :3, 3] if isinstance(one, PoseSightings) else None
