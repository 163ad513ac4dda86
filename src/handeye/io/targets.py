"""Tables of places to reach, and of the joint commands that reach them.

Targets in space: `x_m, y_m, z_m` in the sensor's frame, and `<joint name>_rad` for every joint, a
posture to stay near. Targets of the planar robot: `pointing_rad, range_m, eccentricity_rad` as the
eye sees them, and `elbow`, 1 or -1, the sign of beta. Other columns are ignored.
"""

import csv
from collections.abc import Sequence
from io import StringIO
from pathlib import Path

import numpy as np

from handeye.arrays import Array
from handeye.errors import LogError
from handeye.io import columns as col
from handeye.io.files import replace_file
from handeye.io.tables import read_table
from handeye.observations import PointTarget, StereoTarget

ELBOW = "elbow"


def read_point_targets(path: Path, joint_names: Sequence[str]) -> PointTarget:
    """Targets in space for an arm with these joints.

    Raises:
        LogError: missing columns, or a row that cannot be used, with its remedy.
    """
    joints = _joint_columns(joint_names)
    values = _numbers(path, [*col.POSITION, *joints])
    return PointTarget(_together(values, col.POSITION), _together(values, joints))


def read_stereo_targets(path: Path) -> StereoTarget:
    """Targets of the planar robot.

    Raises:
        LogError: missing columns, or a row that cannot be used, with its remedy.
    """
    values = _numbers(path, [*col.SIGHTING, ELBOW])
    wrong = np.flatnonzero((values[ELBOW] != 1.0) & (values[ELBOW] != -1.0))
    if wrong.size:
        raise LogError(
            f"{path}: {ELBOW} is {values[ELBOW][wrong[0]]:g} for target {wrong[0] + 1}; "
            "give 1 where beta is to be positive, -1 where negative"
        )
    return StereoTarget(*(values[name] for name in (*col.SIGHTING, ELBOW)))


def commands_as_csv(joint_names: Sequence[str], commands: Array) -> str:
    """Joint commands (N, n) [rad] as a CSV table with one column per joint."""
    text = StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(_joint_columns(joint_names))
    writer.writerows(commands.tolist())
    return text.getvalue()


def write_commands(path: Path, joint_names: Sequence[str], commands: Array) -> None:
    """The same as a file, whole or not at all; LogError when it cannot be written."""
    try:
        replace_file(path, commands_as_csv(joint_names, commands).encode())
    except OSError as error:
        raise LogError(f"{path}: cannot be written ({error.strerror})") from error


def _joint_columns(joint_names: Sequence[str]) -> list[str]:
    return [name + col.JOINT_SUFFIX for name in joint_names]


def _together(values: dict[str, Array], names: Sequence[str]) -> Array:
    return np.column_stack([values[name] for name in names])


def _numbers(path: Path, names: Sequence[str]) -> dict[str, Array]:
    table = read_table(path)
    table.require(names)
    values = table.numbers(names)
    if table.bad:
        first = next(iter(table.bad.values()))
        more = f" ({len(table.bad)} such rows)" if len(table.bad) > 1 else ""
        raise LogError(f"{first}{more}")
    return values
