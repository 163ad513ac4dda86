"""Whether the numbers of a table can be radians and metres, of the arm that a description names."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from handeye.arrays import Array
from handeye.errors import InvalidInput
from handeye.io import columns as col
from handeye.robots.urdf import UrdfArm

# No encoder of an arm counts beyond two turns either way [rad].
_TURNS = 4.0 * np.pi
# Two points of a workspace are at most twice the reach apart; the rest is for what the flange
# carries. More rows than `_GLITCHES` beyond are no glitches.
_WIDEST, _GLITCHES = 2.2, 0.05


def check_units(path: Path, arm: UrdfArm, joints: Array, columns: Mapping[str, Array]) -> None:
    """Joints (N, n) of an arm and columns (N,) of a table.

    Raises:
        InvalidInput: joints that seem to be in degrees, or lengths in millimetres.
    """
    turning = arm.readings.positions(joints)[:, ~arm.stages().slides]
    worst = float(np.abs(turning).max(initial=0.0))
    if worst > _TURNS:
        raise InvalidInput(
            f"{path}: joints go up to {worst:.4g}, which no encoder has in radians: if they are in "
            "degrees, multiply them by pi/180"
        )
    lengths: list[tuple[str, ...]] = [
        (name,) for name in ("distance_m", "range_m", "height_m") if name in columns
    ]
    if set(col.POSITION) <= set(columns):
        lengths.append(col.POSITION)
    for names in lengths:
        where = np.column_stack([columns[name] for name in names])
        away = np.linalg.norm(where - np.median(where, axis=0), axis=1)
        far = int(np.sum(away > _WIDEST * arm.reach))
        if far > _GLITCHES * len(away):
            raise InvalidInput(
                f"{path}: {far} of {len(away)} rows of {', '.join(names)} are farther than "
                f"{_WIDEST * arm.reach:.3g} m from the others, but {arm.name} reaches "
                f"{arm.reach:.3g} m: if they are in millimetres, divide them by 1000"
            )
