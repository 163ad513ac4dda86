"""What numbers in a log can be right."""

from bisect import bisect_left
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from handeye.arrays import Array, Booleans
from handeye.errors import LogError
from handeye.io import columns as col
from handeye.io.records import Log, LogReading, usable
from handeye.io.tables import Table
from handeye.observations import PointObservation, StereoObservation

# Two turns either way: more than any joint is wound up, less than most joints move in degrees.
LARGEST_ANGLE = 4.0 * np.pi
# No marker is measured to the accuracy of interest beyond this [m].
LARGEST_DISTANCE = 50.0
LARGEST_NORM_ERROR = 1e-2
_ROUNDING = 1e-12
# A unit is wrong in a whole column; more seldom than this it is a glitch of single rows.
_GLITCHES = 0.05
# Time goes back this often only where rows do not stand in the order of time: shuffled, it does at
# every second row. More seldom, or once or twice in a short log, it is the clock.
_SHUFFLED, _TWICE = 0.25, 2


def checked_log(
    table: Table,
    values: Mapping[str, Array],
    joints: Sequence[str],
    ignored: Sequence[str] = (),
    *,
    skip_bad: bool,
) -> LogReading:
    """The log made of `values`, the columns (N,) of `table` under their documented names.

    Raises:
        LogError: for a column in the wrong unit, for bad rows without `skip_bad`, or when no
            good row is left.
    """
    _check_limits(table, values)
    _check_rows(table, values)
    _check_time(table, values[col.TIME])
    bad = list(table.bad.values())
    good, rejected = usable(table.file, table.rows, bad, skip_bad=skip_bad)
    log = Log(
        table.file,
        tuple(name.removesuffix(col.JOINT_SUFFIX) for name in joints),
        _observations({name: column[good] for name, column in values.items()}, joints),
        table.rows[good],
        tuple(ignored),
    )
    return LogReading(log, rejected)


def _observations(
    values: Mapping[str, Array], joints: Sequence[str]
) -> PointObservation | StereoObservation:
    def together(names: Sequence[str]) -> Array:
        return np.column_stack([values[name] for name in names])

    time, angles = values[col.TIME], together(joints)
    if set(col.SIGHTING) <= set(values):
        return StereoObservation(time, angles, *(values[name] for name in col.SIGHTING))
    orientation = std = None
    if set(col.ORIENTATION) <= set(values):
        wxyz = together(col.ORIENTATION)
        norm = np.linalg.norm(wxyz, axis=1, keepdims=True)
        # Rounded ones are made exact; exact ones stay the same to the last bit.
        orientation = wxyz / np.where(np.abs(norm - 1.0) > _ROUNDING, norm, 1.0)
    if set(col.POSITION_STD) <= set(values):
        std = together(col.POSITION_STD)
    return PointObservation(time, angles, together(col.POSITION), orientation, std)


def _check_limits(table: Table, values: Mapping[str, Array]) -> None:
    """Values that no unit but a wrong one explains."""
    wrong: list[str] = []
    for name, column in values.items():
        if name.endswith(col.JOINT_SUFFIX):
            limit, said = LARGEST_ANGLE, "4 pi rad"
            seems, remedy = "degrees", "multiply the column by pi/180"
        elif name in (*col.POSITION, "range_m"):
            limit, said = LARGEST_DISTANCE, f"{LARGEST_DISTANCE:g} m"
            seems, remedy = "millimetres", "divide the column by 1000"
        else:
            continue
        beyond = np.flatnonzero(np.abs(column) > limit)
        if len(beyond) > _GLITCHES * len(column):
            first = f"the first in row {table.rows[beyond[0]]}: {column[beyond[0]]:g}"
            wrong.append(
                f"  {name}: {len(beyond)} of {len(column)} values are beyond {said} ({first}), "
                f"so it seems to be in {seems}; {remedy}"
            )
        for index in beyond.tolist():
            table.reject(
                int(table.rows[index]),
                f"{name} is {column[index]:g}, beyond {said}",
                "correct or delete the row",
            )
    if wrong:
        raise LogError("\n".join([f"{table.file}: columns in the wrong unit:", *wrong]))


def _check_rows(table: Table, values: Mapping[str, Array]) -> None:
    def reject(bad: Booleans, problem: Callable[[int], str], remedy: str) -> None:
        for index in np.flatnonzero(bad).tolist():
            table.reject(int(table.rows[index]), problem(index), remedy)

    for name in ("range_m", *col.POSITION_STD):
        if name in values:
            column = values[name]
            reject(
                column <= 0.0,
                lambda i, name=name, column=column: f"{name} is {column[i]:g}, not positive",
                "correct or delete the row",
            )
    if set(col.ORIENTATION) <= set(values):
        norm = np.linalg.norm([values[name] for name in col.ORIENTATION], axis=0)
        reject(
            np.abs(norm - 1.0) > LARGEST_NORM_ERROR,
            lambda i: f"the quaternion qw, qx, qy, qz has length {norm[i]:g}, not 1",
            "check its columns, or delete the row",
        )


def _check_time(table: Table, time: Array) -> None:
    """Reject the fewest rows whose removal leaves time stamps that increase.

    Rows that do not stand in the order of time at all are judged in that order.
    """
    known = np.isfinite(time) & ~np.isin(table.rows, list(table.bad))
    rows, stamps = table.rows[known], time[known]
    if np.count_nonzero(np.diff(stamps) < 0.0) > max(_SHUFFLED * len(stamps), _TWICE):
        order = np.argsort(stamps, kind="stable")
        rows, stamps = rows[order], stamps[order]
    kept = increasing(stamps)
    if len(stamps) - len(kept) > len(stamps) / 2:
        raise LogError(
            f"{table.file}: {col.TIME} does not increase: {len(stamps) - len(kept)} of "
            f"{len(stamps)} time stamps repeat or go back; give every row a later time than the "
            "row before it (where no clock was recorded: 0, 1, 2, ...)"
        )
    previous = -1
    for index in range(len(stamps)):
        if previous + 1 < len(kept) and index == kept[previous + 1]:
            previous += 1
            continue
        now, row = stamps[index], int(rows[index])
        before = kept[previous] if previous >= 0 else None
        if before is not None and now == stamps[before]:
            problem = f"{col.TIME} {now:g} repeats that of row {rows[before]}"
        elif before is not None and now < stamps[before]:
            problem = f"{col.TIME} {now:g} goes back behind row {rows[before]} ({stamps[before]:g})"
        else:
            problem = f"{col.TIME} {now:g} is ahead of the rows that follow"
        table.reject(row, problem, "correct the time stamp or delete the row")


def increasing(values: Array) -> list[int]:
    """Indices of a longest strictly increasing subsequence of `values` (N,).

    Of equal values the first is kept, and of two that exclude each other the earlier: the clock
    is believed until it goes back. Patience sorting from the end (Fredman 1975), O(N log N).
    """
    if np.all(np.diff(values) > 0.0):
        return list(range(len(values)))
    heads: list[float] = []
    at: list[int] = []
    following = [-1] * len(values)
    for index in range(len(values) - 1, -1, -1):
        key = -float(values[index])
        length = bisect_left(heads, key)
        following[index] = at[length - 1] if length else -1
        heads[length : length + 1] = [key]
        at[length : length + 1] = [index]
    chain = [at[-1]]
    while following[chain[-1]] >= 0:
        chain.append(following[chain[-1]])
    return chain
