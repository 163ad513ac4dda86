"""Which columns a log needs, and which near miss a missing one may be."""

import re
from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from typing import Literal

from handeye.errors import LogError

TIME = "time_s"
JOINT_SUFFIX = "_rad"
POSITION = ("x_m", "y_m", "z_m")
ORIENTATION = ("qw", "qx", "qy", "qz")
POSITION_STD = ("std_x_m", "std_y_m", "std_z_m")
STEREO_JOINTS = ("alpha_rad", "beta_rad")
SIGHTING = ("pointing_rad", "range_m", "eccentricity_rad")

_CONVERSIONS = {
    "mm": "divide it by 1000",
    "cm": "divide it by 100",
    "deg": "multiply it by pi/180",
    "degree": "multiply it by pi/180",
    "degrees": "multiply it by pi/180",
    "ms": "divide it by 1000",
    "us": "divide it by 1000000",
    "ns": "divide it by 1000000000",
}
_JOINT_LIKE = re.compile(r"joint|axis|^(q|j|theta)_?\d+")
_MOST_NAMES_SHOWN = 30


def kind_of(found: Iterable[str]) -> Literal["point", "stereo"]:
    """Which kind of log a header belongs to: the one of which it names more columns."""
    names = set(found)
    stereo, point = len(names & set(SIGHTING)), len(names & set(POSITION))
    return "stereo" if stereo > point else "point"


def required(file: str, found: Sequence[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The joint columns, and all other columns that are needed, of a log with header `found`.

    Optional groups of columns are needed when one of the group is there.

    Raises:
        LogError: naming every missing column, what was found, and what a near name may mean.
    """
    if kind_of(found) == "stereo":
        joints, others = STEREO_JOINTS, (TIME, *SIGHTING)
    else:
        joints = tuple(n for n in found if n.endswith(JOINT_SUFFIX) and n != JOINT_SUFFIX)
        others = (TIME, *POSITION)
        for group in (ORIENTATION, POSITION_STD):
            if set(group) & set(found):
                others += group
    missing = [name for name in (*joints, *others) if name not in found]
    if missing or not joints:
        raise LogError(_missing(file, found, missing, has_joints=bool(joints)))
    return joints, others


def _missing(file: str, found: Sequence[str], missing: Sequence[str], *, has_joints: bool) -> str:
    wanted = (
        [*missing] if has_joints else [*missing, f"a joint column (<joint name>{JOINT_SUFFIX})"]
    )
    shown = ", ".join(found[:_MOST_NAMES_SHOWN])
    if len(found) > _MOST_NAMES_SHOWN:
        shown += f" and {len(found) - _MOST_NAMES_SHOWN} more"
    lines = [f"{file}: missing columns: {', '.join(wanted)}", f"  found: {shown}"]
    hints = [hint for name in missing if (hint := near_name(name, found))]
    if not has_joints:
        candidates = [n for n in found if _JOINT_LIKE.search(n.lower()) or _tokens(n)[1] == "deg"]
        hints += [_hint(n, "_".join(_tokens(n)[0]) + JOINT_SUFFIX) for n in candidates]
    if len(found) == 1 and (separator := next((s for s in ";\t|" if s in found[0]), None)):
        hints.append(
            f"the columns are separated by {separator!r}: separate them by commas, "
            "or turn a file of a known kind into a log with `handeye convert`"
        )
    return "\n".join(lines + [f"  {hint}" for hint in hints])


def near_name(wanted: str, found: Iterable[str]) -> str | None:
    """What to do with the column of `found` that comes closest to `wanted`, if one does."""
    names = list(found)
    base = _tokens(wanted)[0]
    same = [name for name in names if _tokens(name)[0] == base]
    close = same or get_close_matches(wanted, names, n=1, cutoff=0.75)
    return _hint(close[0], wanted) if close else None


def _hint(name: str, wanted: str) -> str:
    have, want = _tokens(name)[1], _tokens(wanted)[1]
    if have in _CONVERSIONS:
        return f"{name}: {_CONVERSIONS[have]} and rename it to {wanted}"
    if want and not have:
        unit = {"m": "metres", "rad": "radians", "s": "seconds"}[want]
        return f"{name}: if it is in {unit}, rename it to {wanted}"
    return f"{name}: rename it to {wanted}, if that is what it holds"


def _tokens(name: str) -> tuple[tuple[str, ...], str]:
    """The words of a column's name, and its unit if it ends with one."""
    words = tuple(word for word in re.split(r"[^a-z0-9]+", name.lower()) if word)
    if len(words) > 1 and words[-1] in {"m", "rad", "s", *_CONVERSIONS}:
        return words[:-1], words[-1]
    return words, ""
