"""Measurements as arrays and JSON-able settings, and back, to the bit."""

from dataclasses import fields
from typing import Any

import numpy as np

from handeye.arrays import Array
from handeye.calibration.arm.measurements.distances import Distances, PlaneContacts
from handeye.calibration.arm.measurements.pixels import PixelSightings
from handeye.calibration.arm.measurements.poses import PoseSightings
from handeye.calibration.arm.measurements.positions import PointSightings, Touches
from handeye.calibration.arm.measurements.seeing import Instrument
from handeye.calibration.arm.measurements.sight import Sight
from handeye.calibration.arm.measurements.stereo import StereoSightings
from handeye.calibration.arm.measurements.unknowns import Frame, Numbers, Points

_KINDS: dict[str, Any] = {
    kind.__name__: kind
    for kind in (
        PointSightings, PoseSightings, PixelSightings, Touches, Distances, PlaneContacts,
        StereoSightings, Sight, Frame, Points, Numbers,
    )
}  # fmt: skip


def to_arrays(instrument: Instrument) -> tuple[dict[str, Array], dict[str, Any]]:
    """The arrays of a measurement by name, and what else it is."""
    arrays: dict[str, Array] = {}
    return arrays, _taken(instrument, "", arrays)


def from_arrays(arrays: dict[str, Array], header: dict[str, Any]) -> Instrument:
    """The measurement of `to_arrays`.

    Raises what Python raises where parts are missing or do not fit together.
    """
    made = _made(header, "", arrays)
    if not isinstance(made, Instrument):
        raise TypeError(f"a {type(made).__name__} is no measurement")
    return made


def _taken(thing: Any, path: str, arrays: dict[str, Array]) -> dict[str, Any]:
    header: dict[str, Any] = {"kind": type(thing).__name__}
    for one in fields(thing):
        value, name = getattr(thing, one.name), path + one.name
        if isinstance(value, np.ndarray):
            arrays[name] = value
        elif type(value).__name__ in _KINDS:
            header[one.name] = _taken(value, f"{name}.", arrays)
        else:
            header[one.name] = value
    return header


def _made(header: dict[str, Any], path: str, arrays: dict[str, Array]) -> Any:
    kind = _KINDS[header["kind"]]
    parts: dict[str, Any] = {}
    for one in fields(kind):
        value: Any = header.get(one.name, arrays.get(path + one.name))
        if _is_a(value, dict):
            value = _made(value, f"{path}{one.name}.", arrays)
        elif _is_a(value, list):
            # JSON has no tuples.
            rows: list[list[Any]] = value
            value = tuple(tuple(row) for row in rows)
        parts[one.name] = value
    return kind(**parts)


def _is_a(value: object, kind: type[object]) -> bool:
    """isinstance, which leaves the checker's knowledge of `Any` alone."""
    return isinstance(value, kind)
