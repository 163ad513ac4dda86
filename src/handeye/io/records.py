"""What a log is once it is read, and what is wrong with the rows that were left out."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, Literal

import numpy as np

from handeye.arrays import Booleans, Integers
from handeye.errors import LogError
from handeye.observations import PointObservation, StereoObservation

# As many as a person reads before correcting the first.
_SHOWN = 5


@dataclass(frozen=True)
class BadRow:
    """A row that cannot be used: where it is (the header is row 1), why, and what to do."""

    file: str
    row: int
    problem: str
    remedy: str

    def __str__(self) -> str:
        return f"{self.file}, row {self.row}: {self.problem}; {self.remedy}"


@dataclass(frozen=True)
class Log:
    """Observations of one robot in the order of time.

    name         where it comes from, for messages
    joint_names  in the order of the columns of `observations.joints`
    rows         number of each observation's row in the file (the header is row 1), (N,)
    ignored      names of columns in the file that no observation needs
    """

    name: str
    joint_names: tuple[str, ...]
    observations: PointObservation | StereoObservation
    rows: Integers
    ignored: tuple[str, ...] = ()

    @property
    def kind(self) -> Literal["point", "stereo"]:
        """Whether a tracker located a marker in space, or a stereo head saw a planar hand."""
        return "point" if isinstance(self.observations, PointObservation) else "stereo"

    def __len__(self) -> int:
        return len(self.rows)

    def in_time_order(self) -> "Log":
        """The log with its rows sorted by time; of equal times, by what was observed.

        Logs of the same observations in any order become the same, but for the numbers of rows.
        """
        seen: Any = self.observations
        values = [getattr(seen, field.name) for field in fields(seen)]
        columns = [v.reshape(len(v), -1) for v in values if v is not None]
        order = np.lexsort(np.hstack(columns).T[::-1])
        return replace(self, observations=seen[order], rows=self.rows[order])

    def only(self, good: Booleans) -> "Log":
        """The log with the rows where `good` (N,) is true."""
        kept = self.observations[good]
        return Log(self.name, self.joint_names, kept, self.rows[good], self.ignored)


@dataclass(frozen=True)
class LogReading:
    """The usable rows of a log, and the rejected ones in the order of the file."""

    log: Log
    rejected: tuple[BadRow, ...] = ()


def usable(
    name: str, rows: Integers, rejected: Sequence[BadRow], *, skip_bad: bool
) -> tuple[Booleans, tuple[BadRow, ...]]:
    """Which of `rows` (N,) of log `name` may be used, and what was rejected in the file's order.

    Raises:
        LogError: for rejected rows without `skip_bad`, or when no good row is left.
    """
    found = tuple(sorted(rejected, key=lambda bad: bad.row))
    at = [bad.row for bad in found]
    if found and not skip_bad:
        total = len(np.union1d(rows, at))
        raise LogError(
            f"{name}: {len(found)} of {total} rows cannot be used:\n{_listed(found)}\n"
            "Correct them, or leave them out with --skip-bad (in Python: skip_bad=True)."
        )
    good = ~np.isin(rows, at)
    if not good.any():
        raise LogError(f"{name}: no usable row is left:\n{_listed(found)}")
    return good, found


def _listed(rejected: Sequence[BadRow]) -> str:
    lines = [f"  row {bad.row}: {bad.problem}; {bad.remedy}" for bad in rejected[:_SHOWN]]
    if len(rejected) > _SHOWN:
        lines.append(f"  and {len(rejected) - _SHOWN} more")
    return "\n".join(lines)
