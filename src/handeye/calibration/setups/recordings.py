"""Measurements of a description whose rows are in a recording of ROS, or an MCAP file."""

from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from handeye.arrays import Array
from handeye.calibration.setups.tables import Given, Source
from handeye.calibration.setups.units import check_units
from handeye.errors import LogError
from handeye.io import columns as col
from handeye.io.bags import BagOptions, read_bag
from handeye.io.yaml_entries import Entry
from handeye.observations import PointObservation

RECORDING = "recording"
"""The key for what is said of a recording: `BagOptions`."""

_NUMBERS, _TRUTHS = ("tolerance", "delay"), ("receipt_times",)


def read_recording(
    path: Path, keys: Mapping[str, Entry], given: Given, *, oriented: bool
) -> tuple[Array, dict[str, Array], Source]:
    """Joints (N, n), columns (N,) of positions and, if `oriented`, orientations; their source.

    The delay of the sensor is estimated with the arm's chain, or as stated.

    Raises:
        InvalidInput: keys that do not fit, or positions where whole poses are needed.
        LogError: as `read_bag`.
        MissingExtra: without the extra `bags`.
    """
    file = keys["file"]
    if "columns" in keys:
        raise keys["columns"].error("goes with a table: a recording has topics, not columns")
    options = _options(keys[RECORDING]) if RECORDING in keys else BagOptions()
    try:
        reading = read_bag(path, arm=given.arm, options=options, skip_bad=given.skip_bad)
    except LogError as error:
        raise LogError(
            f"{file.file}, line {file.line}, {file.name}: {error}\n"
            "  (options such as --points-topic stand here as `recording: {points_topic: ...}`)"
        ) from error
    log = reading.log.in_time_order()
    seen = log.observations
    assert isinstance(seen, PointObservation)
    columns: dict[str, Array] = dict(zip(col.POSITION, seen.position.T, strict=True))
    if oriented:
        if seen.orientation is None:
            topic = reading.report.points_topic
            raise file.error(f"{path}: {topic} has positions alone: say `kind: points`")
        columns |= dict(zip(col.ORIENTATION, seen.orientation.T, strict=True))
    with file.blamed():
        check_units(path, given.arm, seen.joints, columns)
    rejected = tuple(map(str, reading.rejected))
    source = Source(str(path), np.asarray(log.rows), rejected, reading.report)
    return seen.joints, columns, source


def _options(entry: Entry) -> BagOptions:
    found: dict[str, Any] = {}
    for name, one in entry.table([field.name for field in fields(BagOptions)]).items():
        if name in _NUMBERS:
            found[name] = one.number()
        elif name in _TRUTHS:
            if not isinstance(one.value, bool):
                raise one.error(f"must be true or false, got {one.value!r}")
            found[name] = one.value
        else:
            # The marker may be the number of a tag.
            found[name] = one.text() if isinstance(one.value, str) else str(one.whole())
    with entry.blamed():
        return BagOptions(**found)
