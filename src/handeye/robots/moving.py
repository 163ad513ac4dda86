"""Links and joints of a pinocchio model that a chain is made of."""

from collections.abc import Sequence
from typing import Any
from xml.etree import ElementTree

import numpy as np

from handeye.arrays import Array
from handeye.errors import InvalidInput
from handeye.robots.tips import Ends, chosen_links


def unusable(urdf: str, error: Exception) -> str:
    """Why pinocchio could not read the text of a URDF file, and what to do."""
    try:
        tree = ElementTree.fromstring(urdf)
    except ElementTree.ParseError:
        tree = ElementTree.Element("robot")
    children = {child.get("link") for child in tree.iterfind("joint/child")}
    names = [link.get("name", "") for link in tree.iterfind("link")]
    roots = [name for name in names if name not in children]
    if len(roots) > 1:
        return (
            f"is not a usable URDF file (no joint connects {' and '.join(roots)}: connect them, by "
            "a fixed joint if they do not move against each other)"
        )
    return f"is not a usable URDF file ({error}); expand a xacro file with `xacro` first"


def links_in(model: Any) -> dict[str, int]:
    """The number of the joint that moves each link, the root first."""
    # A joint's frame has another type, and may have a link's name.
    bodies = [frame for frame in model.frames if frame.type.name == "BODY"]
    return {str(body.name): int(body.parentJoint) for body in bodies}


def ends_in(model: Any, name: str, tip: str | None, eye: str | None) -> Ends:
    """The links asked for, or those that are usual; raises as `chosen_links`."""
    return chosen_links(links_in(model), [list(way) for way in model.supports], name, tip, eye)


def refuse_unless_single(model: Any, joint: str, name: str, tip: str) -> None:
    """InvalidInput unless a joint on the way to a tip is there and has one freedom."""
    if not model.existJointName(joint):
        raise InvalidInput(
            f"{name}: a mimic joint on the way to {tip} follows {joint!r}, which is no moving joint"
        )
    if model.joints[model.getJointId(joint)].nv != 1:
        raise InvalidInput(
            f"{name}: joint {joint} on the way to {tip} is no revolute, continuous or prismatic "
            "joint: choose a link before it with --tip (in Python: tip=), or begin beyond it with "
            "--eye (eye=)"
        )


def limits(model: Any, joints: Sequence[str]) -> tuple[Array, Array]:
    """Lower and upper ones (m,) of joints [rad] or [m], infinite where there are none."""
    numbers = [model.getJointId(joint) for joint in joints]
    at = np.array([model.joints[i].idx_q for i in numbers], dtype=np.int64)
    freely = np.array([model.joints[i].nq == 2 for i in numbers], dtype=bool)
    low, high = model.lowerPositionLimit[at], model.upperPositionLimit[at]
    # A limit that the file leaves out reads as 0 <= q <= 0.
    unlimited = freely | (low >= high)
    return np.where(unlimited, -np.inf, low), np.where(unlimited, np.inf, high)
