"""The kinds of measurement that a description may list, and how each is read from its table."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from handeye.calibration.arm.measurements import (
    Distances,
    Instrument,
    PixelSightings,
    PlaneContacts,
    PointSightings,
    PoseSightings,
    StereoSightings,
    Touches,
    settled,
)
from handeye.calibration.setups.recordings import RECORDING, read_recording
from handeye.calibration.setups.tables import (
    HEIGHT,
    PIXELS,
    PLACE,
    POINT,
    Given,
    Listed,
    Source,
    read_columns,
)
from handeye.errors import InvalidInput
from handeye.geometry import make_pose, matrix_from_wxyz
from handeye.io import columns as col
from handeye.io.bags import is_bag
from handeye.io.yaml_entries import Entry
from handeye.robots.urdf import UrdfArm

LINKS = ("link", "base")
"""Keys that say between which links a measurement is, where these are not the robot's own."""

_COMMON = ("kind", "file", "columns", "name", "std", *LINKS)


class Kind(NamedTuple):
    """How one kind is read: keys beside those of all, columns beside joints, and its maker."""

    keys: tuple[str, ...]
    columns: tuple[str, ...]
    make: Callable[[Listed], Instrument]
    optional: tuple[str, ...] = ()


def made(entry: Entry, given: Given) -> tuple[Instrument, Source]:
    """The measurement that an entry of a description lists, placed, and where its rows are from.

    Raises:
        InvalidInput, LogError: with the place in the description, or the row of the table.
    """
    if "kind" not in entry.tables():
        raise entry.error(f"needs kind, one of {', '.join(KINDS)}")
    kind = KINDS[entry.tables()["kind"].text(tuple(KINDS))]
    keys = entry.table((*_COMMON, *kind.keys), ("file",))
    chain = chain_of(keys, given.arm)
    given = replace(given, arm=chain)
    needed = kind.columns
    if "board" in keys:
        needed = (*needed, POINT)
    camera = keys["camera"].text() if "camera" in keys else "camera"
    picture = given.sizes.get(camera) if PIXELS[0] in needed else None
    path = given.folder / keys["file"].text()
    if is_bag(path):
        if RECORDING not in kind.keys:
            raise keys["file"].error(
                "is a recording, which is read for kind points and poses alone"
            )
        oriented = col.ORIENTATION[0] in needed
        joints, columns, source = read_recording(path, keys, given, oriented=oriented)
    elif RECORDING in keys:
        raise keys[RECORDING].error("goes with a recording: .bag, .mcap, .db3 or a folder of them")
    else:
        joints, columns, source = read_columns(keys, given, needed, kind.optional, picture)
    listed = Listed(entry, keys, given, joints, columns)
    with entry.blamed():
        placed = kind.make(listed)
        stated = {**given.frames, **given.points}
        mine = {u.name: stated[u.name] for u in placed.unknowns if u.name in stated}
        placed = settled(placed.given(mine), listed.flanges)[0] if mine else placed
        placed = placed.along(chain) if set(LINKS) & set(keys) else placed
    return placed, source


def chain_of(keys: Mapping[str, Entry], arm: UrdfArm) -> UrdfArm:
    """The chain that a measurement is of, by its keys `link` and `base` or as the arm's.

    Raises:
        InvalidInput: with line and key, for links that are not there or not moved.
    """
    named = {key: keys[key].text() for key in LINKS if key in keys}
    with keys.get("link", keys.get("base", keys["file"])).blamed():
        return arm.between(named.get("link"), named.get("base"))


def _points(listed: Listed) -> Instrument:
    return PointSightings.start(
        listed.joints, listed.flanges, listed.many(*col.POSITION),
        setup=listed.setup("eye_to_hand"), name=listed.name, std=listed.std_of(col.POSITION_STD),
        sensor=listed.called("sensor", "sensor"), target=listed.called("target", "marker"),
    )  # fmt: skip


def _poses(listed: Listed) -> Instrument:
    seen = make_pose(matrix_from_wxyz(listed.many(*col.ORIENTATION)), listed.many(*col.POSITION))
    std = listed.std
    if std.shape == (2,):
        std = np.repeat(std, 3)
    return PoseSightings.start(
        listed.joints, listed.flanges, seen, setup=listed.setup("eye_to_hand"), name=listed.name,
        std=std, sensor=listed.called("sensor", "sensor"), target=listed.called("target", "target"),
    )  # fmt: skip


def _pixels(listed: Listed) -> Instrument:
    board = which = None
    camera = listed.called("camera", "camera")
    if camera not in listed.given.cameras:
        raise InvalidInput(f"describe the camera {camera} under `cameras:`, at least its matrix")
    if "board" in listed.keys:
        name = listed.keys["board"].text()
        if name not in listed.given.points:
            raise listed.keys["board"].error(f"describe the points of {name} under `points:`")
        board, which = listed.given.points[name], listed.columns[POINT].astype(np.int64)
    return PixelSightings.start(
        listed.joints, listed.flanges, listed.many(*PIXELS),
        camera=listed.given.cameras[camera], board=board, which=which,
        setup=listed.setup("eye_to_hand"), name=listed.name, std=listed.std,
        sensor=listed.called("sensor", f"frame of {camera}"),
        target=listed.keys["target"].text() if "target" in listed.keys else None,
    )  # fmt: skip


def _touches(listed: Listed) -> Instrument:
    numbers, which = np.unique(listed.columns[PLACE], return_inverse=True)
    geometry = None
    if "geometry" in listed.keys:
        geometry = listed.keys["geometry"].numbers()
        if geometry.ndim != 2 or geometry.shape != (len(numbers), 3):
            raise listed.keys["geometry"].error(
                f"must list x, y, z of the {len(numbers)} places {PLACE} "
                f"{', '.join(f'{n:g}' for n in numbers)}, in this order"
            )
    within = (
        listed.keys["geometry_within"].number(least=0.0)
        if "geometry_within" in listed.keys
        else 0.0
    )
    return Touches.start(
        listed.joints, listed.flanges, which.reshape(-1), geometry=geometry, geometry_std=within,
        tip=listed.point("tip", "tip", 1e-3), name=listed.name, std=listed.std,
        plate=listed.called("plate", "plate"),
    )  # fmt: skip


def _distances(listed: Listed) -> Instrument:
    within = listed.keys["zero_within"].number(least=0.0) if "zero_within" in listed.keys else 0.0
    return Distances.start(
        listed.joints, listed.flanges, listed.columns["distance_m"],
        tip=listed.point("tip", "wire end", 0.1), zero_std=within, name=listed.name,
        std=listed.std, anchor=listed.called("anchor", "anchor"),
    )  # fmt: skip


def _plane(listed: Listed) -> Instrument:
    return PlaneContacts.start(
        listed.joints, listed.flanges, tip=listed.point("tip", "tip", 1e-3), name=listed.name,
        std=listed.std, plane=listed.called("plane", "plane"), heights=listed.columns.get(HEIGHT),
    )  # fmt: skip


def _stereo(listed: Listed) -> Instrument:
    return StereoSightings.start(
        listed.joints, listed.flanges, listed.many("range_m", "eccentricity_rad"),
        listed.columns["pointing_rad"], name=listed.name,
        std=listed.std if "std" in listed.keys else None,
        target=listed.point("target", "marker", 0.1), sensor=listed.called("sensor", "head"),
    )  # fmt: skip


_SEEN = ("setup", "sensor", "target", RECORDING)

KINDS: dict[str, Kind] = {
    "points": Kind(_SEEN, col.POSITION, _points, col.POSITION_STD),
    "poses": Kind(_SEEN, (*col.POSITION, *col.ORIENTATION), _poses),
    "pixels": Kind(("setup", "sensor", "target", "camera", "board"), PIXELS, _pixels),
    "touches": Kind(("plate", "geometry", "geometry_within", "tip"), (PLACE,), _touches),
    "distances": Kind(("anchor", "tip", "zero_within"), ("distance_m",), _distances),
    "plane": Kind(("plane", "tip"), (), _plane, (HEIGHT,)),
    "stereo": Kind(("sensor", "target"), col.SIGHTING, _stereo),
}
