"""The placements of joints in the text of a URDF file, read and changed, all else left as it is."""

from collections.abc import Mapping, Sequence
from typing import Any
from xml.parsers import expat

import numpy as np
from scipy.spatial.transform import Rotation

from handeye.arrays import Array, shaped
from handeye.errors import FileFormatError, InvalidInput


def joint_origins(urdf: str, joint_names: Sequence[str]) -> Array:
    """Placements T_parent_joint (n, 4, 4) of the joints named, as the text has them.

    Raises:
        FileFormatError: text that is no XML, or numbers that are none.
        InvalidInput: a joint that the text does not have.
    """
    found = _joints(urdf)
    return np.array([found[name].pose for name in _known(found, joint_names)]).reshape(-1, 4, 4)


def corrected_urdf(urdf: str, joint_names: Sequence[str], departures: Array) -> str:
    """The text with other placements of the joints named; every other byte stays.

        T_parent_joint <- T_parent_joint D_j

    so that joint j stands D_j (4, 4) off, in its own frame, from where it stood. departures
    (n, 4, 4) in the order of the names. Numbers are written in full. What no placement can say,
    such as errors that change with a joint's angle, is not in the file.

    Raises:
        FileFormatError, InvalidInput: as `joint_origins`, or departures of another shape.
    """
    D = shaped(departures, (len(joint_names), 4, 4), "departures")
    found, source = _joints(urdf), urdf.encode()
    changes: list[tuple[int, int, bytes]] = []
    for name, departure in zip(_known(found, joint_names), D, strict=True):
        joint = found[name]
        changes.append((joint.begin, joint.end, origin_element(joint.pose @ departure).encode()))
    for begin, end, text in sorted(changes, reverse=True):
        source = source[:begin] + text + source[end:]
    return source.decode()


def origin_element(pose: Array) -> str:
    """`<origin xyz="..." rpy="..."/>` of a pose (4, 4)."""
    xyz, rpy = (" ".join(map(repr, part)) for part in xyz_rpy(pose))
    return f'<origin xyz="{xyz}" rpy="{rpy}"/>'


def xyz_rpy(pose: Array) -> tuple[list[float], list[float]]:
    """Position [m], and roll, pitch and yaw [rad] with R = R_z(yaw) R_y(pitch) R_x(roll).

    Exact at any pitch: roll is read from R after yaw has been taken off.
    """
    R = pose[:3, :3]
    yaw = np.arctan2(R[1, 0], R[0, 0])
    c, s = np.cos(yaw), np.sin(yaw)
    pitch = np.arctan2(-R[2, 0], c * R[0, 0] + s * R[1, 0])
    roll = np.arctan2(s * R[0, 2] - c * R[1, 2], c * R[1, 1] - s * R[0, 1])
    return pose[:3, 3].tolist(), [float(roll), float(pitch), float(yaw)]


class _Joint:
    """A joint's placement, and the bytes of its `<origin>`, or where one belongs."""

    def __init__(self, begin: int) -> None:
        self.begin = self.end = begin
        self.pose: Array = np.eye(4)


def _joints(urdf: str) -> dict[str, _Joint]:
    source = urdf.encode()
    parser = expat.ParserCreate("utf-8")
    found: dict[str, _Joint] = {}
    path: list[str] = []
    here: list[_Joint] = []

    def tag_end(begin: int) -> int:
        quote = b""
        for i in range(begin, len(source)):
            at = source[i : i + 1]
            if quote:
                quote = b"" if at == quote else quote
            elif at in b"\"'":
                quote = at
            elif at == b">":
                return i + 1
        raise FileFormatError("the text ends inside a tag")

    def start(name: str, attributes: Mapping[str, str]) -> None:
        begin = parser.CurrentByteIndex
        if path == ["robot"] and name == "joint":
            here[:] = [_Joint(tag_end(begin))]
            found[attributes.get("name", "")] = here[0]
        elif path == ["robot", "joint"] and name == "origin":
            joint = here[0]
            joint.begin, joint.pose = begin, _pose(attributes)
            joint.end = tag_end(begin)
        path.append(name)

    def end(_name: str) -> None:
        # An origin that is not closed in its own tag goes as a whole.
        if path == ["robot", "joint", "origin"]:
            joint, at = here[0], parser.CurrentByteIndex
            if source[at : at + 2] == b"</":
                joint.end = tag_end(at)
        path.pop()

    hooks: Any = parser
    hooks.StartElementHandler, hooks.EndElementHandler = start, end
    try:
        parser.Parse(source, True)
    except expat.ExpatError as error:
        raise FileFormatError(f"is no XML text ({error})") from error
    return found


def _pose(attributes: Mapping[str, str]) -> Array:
    try:
        xyz, rpy = (
            [float(word) for word in attributes.get(name, "0 0 0").split()]
            for name in ("xyz", "rpy")
        )
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = Rotation.from_euler("xyz", rpy).as_matrix(), xyz
        return pose
    except ValueError as error:
        raise FileFormatError(f"an origin has no three numbers each ({error})") from error


def _known(found: Mapping[str, _Joint], names: Sequence[str]) -> Sequence[str]:
    missing = [name for name in names if name not in found]
    if missing:
        raise InvalidInput(
            f"the URDF has no joint {', '.join(missing)}; it has {', '.join(sorted(found))}"
        )
    return names
