"""Logs of real or simulated robots as tables, CSV or Parquet; recordings of ROS are read as such.

One row per observation. The header (order does not matter, other columns are ignored):

    time_s                             increasing from row to row, or rows in any order at all
    <joint name>_rad                   one column per joint (of a sliding joint: its travel in m)

and for a marker on the hand located by a tracker or camera, in the sensor's frame

    x_m, y_m, z_m                      its position
    qw, qx, qy, qz                     optional: its orientation, a unit quaternion
    std_x_m, std_y_m, std_z_m          optional: standard deviation of the position

or, for the planar robot (joints alpha and beta) seen by a stereo head,

    pointing_rad, range_m, eccentricity_rad
"""

import csv
from collections.abc import Sequence
from io import BytesIO, StringIO
from pathlib import Path

import numpy as np

from handeye.arrays import Array
from handeye.errors import LogError
from handeye.io import columns as col
from handeye.io.bags import is_bag, read_bag
from handeye.io.files import replace_file
from handeye.io.records import BadRow, Log, LogReading
from handeye.io.tables import pyarrow, read_table
from handeye.io.validation import checked_log
from handeye.observations import PointObservation

__all__ = ["BadRow", "Log", "LogReading", "read_log", "write_log"]


def read_log(path: Path | str, *, skip_bad: bool = False) -> LogReading:
    """Read and check a log, whose rows come in the order of time.

    Rows that do not stand in this order are sorted; where it is but a few that do not, their clock
    is thought to be wrong. Rejected are rows with empty or non-numeric cells, too few or too many
    cells, time stamps that repeat or go back, quaternions whose length is off 1 by more than 0.01,
    and ranges or standard deviations that are not positive. With `skip_bad` the other rows are
    used. A recording (.bag, .mcap, .db3 or the folder of a ROS 2 bag) is read with the defaults of
    `bags.read_bag`.

    Raises:
        LogError: for a file that is no log, missing columns, a column in the wrong unit (angles
            beyond 4 pi, positions beyond 50 m), rejected rows without `skip_bad`, or no row left.
        MissingExtra: for a Parquet file without pyarrow, or a recording without rosbags.
    """
    if is_bag(path):
        return read_bag(path, skip_bad=skip_bad)
    table = read_table(Path(path))
    found = list(table.columns)
    joints, others = col.required(table.file, found)
    needed = (*joints, *others)
    ignored = [name for name in found if name not in needed]
    reading = checked_log(table, table.numbers(needed), joints, ignored, skip_bad=skip_bad)
    return LogReading(reading.log.in_time_order(), reading.rejected)


def write_log(path: Path | str, log: Log) -> None:
    """Write a log so that `read_log` gives back the same numbers; whole or not at all.

    The suffix decides: `.parquet`, anything else is CSV.

    Raises:
        LogError: when the file cannot be written.
        MissingExtra: for a Parquet file without pyarrow.
    """
    target, columns = Path(path), _columns(log)
    if target.suffix == ".parquet":
        arrow, parquet = pyarrow()
        stream = BytesIO()
        parquet.write_table(arrow.table(columns), stream)
        content = stream.getvalue()
    else:
        text = StringIO(newline="")
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(np.column_stack(list(columns.values())).tolist())
        content = text.getvalue().encode()
    try:
        replace_file(target, content)
    except OSError as error:
        raise LogError(f"{target}: cannot be written ({error.strerror})") from error


def _columns(log: Log) -> dict[str, Array]:
    seen = log.observations
    columns = {col.TIME: seen.time}
    columns |= _split([name + col.JOINT_SUFFIX for name in log.joint_names], seen.joints)
    if isinstance(seen, PointObservation):
        columns |= _split(col.POSITION, seen.position)
        columns |= {} if seen.orientation is None else _split(col.ORIENTATION, seen.orientation)
        columns |= {} if seen.position_std is None else _split(col.POSITION_STD, seen.position_std)
        return columns
    return columns | dict(
        zip(col.SIGHTING, (seen.pointing, seen.range, seen.eccentricity), strict=True)
    )


def _split(names: Sequence[str], values: Array) -> dict[str, Array]:
    return {name: np.ascontiguousarray(values[:, i]) for i, name in enumerate(names)}
