"""Tables as they lie on disk: named columns of cells that may still be anything."""

import csv
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from handeye.arrays import Array, Integers
from handeye.errors import LogError, MissingExtra
from handeye.io.columns import near_name
from handeye.io.records import BadRow

_PARQUET_MAGIC = b"PAR1"
_LONGEST_CELL_SHOWN = 30


@dataclass
class Table:
    """Columns of N cells each, with the row of the file that every cell came from.

    `bad` collects the first problem of each bad row.
    """

    file: str
    columns: Mapping[str, Sequence[object]]
    rows: Integers
    bad: dict[int, BadRow] = field(default_factory=dict[int, BadRow])

    def require(self, names: Sequence[str]) -> None:
        """Refuse a table that lacks some of these columns.

        Raises:
            LogError: with what is missing, columns of similar names, and what there is.
        """
        missing = [name for name in names if name not in self.columns]
        if missing:
            hints = [hint for name in missing if (hint := near_name(name, self.columns))]
            lines = [f"{self.file}: missing columns: {', '.join(missing)}", *hints]
            raise LogError("\n  ".join([*lines, f"found: {', '.join(self.columns)}"]))

    def reject(self, row: int, problem: str, remedy: str) -> None:
        """Note what is wrong with a row, unless something already is."""
        self.bad.setdefault(row, BadRow(self.file, row, problem, remedy))

    def numbers(self, names: Sequence[str], *, decimal: str = ".") -> dict[str, Array]:
        """The named columns as numbers (N,), NaN where a cell is none; such rows are rejected."""
        return {name: self._column(name, decimal) for name in names}

    def _column(self, name: str, decimal: str) -> Array:
        values = np.array([_number(cell, decimal) for cell in self.columns[name]], dtype=np.float64)
        values[np.isinf(values)] = np.nan
        for index in np.flatnonzero(np.isnan(values)).tolist():
            cell = self.columns[name][index]
            if cell is None or not str(cell).strip():
                problem = f"{name} is empty"
            else:
                problem = f"{name} is {str(cell)[:_LONGEST_CELL_SHOWN]!r}, not a finite number"
            self.reject(int(self.rows[index]), problem, "fill in the number or delete the row")
        return values


def read_table(path: Path, *, delimiter: str = ",") -> Table:
    """A CSV file (UTF-8, with or without a byte order mark) or a Parquet file.

    Rows are numbered as a text editor does, the header being row 1; a Parquet file as if it were
    a CSV file. Blank lines are passed over; rows of another length than the header are rejected.

    Raises:
        LogError: when the file cannot be opened or is no table.
        MissingExtra: for a Parquet file without pyarrow.
    """
    try:
        with path.open("rb") as stream:
            head = stream.read(len(_PARQUET_MAGIC))
    except OSError as error:
        raise LogError(f"{path}: cannot be read ({error.strerror}): check the path") from error
    if not head:
        raise LogError(f"{path}: the file is empty: give a table with a header and one row each")
    if head == _PARQUET_MAGIC or path.suffix == ".parquet":
        return _read_parquet(path)
    return _read_csv(path, delimiter)


def read_header(path: Path, *, delimiter: str = ",") -> tuple[str, ...]:
    """The column names of a CSV file; empty for a file that is none."""
    try:
        with path.open(encoding="utf-8-sig", newline="") as stream:
            return tuple(name.strip() for name in next(csv.reader(stream, delimiter=delimiter)))
    except OSError as error:
        raise LogError(f"{path}: cannot be read ({error.strerror}): check the path") from error
    except (UnicodeDecodeError, csv.Error, StopIteration):
        return ()


def _read_csv(path: Path, delimiter: str) -> Table:
    table = Table(str(path), {}, np.zeros(0, dtype=np.int64))
    cells: list[list[str]] = []
    rows: list[int] = []
    try:
        with path.open(encoding="utf-8-sig", newline="") as stream:
            reader = csv.reader(stream, delimiter=delimiter)
            header = [name.strip() for name in next(reader)]
            if not "".join(header).replace("\t", "").isprintable() or not any(header):
                raise _no_table(path)
            for line in reader:
                if len(line) == len(header):
                    cells.append(line)
                    rows.append(reader.line_num)
                elif line:
                    table.reject(
                        reader.line_num,
                        f"has {len(line)} cells where the header has {len(header)}",
                        "complete or delete the row",
                    )
    except (UnicodeDecodeError, csv.Error, StopIteration) as error:
        raise _no_table(path) from error
    twice = [name for name, times in Counter(header).items() if times > 1 and name]
    if twice:
        raise LogError(f"{path}: more than one column is called {twice[0]}: rename or delete one")
    if not cells and not table.bad:
        raise LogError(f"{path}: has a header but no rows")
    columns = zip(*cells, strict=True) if cells else [()] * len(header)
    table.columns = dict(zip(header, columns, strict=True))
    table.rows = np.array(rows, dtype=np.int64)
    return table


def _read_parquet(path: Path) -> Table:
    arrow, parquet = pyarrow()
    try:
        content = parquet.read_table(path)
    except (arrow.ArrowException, OSError) as error:
        raise LogError(f"{path}: is not a readable Parquet file: {error}") from error
    if not content.num_rows:
        raise LogError(f"{path}: has columns but no rows")
    columns = {str(name): content[name].to_pylist() for name in content.column_names}
    return Table(str(path), columns, np.arange(2, int(content.num_rows) + 2))


def pyarrow() -> tuple[Any, Any]:
    """The modules pyarrow and pyarrow.parquet.

    Raises:
        MissingExtra: when they are not installed.
    """
    try:
        return import_module("pyarrow"), import_module("pyarrow.parquet")
    except ImportError as error:
        raise MissingExtra("a Parquet file", "parquet") from error


def _no_table(path: Path) -> LogError:
    return LogError(
        f"{path}: is not a table of text: save it as CSV (comma-separated, UTF-8) or Parquet"
    )


def _number(cell: Any, decimal: str) -> float:
    try:
        if decimal != "." and isinstance(cell, str):
            cell = cell.replace(decimal, ".")
        return float(cell)
    except (TypeError, ValueError):
        return float("nan")
