"""One measurement of a description: its keys, and its table."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from handeye.arrays import Array
from handeye.calibration.arm.measurements import Frame, Numbers, Points
from handeye.calibration.hand_eye.samples import Setup
from handeye.io import columns as col
from handeye.io.records import usable
from handeye.io.tables import read_table
from handeye.io.yaml_entries import Entry
from handeye.robots.urdf import UrdfArm

POINT, PLACE = "point", "place"
"""Columns of whole numbers: the point of a board, the place that is touched."""

_SETUPS: tuple[Setup, ...] = ("eye_to_hand", "eye_in_hand")


@dataclass(frozen=True, eq=False)
class Given:
    """What a description says apart from its measurements."""

    arm: UrdfArm
    folder: Path
    skip_bad: bool
    frames: Mapping[str, Frame]
    points: Mapping[str, Points]
    cameras: Mapping[str, Numbers]


@dataclass(frozen=True, eq=False)
class Listed:
    """One measurement of a description: its keys, and its table as columns (N,)."""

    entry: Entry
    keys: Mapping[str, Entry]
    given: Given
    joints: Array
    columns: Mapping[str, Array]

    @property
    def flanges(self) -> Array:
        """Nominal T_base_flange (N, 4, 4)."""
        return self.given.arm.poses(self.joints)

    @property
    def name(self) -> str:
        """Of the instrument, empty if it has none."""
        return self.keys["name"].text() if "name" in self.keys else ""

    @property
    def std(self) -> Array:
        """One standard deviation, or one for each value; 0 if none is stated."""
        return self.keys["std"].numbers() if "std" in self.keys else np.zeros(())

    def called(self, key: str, default: str) -> str:
        """The name that a key gives to a frame, or to points."""
        return self.keys[key].text() if key in self.keys else default

    def setup(self, default: Setup) -> Setup:
        """Where the sensor sits."""
        if "setup" not in self.keys:
            return default
        text = self.keys["setup"].text(_SETUPS)
        return "eye_in_hand" if text == "eye_in_hand" else "eye_to_hand"

    def point(self, key: str, default: str, tolerance: float) -> Points:
        """The point of the flange that a key names: as stated, or near its origin."""
        name = self.called(key, default)
        return self.given.points.get(name) or Points.near(name, tolerance=tolerance)

    def many(self, *names: str) -> Array:
        """Columns (N, k)."""
        return np.column_stack([self.columns[name] for name in names])


def read_columns(
    keys: Mapping[str, Entry], given: Given, needed: Sequence[str]
) -> tuple[Array, dict[str, Array]]:
    """Joints (N, n) and the needed columns (N,) of a measurement's table.

    Raises:
        InvalidInput: no such file or columns, with the line of the description.
        LogError: rows that cannot be used.
    """
    path = given.folder / keys["file"].text()
    if not path.is_file():
        raise keys["file"].error(f"{path} is not there: give a path beside the description")
    table = read_table(path)
    of_joints = [f"{name}{col.JOINT_SUFFIX}" for name in given.arm.joint_names]
    wanted = [*of_joints, *needed]
    called = {name: name for name in wanted}
    if "columns" in keys:
        called |= {name: one.text() for name, one in keys["columns"].table(wanted).items()}
    missing = [there for there in called.values() if there not in table.columns]
    if missing:
        hints = [hint for name in missing if (hint := col.near_name(name, table.columns))]
        lines = [
            f"{path} lacks the columns {', '.join(missing)}: add them, or map them: `columns:`",
            f"found: {', '.join(table.columns)}",
            *hints,
        ]
        raise keys["file"].error("\n  ".join(lines))
    values = table.numbers(list(dict.fromkeys(called.values())))
    bad = list(table.bad.values())
    good, _ = usable(table.file, table.rows, bad, skip_bad=given.skip_bad)
    kept = {name: values[there][good] for name, there in called.items()}
    for name in (POINT, PLACE):
        if name in kept and np.any(kept[name] % 1.0):
            raise keys["file"].error(f"{path}: {called[name]} must hold whole numbers")
    return np.column_stack([kept[name] for name in of_joints]), {n: kept[n] for n in needed}
