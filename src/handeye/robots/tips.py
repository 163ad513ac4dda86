"""Which links of a robot carry the marker and the sensor when nobody says so."""

from collections.abc import Collection
from difflib import get_close_matches
from typing import NamedTuple

from handeye.errors import InvalidInput

# Names that robot makers give to the mounting face, most telling first. Any link fixed to the last
# moving one serves as well, since the marker's place on it is estimated; but `tool0` (so called by
# ROS-Industrial) is also the frame in which the robot's own controller reports its pose.
_FLANGE_NAMES = ("flange", "tool0", "ee_link", "end_effector", "link_eef")


class Ends(NamedTuple):
    """The links that carry the marker and, if it is not the root, the sensor."""

    tip: str
    eye: str | None


def chosen_links(
    links: dict[str, int], ways: list[list[int]], name: str, tip: str | None, eye: str | None
) -> Ends:
    """The links asked for, or those that are usual.

    links: which joint moves each, the root first; ways: the joints from the root to each joint,
    itself the last.

    Raises:
        InvalidInput: for a link that is not there, or that no joint moves against the other; if no
            tip is given, when several are possible.
    """
    for link in (tip, eye):
        if link is not None and link not in links:
            raise InvalidInput(f"{name} has no link {link!r}: choose one of {_near(link, links)}")
    base = 0 if eye is None else links[eye]
    if tip is None:
        tip = default_tip(ways, links, name)
        if links[tip] == base:
            tip = next(iter(links))
    if links[tip] == base:
        moved = f"the link {tip!r}" if eye is None else f"the link {tip!r} against {eye!r}"
        raise InvalidInput(f"{name}: no joint moves {moved}: choose one beyond a joint")
    return Ends(tip, eye)


def default_tip(ways: list[list[int]], joints: dict[str, int], name: str) -> str:
    """The end of the longest chain of moving joints, if there is but one.

    ways: the joints from the root to each joint, itself the last; joints: which one moves a link.
    """
    longest = max(len(way) for way in ways)
    if longest == 1:
        raise InvalidInput(f"{name} has no moving joint")
    ends = [joint for joint, way in enumerate(ways) if len(way) == longest]
    behind: list[list[str]] = [[] for _ in ways]
    for link, joint in joints.items():
        behind[joint].append(link)
    if len(ends) == 1:
        fixed = behind[ends[0]]
        usual = [link for known in _FLANGE_NAMES for link in fixed if link.endswith(known)]
        return (usual or fixed)[0]
    tips = [behind[end][0] for end in ends]
    fork = max(joint for joint in ways[ends[0]] if all(joint in ways[end] for end in ends))
    before = f"\n  before they part: {', '.join(behind[fork])}" if fork else ""
    raise InvalidInput(
        f"{name}: {len(tips)} chains of {longest - 1} moving joints are equally long, so its tip "
        "is not clear; say with --tip LINK (in Python: tip=) which link carries the marker:\n"
        f"  ends: {', '.join(tips)}{before}"
    )


def _near(link: str, links: Collection[str]) -> str:
    return ", ".join(get_close_matches(link, links, n=3, cutoff=0.5) or links)
