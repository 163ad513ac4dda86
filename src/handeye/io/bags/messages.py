"""What messages say: joint readings, and where something was seen."""

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from handeye.io.bags.decoding import UNREADABLE

JOINT_STATE = "sensor_msgs/msg/JointState"
TRANSFORMS = "tf2_msgs/msg/TFMessage"
_OLD_TRANSFORMS = "tf/msg/tfMessage"
_TAGS = "AprilTagDetectionArray"

LAST_STAMP = 2**63 - 1
"""The latest time that fits the arrays in which stamps are kept [ns], in the year 2262."""

_NO_ORIENTATION = (float("nan"),) * 4


class JointReading(NamedTuple):
    """Positions of the joints of these names at `stamp` [ns]; 0 is a message without a stamp."""

    stamp: int
    names: tuple[str, ...]
    positions: tuple[float, ...]


class Sighting(NamedTuple):
    """Something seen at `stamp` [ns]; 0 is a message without a stamp.

    frame   the frame in which it is given
    marker  which of several things was seen: the child frame of a transform, the number of a tag;
            empty where a message cannot say
    pose    x, y, z [m] and w, x, y, z, which are NaN where there is no orientation
    """

    stamp: int
    frame: str
    marker: str
    pose: tuple[float, ...]


def is_transform(kind: str) -> bool:
    """Whether messages of this type are a tree of frames."""
    return kind in {TRANSFORMS, _OLD_TRANSFORMS}


def is_tags(kind: str) -> bool:
    """Whether messages of this type are AprilTag detections, of whichever package."""
    return kind.rpartition("/")[2] == _TAGS


def is_sighting(kind: str) -> bool:
    """Whether messages of this type are one position or pose, or tags."""
    return kind in _READERS or is_tags(kind)


def joint_reading(content: Any) -> JointReading | None:
    """The joints of a `sensor_msgs/JointState`; None for a message that makes no sense."""
    try:
        names = tuple(str(name) for name in content.name)
        positions = tuple(float(value) for value in content.position)
        if len(names) != len(positions):
            return None
        return JointReading(_stamp(content.header), names, positions)
    except UNREADABLE:
        return None


def sightings(kind: str, content: Any) -> list[Sighting] | None:
    """All that a message of type `kind` has seen; None for a message that makes no sense."""
    if is_transform(kind):
        reader = _from_transforms
    elif is_tags(kind):
        reader = _from_tags
    else:
        reader = _READERS[kind]
    try:
        return list(reader(content))
    except UNREADABLE:
        return None


def _from_point(content: Any) -> Iterator[Sighting]:
    position = _xyz(content.point)
    yield Sighting(_stamp(content.header), _frame(content), "", position + _NO_ORIENTATION)


def _from_pose(content: Any) -> Iterator[Sighting]:
    yield Sighting(_stamp(content.header), _frame(content), "", _pose(content.pose))


def _from_tags(content: Any) -> Iterator[Sighting]:
    """Tags with a pose; a bundle of tags is named after all of them."""
    for tag in content.detections:
        if not hasattr(tag, "pose"):
            continue
        ids = tag.id if hasattr(tag.id, "__len__") else [tag.id]
        marker = "+".join(str(int(number)) for number in ids)
        stamp = _stamp(content.header) or _stamp(tag.pose.header)
        yield Sighting(stamp, _frame(content), marker, _pose(tag.pose))


def _from_transforms(content: Any) -> Iterator[Sighting]:
    for step in content.transforms:
        moved, child = step.transform, str(step.child_frame_id).lstrip("/")
        pose = _xyz(moved.translation) + _wxyz(moved.rotation)
        yield Sighting(_stamp(step.header), _frame(step), child, pose)


_READERS: dict[str, Callable[[Any], Iterator[Sighting]]] = {
    "geometry_msgs/msg/PointStamped": _from_point,
    "geometry_msgs/msg/PoseStamped": _from_pose,
}


def _stamp(header: Any) -> int:
    time = header.stamp
    nanoseconds = time.nanosec if hasattr(time, "nanosec") else time.nsec
    stamp = int(time.sec) * 1_000_000_000 + int(nanoseconds)
    if not 0 <= stamp <= LAST_STAMP:
        raise ValueError(stamp)
    return stamp


def _frame(stamped: Any) -> str:
    """The frame; ROS 1 wrote it with or without a leading slash."""
    return str(stamped.header.frame_id).lstrip("/")


def _pose(content: Any) -> tuple[float, ...]:
    """Of a Pose, and of the messages that wrap one, with a header or a covariance."""
    while not hasattr(content, "position"):
        content = content.pose
    return _xyz(content.position) + _wxyz(content.orientation)


def _xyz(vector: Any) -> tuple[float, ...]:
    return (float(vector.x), float(vector.y), float(vector.z))


def _wxyz(quaternion: Any) -> tuple[float, ...]:
    """Four zeros are a quaternion that nobody has set: no orientation."""
    wxyz = (quaternion.w, quaternion.x, quaternion.y, quaternion.z)
    return tuple(float(value) for value in wxyz) if any(wxyz) else _NO_ORIENTATION
