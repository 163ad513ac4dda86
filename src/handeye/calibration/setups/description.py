"""A YAML file that says what was measured of an arm, by what, and what is known beforehand.

    robot: ur10                         # a URDF file or a robot known by name
    tip: tool0                          # optional: link of the flange; eye: link of the base,
                                        # of measurements that name no others (link:, base:)
    measurements:                       # one or more; see `setups.kinds.KINDS`
      - kind: points
        file: tracker.csv               # columns <joint>_rad, x_m, y_m, z_m
        sensor: tracker
        target: reflector
        std: 2e-5
    frames:                             # optional: where instruments and targets are
      tracker: {pose: [x, y, z, qw, qx, qy, qz], shift: 0.01, turn: 0.01}
    points:                             # optional: points of a flange or a board
      reflector: {at: [0, 0, 0.1], within: 0.001}
      corners: {grid: [9, 6, 0.03]}
    cameras:                            # needed for pixels
      eye: {matrix: [fx, fy, cx, cy], distortion: [k1, k2, p1, p2, k3], within: 1,
            size: [1920, 1200]}
      wrist: {camera_info: wrist.yaml}  # the same numbers as ROS keeps them
    arm: {shift: 0.001, compliance: 0}  # optional: fields of `sheet.ArmSheet`
    curves: {own: 64, others: 6}        # optional: fields of `sheet.CurveTerms`

Lengths are in metres, angles in radians. What is not stated is found from nothing.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

import numpy as np

from handeye.arrays import Array
from handeye.calibration.arm.estimator import FINE
from handeye.calibration.arm.measurements import Frame, Instrument, Points, agreeing, seats
from handeye.calibration.arm.measurements.unknowns import Unknown
from handeye.calibration.arm.sheet import ArmSheet, CurveTerms
from handeye.calibration.setups.cameras import read_cameras
from handeye.calibration.setups.kinds import KINDS, made
from handeye.calibration.setups.tables import Given, Source
from handeye.errors import InvalidInput
from handeye.geometry import make_pose, matrix_from_wxyz
from handeye.io.yaml_entries import Entry, read_yaml
from handeye.robots.urdf import UrdfArm, load_arm

_PARTS = ("robot", "tip", "eye", "measurements", "frames", "points", "cameras", "arm", "curves")


@dataclass(frozen=True, eq=False)
class Description:
    """What a file describes.

    arm           nominal kinematics
    measurements  with what is stated where it is stated, and all else placed by its start
    placed        the same, with what is stated moved to where it fits an arm without errors best
    sheet         how far the arm may be from nominal, and how fine its error curves may be
    sources       of each measurement, the rows of its table
    stated        frames, points and cameras as the file has them, by name
    sizes         width and height of cameras' pictures [px], where they are stated
    """

    arm: UrdfArm
    measurements: tuple[Instrument, ...]
    placed: tuple[Instrument, ...]
    sheet: ArmSheet
    sources: tuple[Source, ...]
    stated: Mapping[str, Unknown]
    sizes: Mapping[str, tuple[int, int]]


def load_description(
    path: Path | str, arm: UrdfArm | None = None, *, skip_bad: bool = False
) -> Description:
    """Read a description and the tables that it names, and place everything.

    arm: instead of the file's `robot`. skip_bad: leave out rows of tables that cannot be used.
    Files are looked for beside the description.

    Raises:
        InvalidInput: with file, line and key, for anything that is unknown, missing or impossible.
        FileFormatError: the file is not YAML, or the URDF none.
        LogError: a table with rows that cannot be used.
        MissingExtra: without PyYAML, pinocchio or, for Parquet, pyarrow.
    """
    file = Path(path)
    parts = read_yaml(file).table(_PARTS, ("measurements",))
    entries = parts["measurements"].items()
    if not entries:
        raise parts["measurements"].error(f"is empty: list one or more of {', '.join(KINDS)}")
    arm = arm or _robot(file, parts, entries)
    frames = {name: _frame(name, entry) for name, entry in _named(parts, "frames")}
    points = {name: _points(name, entry) for name, entry in _named(parts, "points")}
    cameras, sizes = read_cameras(_named(parts, "cameras"), file.parent)
    given = Given(arm, file.parent, skip_bad, frames, points, cameras, sizes)
    both = [made(entry, given) for entry in entries]
    placed, sources = [one for one, _ in both], tuple(source for _, source in both)
    with parts["measurements"].blamed():
        seats(arm, placed)
        flanges = [arm.between(one.link, one.base).poses(one.joints) for one in placed]
        together = agreeing(placed, flanges)
    stated: dict[str, Unknown] = {**frames, **points, **cameras}
    _all_used(parts, together, stated)
    begun = tuple(
        one.given({u.name: stated[u.name] for u in one.unknowns if u.name in stated})
        for one in together
    )
    return Description(arm, begun, tuple(together), _sheet(parts), sources, stated, sizes)


def _robot(file: Path, parts: dict[str, Entry], entries: Sequence[Entry]) -> UrdfArm:
    if "robot" not in parts:
        raise InvalidInput(f"{file}: says no `robot:`; add one, or give --robot (in Python: arm=)")
    spec = parts["robot"].text()
    tip, eye = (parts[key].text() if key in parts else None for key in ("tip", "eye"))
    # Where every measurement names its own link, the robot need not have a usual one.
    links = [entry.tables().get("link") for entry in entries]
    if tip is None and links[0] is not None and None not in links:
        tip = links[0].text()
    beside = file.parent / spec
    with parts["robot"].blamed():
        return load_arm(str(beside) if beside.is_file() else spec, tip, eye)


def _named(parts: dict[str, Entry], key: str) -> list[tuple[str, Entry]]:
    return list(parts[key].tables().items()) if key in parts else []


def _frame(name: str, entry: Entry) -> Frame:
    keys = entry.table(("pose", "shift", "turn"), ("pose",))
    pose = keys["pose"].numbers()
    if pose.shape != (7,):
        raise keys["pose"].error("must be [x, y, z, qw, qx, qy, qz] in metres, w first")
    shift, turn = (keys[k].number(least=0.0) if k in keys else 0.0 for k in ("shift", "turn"))
    with keys["pose"].blamed():
        return Frame.near(name, make_pose(matrix_from_wxyz(pose[3:]), pose[:3]), shift, turn)


def _points(name: str, entry: Entry) -> Points:
    keys = entry.table(("at", "grid", "within"))
    if ("at" in keys) == ("grid" in keys):
        raise entry.error("needs either `at`, one point or a list of them, or `grid`")
    within = keys["within"].number(least=0.0) if "within" in keys else 0.0
    places = np.atleast_2d(keys["at"].numbers()) if "at" in keys else _grid(keys["grid"])
    with entry.blamed():
        return Points.near(name, places, within)


def _grid(entry: Entry) -> Array:
    numbers = entry.numbers()
    if numbers.shape != (3,) or np.any(numbers <= 0.0) or np.any(numbers[:2] % 1.0):
        raise entry.error("must be [columns, rows, spacing in metres], like [9, 6, 0.03]")
    columns, rows, spacing = int(numbers[0]), int(numbers[1]), float(numbers[2])
    places = [(spacing * i, spacing * k, 0.0) for k in range(rows) for i in range(columns)]
    return np.array(places)


def _sheet(parts: dict[str, Entry]) -> ArmSheet:
    numbers = [field.name for field in fields(ArmSheet) if field.name != "curves"]
    plain: dict[str, Any] = {}
    if "arm" in parts:
        plain = {name: one.number() for name, one in parts["arm"].table(numbers).items()}
    curves = FINE
    if "curves" in parts:
        own = parts["curves"].table([field.name for field in fields(CurveTerms)])
        with parts["curves"].blamed():
            curves = replace(FINE, **{name: one.whole() for name, one in own.items()})
    with parts.get("arm", parts["measurements"]).blamed():
        return ArmSheet(**plain, curves=curves)


def _all_used(
    parts: dict[str, Entry], instruments: Sequence[Instrument], stated: Mapping[str, Unknown]
) -> None:
    """What is stated of something that no measurement has is a slip of the pen."""
    unknowns = [unknown for one in instruments for unknown in one.unknowns]
    used = {u.name for u in unknowns if u.free.any() or u.name in stated}
    for key in ("frames", "points", "cameras"):
        for name, entry in _named(parts, key):
            if name not in used:
                raise entry.error(f"no measurement uses {name}; they use {', '.join(sorted(used))}")
