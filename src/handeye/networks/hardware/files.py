"""A chip as one file."""

from dataclasses import asdict
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from handeye.errors import FileFormatError
from handeye.io.tensors import read_tensors, write_tensors
from handeye.networks.adaptation import RULES
from handeye.networks.hardware.design import Design
from handeye.networks.hardware.formats import FixedPoint, Ranges
from handeye.networks.hardware.phases import Cells
from handeye.networks.inputs import InputSpace
from handeye.networks.responses import RESPONSES
from handeye.networks.units import Settings

if TYPE_CHECKING:
    from handeye.networks.hardware.chip import HardwareNetwork

FORMAT = "handeye.chip"
VERSION = 1


def save(chip: "HardwareNetwork", path: str | PathLike[str]) -> None:
    """Write the chip; an old file is replaced only once the new one is complete."""
    design, ranges = chip.design, chip.design.ranges
    space = design.inputs
    arrays: dict[str, Any] = {
        **chip.cells._asdict(), "low": space.low, "high": space.high, "scales": space.scales,
    }  # fmt: skip
    header: dict[str, Any] = {
        "settings": design.settings._asdict(),
        "response": _kind(design.response),
        "adaptation": _kind(design.adaptation),
        "fixed": None if design.fixed is None else asdict(design.fixed),
        "noise": int(chip.registers.noise[0]),
    }
    if ranges is not None:
        arrays["middle"] = ranges.middle
        header["ranges"] = {
            name: float(getattr(ranges, name)) for name in ("half", "weights", "outputs")
        }
    write_tensors(path, FORMAT, VERSION, arrays, header)


def load(path: str | PathLike[str]) -> "HardwareNetwork":
    """Read what `save` wrote; FileFormatError says what is wrong with any other file."""
    from handeye.networks.hardware.chip import HardwareNetwork  # noqa: PLC0415 (a cycle)

    arrays, header = read_tensors(path, FORMAT, VERSION, "a stored handeye chip")
    try:
        fixed = None if header["fixed"] is None else FixedPoint(**header["fixed"])
        design = Design(
            InputSpace(arrays["low"], arrays["high"], arrays["scales"]),
            _of_kind(header["response"], RESPONSES),
            _of_kind(header["adaptation"], RULES),
            Settings(**header["settings"]),
            fixed,
            None if fixed is None else Ranges(arrays["middle"], **header["ranges"]),
        )
        cells = Cells(*(np.ascontiguousarray(arrays[name]) for name in Cells._fields))
        return HardwareNetwork(design, cells, int(header["noise"]))
    except (LookupError, TypeError, ValueError) as error:
        raise FileFormatError(
            f"{path}: damaged, its parts do not fit together ({error})"
        ) from error


def _kind(kind: Any) -> dict[str, Any]:
    return {"kind": type(kind).__name__, **kind._asdict()}


def _of_kind(stored: dict[str, Any], known: dict[str, type]) -> Any:
    fields = dict(stored)
    return known[fields.pop("kind")](**fields)
