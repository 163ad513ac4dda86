"""Which topics of a recording have the joints, and which the measurements."""

from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from itertools import islice

from handeye.errors import LogError
from handeye.io.bags.messages import (
    JOINT_STATE,
    is_sighting,
    is_tags,
    is_transform,
    joint_reading,
)
from handeye.io.bags.recording import Recording, Topic
from handeye.io.bags.report import BagOptions

_MOST_SHOWN = 20
_FIRST = 50
_MEASUREMENTS = (
    "geometry_msgs/PointStamped, geometry_msgs/PoseStamped, AprilTagDetectionArray (with poses) or "
    "tf2_msgs/TFMessage"
)


def joints_topic(
    file: str, recording: Recording, options: BagOptions, wanted: Sequence[str] | None
) -> Topic:
    """The topic of joint states that the user names, or the only one that has the joints `wanted`.

    Raises:
        LogError: where there is none or more than one, listing all.
    """
    fitting = [t for t in recording.topics if t.type == JOINT_STATE and t.count]
    if options.joints_topic is not None:
        return _named(file, recording, options.joints_topic, "joints_topic", fitting, JOINT_STATE)
    if not fitting:
        raise LogError(
            f"{file}: has no joint states ({JOINT_STATE}): record them together with the "
            f"measurements; it has\n{_listed(recording.topics)}"
        )
    if len(fitting) == 1:
        return fitting[0]
    names = {topic.name: _first_names(recording, topic) for topic in fitting}
    if wanted is not None:
        complete = [topic for topic in fitting if set(wanted) <= set(names[topic.name])]
        if len(complete) == 1:
            return complete[0]
        fitting = complete or fitting
    lines = [f"{line}: {', '.join(names[t.name])}" for t in fitting for line in [_line(t)]]
    raise LogError(
        f"{file}: has joint states on more than one topic; say which with --joints-topic TOPIC "
        "(in Python: joints_topic=):\n" + "\n".join(lines)
    )


def points_topics(file: str, recording: Recording, options: BagOptions) -> tuple[Topic, ...]:
    """The topic of measurements that the user names, or the only one; all topics of transforms.

    Transforms are chosen where they are named, where nothing else is measured, or where a frame is
    named as the marker that is the number of no tag.

    Raises:
        LogError: where there is none or more than one, listing all.
    """
    used = [topic for topic in recording.topics if topic.count]
    simple = [topic for topic in used if is_sighting(topic.type)]
    trees = [topic for topic in used if is_transform(topic.type)]
    moving = [topic for topic in trees if not is_static(topic)]
    tags = [topic for topic in simple if is_tags(topic.type)]
    if options.points_topic is not None:
        fitting = [*simple, *moving]
        chosen = _named(
            file, recording, options.points_topic, "points_topic", fitting, _MEASUREMENTS
        )
        fitting = [chosen]
    elif options.marker is None:
        fitting = simple or moving
    else:
        fitting = (tags if options.marker.isdecimal() else moving) or tags or moving
    if not fitting:
        named = "" if options.marker is None else f" that name a marker ({options.marker})"
        raise LogError(
            f"{file}: has no measurements ({_MEASUREMENTS}){named}; it has\n"
            f"{_listed(recording.topics)}"
        )
    if len(fitting) > 1:
        raise LogError(
            f"{file}: has measurements on more than one topic; say which with --points-topic TOPIC "
            f"(in Python: points_topic=):\n{_listed(fitting)}"
        )
    if is_transform(fitting[0].type):
        return (fitting[0], *(topic for topic in trees if is_static(topic)))
    return tuple(fitting)


def is_static(topic: Topic) -> bool:
    """Whether a topic of transforms has those that hold for good, as ROS names it."""
    return topic.name.rpartition("/")[2] == "tf_static"


def _named(
    file: str,
    recording: Recording,
    name: str,
    option: str,
    fitting: Sequence[Topic],
    wanted: str,
) -> Topic:
    for topic in fitting:
        if topic.name.strip("/") == name.strip("/"):
            return topic
    known = {topic.name: topic for topic in recording.topics}
    if name in known:
        topic = known[name]
        problem = f"holds {topic.type}" if topic.count else "is empty"
        said = f"{name} {problem}, not {wanted}"
    else:
        near = get_close_matches(name, known, n=1)
        said = f"has no topic {name}" + (f"; did you mean {near[0]}?" if near else "")
    flag = "--" + option.replace("_", "-")
    candidates = f"; for {flag} choose from\n{_listed(fitting)}" if fitting else ""
    raise LogError(f"{file}: {said}{candidates}")


def _first_names(recording: Recording, topic: Topic) -> tuple[str, ...]:
    """The joints of the first messages: a gripper may take turns with its arm."""
    names: dict[str, None] = {}
    for message in islice(recording.messages({topic.name}), _FIRST):
        reading = joint_reading(message.content)
        names |= dict.fromkeys(reading.names if reading is not None else ())
    return tuple(names)


def _listed(topics: Iterable[Topic]) -> str:
    lines = [_line(topic) for topic in topics]
    more = len(lines) - _MOST_SHOWN
    shown = lines[:_MOST_SHOWN] + ([f"  and {more} more"] if more > 0 else [])
    return "\n".join(shown) or "  no topics"


def _line(topic: Topic) -> str:
    return f"  {topic.name}  {topic.type}  ({topic.count} messages)"
