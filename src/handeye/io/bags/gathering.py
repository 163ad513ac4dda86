"""One pass through a recording: what its joints and measurements are."""

from collections.abc import Sequence

from handeye.errors import LogError
from handeye.io.bags.messages import is_transform, joint_reading, sightings
from handeye.io.bags.recording import Progress, Recording, Topic
from handeye.io.bags.report import BagOptions
from handeye.io.bags.topics import is_static
from handeye.io.bags.tracks import Fault, Joints, Sightings

_EVERY = 256

REASONS: dict[Fault, str] = {
    "decoded": "they cannot be decoded",
    "stamped": "they have no time stamp (header.stamp is 0)",
    "finite": "they have values that are not finite, or a quaternion of zeros",
    "repeated": "they repeat the time stamp of another",
}


def gather(
    recording: Recording,
    joints: Topic,
    measured: Sequence[Topic],
    options: BagOptions,
    progress: Progress,
) -> tuple[Joints, Sightings]:
    """All joint readings, and all sightings on the topics `measured`."""
    kinds = {topic.name: topic for topic in measured}
    angles, seen = Joints(), Sightings(posed=is_transform(measured[0].type))
    total = joints.count + sum(topic.count for topic in measured)
    for done, message in enumerate(recording.messages({joints.name, *kinds})):
        if done % _EVERY == 0:
            progress(done, total)
        if message.topic == joints.name:
            reading = None if message.content is None else joint_reading(message.content)
            if reading is not None and options.receipt_times:
                reading = reading._replace(stamp=message.received)
            angles.add(reading, message.received)
            continue
        topic = kinds[message.topic]
        found = None if message.content is None else sightings(topic.type, message.content)
        if is_static(topic):
            seen.fix(found)
            continue
        if found is not None and options.receipt_times:
            found = [sighting._replace(stamp=message.received) for sighting in found]
        seen.add(found, message.received)
    progress(total, total)
    return angles, seen


def check_gathered(
    file: str, joints: Topic, points: Topic, angles: Joints, seen: Sightings
) -> None:
    """Refuse a recording in which every message of a topic is unusable.

    Raises:
        LogError: with the reason of most, and what to do.
    """
    if not angles.streams:
        raise LogError(
            f"{file}: no joint state of {joints.name} can be used: {_most(angles.faults)}"
        )
    if seen.streams:
        return
    if seen.blank and not seen.faults:
        raise LogError(
            f"{file}: {points.name} has {seen.blank} messages, but no pose in any; where the "
            "detector sends poses as transforms, give --points-topic /tf --frame CAMERA "
            "--marker TAG_FRAME (in Python: points_topic=, frame=, marker=)"
        )
    raise LogError(f"{file}: no measurement of {points.name} can be used: {_most(seen.faults)}")


def _most(found: dict[Fault, int]) -> str:
    if not found:
        return "the messages are empty"
    fault = max(found, key=lambda kind: found[kind])
    remedy = {
        "decoded": "the recording is damaged, or its type is not the one that it names",
        "stamped": "let the driver set header.stamp and record again; times of receipt, which lag "
        "and vary, are used with --receipt-times (in Python: receipt_times=True)",
    }.get(fault, "check what the driver sends")
    return f"{REASONS[fault]}; {remedy}"
