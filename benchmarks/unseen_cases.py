"""Logs that robots of other people might write: which robot, sensor, noise and fault each has."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from unseen_robots import ROBOTS

from handeye.arrays import Array
from handeye.observations import PointObservation

BASE, MARKER = "base of the sensor", "marker on the flange"

Spoil = Callable[[Any], Any]
"""Changes what a log says."""


@dataclass(frozen=True)
class Case:
    """A log to be made. faults: row, part, by how much; drift: part, by how much over the log."""

    name: str
    robot: str = "six"
    rows: int = 200
    noise: float = 1e-4
    outliers: float = 0.0
    size: float = 1.0
    oriented: bool = False
    eye: bool = False
    way: str = "random"
    faults: tuple[tuple[int, str, tuple[float, ...]], ...] = ()
    drift: tuple[str, tuple[float, ...]] | None = None
    spoil: Spoil | None = None
    options: tuple[str, ...] = ()
    extra: bool = False
    tip: str | None = None
    held: int | None = None


def _joints(change: Callable[[Array], None]) -> Spoil:
    def spoil(seen: PointObservation) -> PointObservation:
        joints = seen.joints.copy()
        change(joints)
        return replace(seen, joints=joints)

    return spoil


def _reversed(j: int) -> Spoil:
    def change(joints: Array) -> None:
        joints[:, j] *= -1.0

    return _joints(change)


def _scaled(j: int, by: float) -> Spoil:
    def change(joints: Array) -> None:
        joints[:, j] *= by

    return _joints(change)


def _offset(j: int, by: float) -> Spoil:
    def change(joints: Array) -> None:
        joints[:, j] += by

    return _joints(change)


def _swapped(i: int, j: int) -> Spoil:
    def change(joints: Array) -> None:
        joints[:, [i, j]] = joints[:, [j, i]]

    return _joints(change)


def _twice(seen: PointObservation) -> Any:
    every: Any = seen
    return every[np.repeat(np.arange(len(seen)), 2)]


def _no_time(seen: PointObservation) -> PointObservation:
    return replace(seen, time=np.zeros(len(seen)))


def _slip(joint: str, degrees: float = 0.5) -> tuple[str, tuple[float, ...]]:
    return f"encoder offset of joint {joint}", (float(np.radians(degrees)),)


MOVED = (BASE, (3e-3, -2e-3, 2e-3, 0.0, 0.0, 0.0))
REMOUNTED = (MARKER, (2e-3, 2e-3, -3e-3, 0.0, 0.0, 0.0))
CASES = (
    *(Case(f"rows {n}", rows=n) for n in (15, 30, 60, 200, 2000)),
    *(Case(f"oriented, rows {n}", rows=n, oriented=True) for n in (15, 60)),
    *(Case(f"noise {n} mm", noise=n * 1e-3) for n in (0.02, 0.5, 2.0)),
    *(Case(f"outliers {s}", outliers=s) for s in (0.05, 0.2)),
    *(Case(f"errors x {s}", size=s) for s in (0.2, 3.0, 10.0)),
    *(Case(f"robot {r}", r) for r in ROBOTS[1:]),
    *(Case(f"swings {r}", r, way="swing") for r in ("six", "seven", "rail")),
    *(Case(f"few {r}", r, rows=40) for r in ("seven", "scara", "gantry", "rail")),
    Case("eye in hand", eye=True, options=("--eye", "tool0")),
    Case("eye in hand, not told", eye=True),
    Case("links between", extra=True, oriented=True),
    *(Case(f"slip at {k}", faults=((k, *_slip("a2")),)) for k in (20, 40, 64, 100, 190)),
    *(Case(f"moved at {k}", faults=((k, *MOVED),), way="swing") for k in (20, 40, 100, 190)),
    *(
        Case(f"remounted at {k}", "seven", oriented=True, faults=((k, *REMOUNTED),))
        for k in (20, 100)
    ),
    Case("moved at 20 of 60", rows=60, faults=((20, *MOVED),)),
    Case("slip at 40 of 60", rows=60, faults=((40, *_slip("a3", 2.0)),)),
    Case("two changes", rows=300, faults=((50, *_slip("a2")), (180, *MOVED))),
    Case("two at once", faults=((80, *_slip("a3", 1.0)), (80, *REMOUNTED))),
    Case("far moved at 30", faults=((30, BASE, (0.3, -0.2, 0.1, 0.1, 0.0, 0.2)),)),
    Case("base drifts", rows=400, drift=MOVED),
    Case("offset drifts", rows=400, way="swing", drift=_slip("a2")),
    Case("reversed a3", spoil=_reversed(2)),
    Case("reversed j2, 40 rows", "seven", rows=40, spoil=_reversed(1)),
    Case("degrees a5", spoil=_scaled(4, 180.0 / np.pi)),
    Case("millimetres z", "gantry", spoil=_scaled(2, 1000.0)),
    Case("offset 90 a2", spoil=_offset(1, np.pi / 2)),
    Case("offset 20 a4", spoil=_offset(3, np.radians(20.0))),
    Case("swapped a2 a3", spoil=_swapped(1, 2)),
    Case("wrong tip", tip="a4_link"),
    Case("tip too early", options=("--tip", "a5_link")),
    Case("rows twice", rows=60, spoil=_twice),
    Case("a4 does not move", held=3),
    Case("equal times", spoil=_no_time),
    Case("large errors, few, noisy", size=10.0, rows=30, noise=1e-3, outliers=0.1),
    Case("small errors, noisy", size=0.1, noise=1e-3, rows=40),
)  # fmt: skip
