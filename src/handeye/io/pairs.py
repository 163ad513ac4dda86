"""Tables of pairs of poses: where the flange was, and where the camera saw the target.

    flange_x_m, flange_y_m, flange_z_m, flange_qw, flange_qx, flange_qy, flange_qz
    target_x_m, target_y_m, target_z_m, target_qw, target_qx, target_qy, target_qz

The flange in the base's frame, as the controller reports it, the target in the camera's; metres,
and quaternions of length 1. Other columns are ignored.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from handeye.arrays import Array, Integers
from handeye.io import columns as col
from handeye.io.records import BadRow, usable
from handeye.io.tables import read_table

FLANGE, TARGET = "flange_", "target_"
_LARGEST_NORM_ERROR = 1e-2


@dataclass(frozen=True, eq=False)
class PosePairs:
    """N pairs.

    flanges   T_base_flange (N, 4, 4)
    sensed    T_camera_target (N, 4, 4)
    rows      (N,) of the file; the header is row 1
    rejected  rows that were left out
    """

    flanges: Array
    sensed: Array
    rows: Integers
    rejected: tuple[BadRow, ...] = ()


def read_pairs(path: Path | str, *, skip_bad: bool = False) -> PosePairs:
    """Read and check a table of pairs, CSV or Parquet.

    Raises:
        LogError: missing columns, or rows that cannot be used, with their remedy.
        MissingExtra: for a Parquet file without pyarrow.
    """
    table = read_table(Path(path))
    groups = [_columns(prefix) for prefix in (FLANGE, TARGET)]
    names = [name for group in groups for name in group]
    table.require(names)
    values = table.numbers(names)
    for group in groups:
        norm = np.linalg.norm([values[name] for name in group[3:]], axis=0)
        for i in np.flatnonzero(np.abs(norm - 1.0) > _LARGEST_NORM_ERROR).tolist():
            table.reject(
                int(table.rows[i]),
                f"the quaternion {', '.join(group[3:])} has length {norm[i]:g}, not 1",
                "check its columns, or delete the row",
            )
    bad = list(table.bad.values())
    good, rejected = usable(table.file, table.rows, bad, skip_bad=skip_bad)
    kept = {name: column[good] for name, column in values.items()}
    flanges, sensed = (_poses(kept, group) for group in groups)
    return PosePairs(flanges, sensed, table.rows[good], rejected)


def _columns(prefix: str) -> tuple[str, ...]:
    return tuple(prefix + name for name in (*col.POSITION, *col.ORIENTATION))


def _poses(values: Mapping[str, Array], names: Sequence[str]) -> Array:
    xyz, wxyz = (np.column_stack([values[n] for n in part]) for part in (names[:3], names[3:]))
    T = np.tile(np.eye(4), (len(xyz), 1, 1))
    T[:, :3, :3] = Rotation.from_quat(wxyz, scalar_first=True).as_matrix()
    T[:, :3, 3] = xyz
    return T
