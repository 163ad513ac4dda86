"""Whether a log can come from a given arm."""

from dataclasses import replace
from difflib import get_close_matches

import numpy as np

from handeye.arrays import Array
from handeye.errors import LogError
from handeye.io.columns import near_name
from handeye.io.logs import BadRow, Log, LogReading
from handeye.io.records import usable
from handeye.observations import PointObservation
from handeye.robots.arm import Arm

# Two points of a workspace are at most twice the reach apart; the rest is for the marker's own
# offset from the flange.
_WIDEST = 2.2
# More rows than this out of reach are no glitches but a wrong unit or robot.
_GLITCHES = 0.05


def check_log(arm: Arm, log: Log, *, skip_bad: bool = False) -> LogReading:
    """The rows of `log` that `arm` can have made, with the joints in the arm's order.

    Joints that the arm does not have are dropped. A row is out of reach when its marker is
    farther than 2.2 times the arm's reach from the middle (median) of all; of a stereo log, when
    its range is. Where the base stands is not yet known, so this finds gross errors only.

    Raises:
        LogError: for missing joints, positions in a unit other than metres (never skippable), or
            rows out of reach without `skip_bad`.
    """
    log = in_order_of(arm, log)
    seen = log.observations
    where = seen.position if isinstance(seen, PointObservation) else seen.range[:, None]
    away = np.linalg.norm(where - np.median(where, axis=0), axis=1)
    widest = _WIDEST * arm.reach
    out = np.flatnonzero(away > widest)
    if len(out) > _GLITCHES * len(log):
        raise LogError(_wrong_unit(arm, log, away, widest))
    rejected = [
        BadRow(
            log.name,
            int(log.rows[i]),
            f"the marker is {away[i]:.3g} m from the middle of the log, out of reach of {arm.name} "
            f"({arm.reach:.3g} m)",
            "correct or delete the row",
        )
        for i in out.tolist()
    ]
    good, rejected = usable(log.name, log.rows, rejected, skip_bad=skip_bad)
    return LogReading(log.only(good), rejected)


def in_order_of(arm: Arm, log: Log) -> Log:
    """`log` with exactly the joints of `arm`, in the arm's order.

    Raises:
        LogError: naming every missing joint, those of the log, and near names.
    """
    missing = [name for name in arm.joint_names if name not in log.joint_names]
    if missing:
        raise LogError(_missing_joints(arm, log, missing))
    order = [log.joint_names.index(name) for name in arm.joint_names]
    kept = replace(log.observations, joints=np.ascontiguousarray(log.observations.joints[:, order]))
    return replace(log, joint_names=tuple(arm.joint_names), observations=kept)


def _missing_joints(arm: Arm, log: Log, missing: list[str]) -> str:
    unknown = [name for name in log.joint_names if name not in arm.joint_names]
    lines = [
        f"{log.name}: joints of {arm.name} are missing: {', '.join(missing)}",
        f"  the log's joints: {', '.join(log.joint_names)}",
    ]
    for name in missing:
        ignored = near_name(f"{name}_rad", log.ignored)
        near = [other for other in unknown if other in name or name in other]
        near = near or get_close_matches(name, unknown, n=1, cutoff=0.6)
        if ignored:
            lines.append(f"  {ignored}")
        elif near:
            lines.append(f"  {near[0]}_rad: rename it to {name}_rad, if that is what it holds")
    lines.append(
        f"  Every joint of {arm.name} needs a column <joint name>_rad. If it has joints beyond the "
        "marker, such as a gripper's, choose the link that carries the marker with --tip."
    )
    return "\n".join(lines)


def _wrong_unit(arm: Arm, log: Log, away: Array, widest: float) -> str:
    far = int(np.sum(away > widest))
    millimetres = float(np.percentile(away, 95)) / 1000.0 <= widest
    seems = "seem to be in millimetres: divide them by 1000" if millimetres else "are not in metres"
    return (
        f"{log.name}: {far} of {len(log)} rows are farther than {widest:.3g} m from the middle of "
        f"the log, but {arm.name} reaches {arm.reach:.3g} m; the positions {seems}, or the log is "
        "another robot's"
    )
