"""Files of other people's experiments, turned into our log."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from handeye.errors import LogError
from handeye.io import columns as col
from handeye.io.records import Log
from handeye.io.tables import read_header, read_table
from handeye.io.validation import checked_log


@dataclass(frozen=True)
class Converter:
    """How one kind of foreign file is recognised and read.

    kind         the name a user can ask for
    description  one line for lists and messages
    delimiter    what separates its columns
    recognises   whether a header (names of columns) belongs to this kind
    read         the log of a file of this kind; raises LogError
    """

    kind: str
    description: str
    delimiter: str
    recognises: Callable[[Sequence[str]], bool]
    read: Callable[[Path], Log]


CONVERTERS: dict[str, Converter] = {}
"""Every known kind of foreign file; `register` adds to it."""


def register(converter: Converter) -> None:
    """Make a kind of foreign file known to `convert`; the same name again replaces it."""
    CONVERTERS[converter.kind] = converter


def convert(path: Path | str, kind: str | None = None) -> Log:
    """Read a foreign file; without `kind`, its header says what it is.

    Raises:
        LogError: for an unknown kind, a file that no converter recognises (the message lists the
            known kinds), or one whose contents cannot be used.
    """
    source = Path(path)
    if kind is not None and kind not in CONVERTERS:
        raise LogError(f"no converter is called {kind!r}; known kinds:\n{_known()}")
    candidates = CONVERTERS.values() if kind is None else [CONVERTERS[kind]]
    for converter in candidates:
        if converter.recognises(read_header(source, delimiter=converter.delimiter)):
            return converter.read(source)
    found = ", ".join(read_header(source)[:10]) or "no readable header"
    expected = "any known kind" if kind is None else f"kind {kind!r}"
    raise LogError(
        f"{source}: its header is not that of {expected} (found: {found[:200]}); known kinds:\n"
        f"{_known()}\nA table with the columns of a log needs no conversion."
    )


def _known() -> str:
    return "\n".join(f"  {c.kind}: {c.description}" for c in CONVERTERS.values())


_UR10_JOINTS = (
    "shoulder_pan_joint",
    "shoulder_lift_joint",
    "elbow_joint",
    "wrist_1_joint",
    "wrist_2_joint",
    "wrist_3_joint",
)
_UR10_POSITION = tuple(f"measurement_{axis}" for axis in "xyz")
_UR10_ANGLES = tuple(f"measurement_r{axis}" for axis in "xyz")
_UR10_STD = tuple(f"measurement_std_{axis}" for axis in "xyz")
_UR10_COLUMNS = (*_UR10_JOINTS, *_UR10_POSITION, *_UR10_ANGLES, *_UR10_STD)


def _read_ur10(path: Path) -> Log:
    """Millimetres and intrinsic XYZ degrees, decimal commas; the row's order is its time."""
    table = read_table(path, delimiter=";")
    given = table.numbers(_UR10_COLUMNS, decimal=",")
    values = {col.TIME: np.arange(len(table.rows), dtype=np.float64)}
    joints = [name + col.JOINT_SUFFIX for name in _UR10_JOINTS]
    values |= {ours: given[name] for ours, name in zip(joints, _UR10_JOINTS, strict=True)}
    for ours, theirs in ((col.POSITION, _UR10_POSITION), (col.POSITION_STD, _UR10_STD)):
        values |= {o: given[t] / 1000.0 for o, t in zip(ours, theirs, strict=True)}
    angles = np.nan_to_num(np.column_stack([given[name] for name in _UR10_ANGLES]))
    turned = Rotation.from_euler("XYZ", angles, degrees=True)
    wxyz = turned.as_quat(canonical=True, scalar_first=True)
    values |= {name: wxyz[:, i] for i, name in enumerate(col.ORIENTATION)}
    return checked_log(table, values, joints, skip_bad=False).log


register(
    Converter(
        kind="ur10-joint-configurations",
        description="UR10 poses measured with a laser tracker (Landgraf et al., IEEE CASE 2021)",
        delimiter=";",
        recognises=lambda header: set(_UR10_COLUMNS) <= set(header),
        read=_read_ur10,
    )
)
