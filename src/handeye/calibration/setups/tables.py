"""One measurement of a description: its keys, and its table."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from handeye.arrays import Array, Integers
from handeye.calibration.arm.measurements import Frame, Numbers, Points
from handeye.calibration.hand_eye.samples import Setup
from handeye.calibration.setups.units import check_units
from handeye.errors import InvalidInput
from handeye.io import columns as col
from handeye.io.bags import BagReport
from handeye.io.records import usable
from handeye.io.tables import Table, read_table
from handeye.io.yaml_entries import Entry
from handeye.robots.urdf import UrdfArm

POINT, PLACE = "point", "place"
"""Columns of whole numbers: the point of a board, the place that is touched."""

PIXELS = ("u_px", "v_px")
HEIGHT = "height_m"

_SETUPS: tuple[Setup, ...] = ("eye_to_hand", "eye_in_hand")


@dataclass(frozen=True, eq=False)
class Given:
    """What a description says apart from its measurements; `arm` is what one of these is of."""

    arm: UrdfArm
    folder: Path
    skip_bad: bool
    frames: Mapping[str, Frame]
    points: Mapping[str, Points]
    cameras: Mapping[str, Numbers]
    sizes: Mapping[str, tuple[int, int]]


@dataclass(frozen=True, eq=False)
class Source:
    """Where the rows of a measurement come from.

    file      the table, or the recording
    rows      (N,) number of each row in the file, the header being row 1
    rejected  rows that were left out, and why
    report    of a recording, what became of it
    """

    file: str
    rows: Integers
    rejected: tuple[str, ...]
    report: BagReport | None = None


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

    def std_of(self, names: Sequence[str]) -> Array:
        """What each row states (N, k) in these columns, where they are and `std` is not."""
        if "std" in self.keys or not set(names) <= set(self.columns):
            return self.std
        return self.many(*names)

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
    keys: Mapping[str, Entry],
    given: Given,
    needed: Sequence[str],
    optional: Sequence[str] = (),
    picture: tuple[int, int] | None = None,
) -> tuple[Array, dict[str, Array], Source]:
    """Joints (N, n) and the needed columns (N,) of a measurement's table, in the order of time.

    Where there is no column of times, rows stay as they are. optional: columns that are read where
    they are. picture: width and height in which pixels must lie.

    Raises:
        InvalidInput: no such file or columns, or other units, with the line of the description.
        LogError: rows that cannot be used.
    """
    path = given.folder / keys["file"].text()
    if not path.is_file():
        raise keys["file"].error(f"{path} is not there: give a path beside the description")
    table = read_table(path)
    of_joints = [f"{name}{col.JOINT_SUFFIX}" for name in given.arm.joint_names]
    wanted = [*of_joints, *needed]
    extra = [*optional, col.TIME]
    called = {name: name for name in wanted + extra}
    if "columns" in keys:
        named = keys["columns"].table(wanted + extra)
        called |= {name: one.text() for name, one in named.items()}
        wanted += [name for name in extra if name in named]
    _demand(keys["file"], path, table, [called[name] for name in wanted])
    called = {name: there for name, there in called.items() if there in table.columns}
    values = table.numbers(list(dict.fromkeys(called.values())))
    columns = {name: values[there] for name, there in called.items()}
    if picture is not None:
        _outside(table, columns, called, picture)
    good, rejected = usable(
        table.file, table.rows, list(table.bad.values()), skip_bad=given.skip_bad
    )
    kept = {name: column[good] for name, column in columns.items()}
    with keys["file"].blamed():
        check_units(path, given.arm, np.column_stack([kept[name] for name in of_joints]), kept)
        for name in (POINT, PLACE):
            if name in kept and np.any(kept[name] % 1.0):
                raise InvalidInput(f"{path}: {called[name]} must hold whole numbers")
    order = np.arange(int(good.sum()))
    if col.TIME in kept:
        # Of equal times, by what was measured: the same rows in any order become the same.
        order = np.lexsort([*(kept[name] for name in (*needed, *of_joints)), kept[col.TIME]])
    kept = {name: column[order] for name, column in kept.items()}
    source = Source(str(path), table.rows[good][order], tuple(map(str, rejected)))
    joints = np.column_stack([kept.pop(name) for name in of_joints])
    kept.pop(col.TIME, None)
    return joints, kept, source


def _demand(entry: Entry, path: Path, table: Table, wanted: Sequence[str]) -> None:
    missing = [name for name in wanted if name not in table.columns]
    if missing:
        hints = [hint for name in missing if (hint := col.near_name(name, table.columns))]
        lines = [
            f"{path} lacks the columns {', '.join(missing)}: add them, or map them: `columns:`",
            f"found: {', '.join(table.columns)}",
            *hints,
        ]
        raise entry.error("\n  ".join(lines))


def _outside(
    table: Table, columns: Mapping[str, Array], called: Mapping[str, str], picture: tuple[int, int]
) -> None:
    """Reject rows whose pixels are not in the picture; the middle of the first one is (0, 0)."""
    for name, size in zip(PIXELS, picture, strict=True):
        for i in np.flatnonzero(np.abs(columns[name] - 0.5 * (size - 1)) > 0.5 * size).tolist():
            table.reject(
                int(table.rows[i]),
                f"{called[name]} is {columns[name][i]:g}, outside the picture of "
                f"{picture[0]} x {picture[1]} pixels",
                "correct or delete the row, or the camera's `size`",
            )
