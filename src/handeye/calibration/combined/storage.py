"""A combined calibrator as plain arrays and JSON-able settings."""

from collections import deque
from dataclasses import asdict
from typing import Any

import numpy as np

from handeye.arrays import Array, finite
from handeye.calibration.arm.sheet import ArmSheet
from handeye.calibration.combined.calibrator import Combined
from handeye.calibration.combined.planar.sheet import DataSheet
from handeye.calibration.combined.robots import Model, Sheet
from handeye.calibration.engine.events import Event
from handeye.calibration.engine.filter import Bank
from handeye.calibration.engine.settings import Hypothesis, Settings
from handeye.calibration.models import PlanarModel
from handeye.networks.recursive import RecursiveNetwork

_NETWORK = "network."
_BANK = "bank."


def combined_to_arrays(combined: Combined) -> tuple[dict[str, Array], dict[str, Any]]:
    """All that was learned, and the settings; it goes on from there as if nothing had happened.

    Raises InvalidInput for a calibrator that is no longer finite.
    """
    engine, leftover = combined.engine, combined.leftover
    arrays = {_BANK + name: part.astype(np.float64) for name, part in engine.bank._asdict().items()}
    arrays |= {"x": engine.x, "shares": engine.shares}
    for name, comparison in (("guard", combined.comparison), ("proof", leftover.comparison)):
        arrays |= {f"{name}.{key}": value for key, value in comparison.arrays().items()}
    settings: dict[str, Any] = {
        "sheet": asdict(combined.sheet),
        "settings": asdict(combined.settings),
        "doubt": engine.doubt,
        "leader": engine.leader,
        "drifting": engine.drifting,
        "events": [asdict(event) for event in engine.events],
        "known": combined.known,
        "past": [asdict(event) for event in combined.past],
        "falling_back": combined.falling_back,
        "proved": leftover.proved,
        "network": None,
    }
    if leftover.network is not None:
        network, settings["network"] = leftover.network.parts()
        arrays |= {_NETWORK + name: array for name, array in network.items()}
    return {name: finite(array, name) for name, array in arrays.items()}, settings


def combined_from_arrays(
    model: Model, arrays: dict[str, Array], settings: dict[str, Any]
) -> Combined:
    """The calibrator of `combined_to_arrays`.

    Raises FileFormatError, or what Python raises where parts are missing or do not fit together.
    """
    fields = dict(settings["settings"])
    ways = tuple(Hypothesis(**way) for way in fields.pop("hypotheses"))
    sheet = _sheet(model, dict(settings["sheet"]))
    combined = Combined(model, sheet, Settings(hypotheses=ways, **fields))
    engine, leftover = combined.engine, combined.leftover
    engine.bank = _bank(engine.bank, arrays)
    engine.x = _like(engine.x, arrays["x"])
    engine.shares = _like(engine.shares, arrays["shares"])
    engine.doubt, engine.leader = float(settings["doubt"]), int(settings["leader"])
    engine.drifting = bool(settings.get("drifting", False))
    if not 0 <= engine.leader < len(ways):
        raise ValueError(f"hypothesis {engine.leader} of {len(ways)} leads")
    engine.events = deque((Event(**e) for e in settings["events"]), engine.events.maxlen)
    for name, comparison in (("guard", combined.comparison), ("proof", leftover.comparison)):
        comparison.restore({key: arrays[f"{name}.{key}"] for key in ("scores", "n")})
    combined.known = int(settings.get("known", 0))
    combined.past = tuple(Event(**e) for e in settings.get("past", []))
    combined.falling_back = bool(settings["falling_back"])
    leftover.proved = bool(settings["proved"])
    if leftover.network is not None:
        inside = {n.removeprefix(_NETWORK): a for n, a in arrays.items() if n.startswith(_NETWORK)}
        leftover.network = RecursiveNetwork.of_parts(inside, settings["network"])
    return combined


def _sheet(model: Model, fields: dict[str, Any]) -> Sheet:
    """The sheet of `dataclasses.asdict`."""
    if isinstance(model, PlanarModel):
        return DataSheet(**fields)
    return ArmSheet.restored(fields)


def _like(old: Array, new: Array) -> Array:
    """A copy of new with the shape and type of old."""
    if new.shape != old.shape:
        raise ValueError(f"shape {new.shape} where {old.shape} belongs")
    return new.astype(old.dtype)


def _bank(old: Bank, arrays: dict[str, Array]) -> Bank:
    parts: dict[str, Any] = {
        name: _like(part, arrays[_BANK + name]) for name, part in old._asdict().items()
    }
    n = parts["d"].shape[1]
    for roots in (parts["roots"][:, :, :n], parts["olds"][:, :, :n]):
        if np.tril(roots, -1).any() or not np.diagonal(roots, axis1=1, axis2=2).all():
            raise ValueError("a root is not an invertible triangular matrix")
    return Bank(**parts)
