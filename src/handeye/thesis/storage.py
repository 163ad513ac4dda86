"""Records in a folder: a table (Parquet, or CSV without the extra "parquet") and a manifest.

The manifest names its table and is written last, so that a reader finds the old records or the new
ones, whatever happens meanwhile.
"""

import csv
import hashlib
import json
import math
from collections.abc import Iterable, Sequence
from importlib import import_module
from io import BytesIO, StringIO
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple, cast

import numpy as np

from handeye.errors import FileFormatError, MissingExtra
from handeye.io.files import replace_file
from handeye.thesis.manifest import Manifest
from handeye.thesis.records import Record, Records

FORMAT = "handeye.records"
VERSION = 1
MANIFEST = "manifest.json"

_COLUMNS = Record._fields


class Stored(NamedTuple):
    """Records as they were read, and how they came about."""

    records: Records
    manifest: Manifest


def write_records(folder: str | PathLike[str], records: Records, manifest: Manifest) -> Path:
    """Store records with their manifest; what the folder held of them before is replaced.

    Returns the path of the table. Raises OSError as the operating system gives it.
    """
    place, sha256 = Path(folder), digest(records)
    suffix, content = _encode(records.rows)
    table = place / f"records-{sha256[:12]}{suffix}"
    replace_file(table, content)
    head = {"format": FORMAT, "version": VERSION, "table": table.name}
    text = json.dumps({**head, "sha256": sha256, **manifest.to_json()}, indent=1)
    replace_file(place / MANIFEST, (text + "\n").encode())
    for old in (*place.glob("records-*.parquet"), *place.glob("records-*.csv")):
        if old != table:
            old.unlink()
    return table


def read_records(folder: str | PathLike[str]) -> Stored:
    """Read what `write_records` wrote.

    Raises:
        FileFormatError: no records there, something else, damaged, or from a newer handeye.
        MissingExtra: a Parquet table without pyarrow.
    """
    path = Path(folder) / MANIFEST
    if not path.is_file():
        raise FileFormatError(
            f"{folder}: holds no records (there is no {MANIFEST}): give a folder that "
            "`handeye reproduce --out` wrote"
        )
    try:
        head = cast("dict[str, Any]", json.loads(path.read_text(encoding="utf-8")))
        if head["format"] != FORMAT:
            raise FileFormatError(f"{path}: is not the manifest of stored records")
        if int(head["version"]) > VERSION:
            raise FileFormatError(
                f"{path}: written in format {head['version']} by a newer handeye (this one reads "
                f"up to {VERSION}): update handeye"
            )
        manifest = Manifest.from_json(head)
        table, expected = path.parent / Path(head["table"]).name, str(head["sha256"])
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise FileFormatError(
            f"{path}: damaged, or not the manifest of stored records ({error!r})"
        ) from error
    records = Records(_decode(table))
    if digest(records) != expected:
        raise FileFormatError(f"{table}: damaged, what is in it is not what was written")
    return Stored(records, manifest)


def digest(records: Records) -> str:
    """A hash that changes with every bit of the records, whatever file they are in."""
    found = hashlib.sha256()
    experiments, settings, replicates, quantities, at, values = _columns(records.rows)
    for words in (experiments, settings, quantities):
        found.update("\n".join(words).encode() + b"\0")
    found.update(np.array(replicates, np.int64).tobytes())
    found.update(np.array([a is not None for a in at], np.bool_).tobytes())
    for numbers in ([0.0 if a is None else a for a in at], values):
        array = np.array(numbers, np.float64)
        # A CSV file does not keep which of the many NaN it was.
        array[np.isnan(array)] = math.nan
        found.update(array.tobytes())
    return found.hexdigest()


def _columns(rows: Sequence[Record]) -> list[Sequence[Any]]:
    return list(zip(*rows, strict=True)) if rows else [()] * len(_COLUMNS)


def _encode(rows: Sequence[Record]) -> tuple[str, bytes]:
    try:
        arrow, parquet = (import_module(name) for name in ("pyarrow", "pyarrow.parquet"))
    except ImportError:
        text = StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(_COLUMNS)
        writer.writerows(
            (*row[:4], "" if row.at is None else repr(row.at), row.value) for row in rows
        )
        return ".csv", text.getvalue().encode()
    types = (arrow.string(), arrow.string(), arrow.int64(), arrow.string())
    kinds = dict(zip(_COLUMNS, (*types, arrow.float64(), arrow.float64()), strict=True))
    columns = zip(kinds.items(), _columns(rows), strict=True)
    content = arrow.table({name: arrow.array(one, kind) for (name, kind), one in columns})
    file = BytesIO()
    parquet.write_table(content, file, compression="zstd")
    return ".parquet", file.getvalue()


def _decode(table: Path) -> Iterable[Record]:
    damaged = FileFormatError(
        f"{table}: is not there, or not the table that its manifest names: "
        "run `handeye reproduce` again"
    )
    if not table.is_file():
        raise damaged
    if table.suffix == ".csv":
        try:
            with table.open(encoding="utf-8", newline="") as stream:
                header, *lines = csv.reader(stream)
            if tuple(header) != _COLUMNS:
                raise damaged
            return [
                Record(experiment, setting, int(i), name, float(at) if at else None, float(value))
                for experiment, setting, i, name, at, value in lines
            ]
        except (ValueError, csv.Error) as error:
            raise damaged from error
    try:
        arrow, parquet = (import_module(name) for name in ("pyarrow", "pyarrow.parquet"))
    except ImportError as error:
        raise MissingExtra("A table of records in Parquet", "parquet") from error
    try:
        content = parquet.read_table(table)
        columns = [content[name].to_pylist() for name in _COLUMNS]
    except (arrow.ArrowException, KeyError, OSError) as error:
        raise damaged from error
    return map(Record, *columns)
