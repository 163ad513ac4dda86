"""Which link of a robot its joints bring to the marker, when a log says which joints were read."""

from collections.abc import Collection
from xml.etree import ElementTree

from handeye.errors import InvalidInput

_MOVING = {"revolute", "continuous", "prismatic"}


def tip_of_joints(urdf: str, joints: Collection[str]) -> str | None:
    """The link that most of the joints move, of those that no other joint moves.

    Links fixed to each other serve alike, since the marker's place on them is estimated. Where
    several branches are equally long by one joint each, as fingers are, it is the link before they
    part; None where branches are longer (two arms), or where no joint is the robot's.
    """
    moves = _moves(urdf)
    known = [way for way in moves.values() if way and way <= set(joints)]
    if not known:
        return None
    longest = max(len(way) for way in known)
    ends = [way for way in known if len(way) == longest]
    common = ends[0].intersection(*ends)
    if not common or len(common) < longest - 1:
        return None
    return next(link for link, way in moves.items() if way == common)


def _moves(urdf: str) -> dict[str, frozenset[str]]:
    """The moving joints between the root and each link, those left out that follow others."""
    try:
        root = ElementTree.fromstring(urdf)
    except ElementTree.ParseError as error:
        raise InvalidInput(f"the URDF is no XML: {error}") from error
    above: dict[str, tuple[str, str | None]] = {}
    for joint in root.iter("joint"):
        parent, child = joint.find("parent"), joint.find("child")
        if parent is None or child is None:
            continue
        moving = joint.get("type") in _MOVING and joint.find("mimic") is None
        name = joint.get("name") if moving else None
        above[child.get("link", "")] = (parent.get("link", ""), name)
    out: dict[str, frozenset[str]] = {}
    for link in (link.get("name", "") for link in root.findall("link")):
        way: set[str] = set()
        at, steps = link, 0
        while at in above and steps <= len(above):
            at, name = above[at]
            way |= {name} if name else set()
            steps += 1
        out[link] = frozenset(way)
    return out
