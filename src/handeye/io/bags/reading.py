"""From a recording to a log."""

from collections.abc import Sequence
from dataclasses import replace
from difflib import get_close_matches
from pathlib import Path

import numpy as np

from handeye.arrays import Array
from handeye.errors import LogError
from handeye.io import columns as col
from handeye.io.bags import accounting
from handeye.io.bags.delay import Delay, estimate_delay, stated
from handeye.io.bags.features import Kinematics
from handeye.io.bags.frames import choose, compose
from handeye.io.bags.gathering import REASONS, check_gathered, gather
from handeye.io.bags.matching import JointMotion
from handeye.io.bags.messages import is_transform
from handeye.io.bags.recording import Progress, open_recording, unwatched
from handeye.io.bags.report import BagOptions, BagReading, BagReport, Unused
from handeye.io.bags.topics import joints_topic, points_topics
from handeye.io.bags.tracks import Joints, Track, seconds
from handeye.io.tables import Table
from handeye.io.validation import checked_log

_DEFAULTS = BagOptions()


def read_bag(
    path: Path | str,
    *,
    arm: Kinematics | None = None,
    options: BagOptions = _DEFAULTS,
    skip_bad: bool = False,
    progress: Progress = unwatched,
) -> BagReading:
    """A log from a ROS 1 bag, a ROS 2 bag (folder, .db3 or .mcap) or an MCAP file without ROS.

    Joint states (`sensor_msgs/JointState`) are interpolated at the stamps of measurements: one of
    `geometry_msgs/PointStamped`, `geometry_msgs/PoseStamped`, AprilTag detections with poses, or
    transforms between two frames. A constant delay of the sensor's stamps against the joints' is
    estimated (`delay`) and taken out. Measurements without joint states around them are left out,
    and so is everything else that makes no row; the report says how much and why.

    With `arm` the log has its joints, in its order, and the delay is estimated with its kinematics.
    With `skip_bad`, bad rows are left out, and a recording that was cut off is used up to there.

    Raises:
        LogError: for a file that is damaged or none, topics or frames that are not clear (the
            message lists what there is), missing joints, no common time, or bad values as in
            `read_log`.
        MissingExtra: without the extra `bags`.
    """
    file = Path(path)
    names = None if arm is None else arm.joint_names
    with open_recording(file, skip_bad=skip_bad) as recording:
        if recording.damage and not recording.topics:
            raise LogError(f"{recording.damage}, and nothing can be read before that")
        joints = joints_topic(str(file), recording, options, names)
        measured = points_topics(str(file), recording, options)
        points = measured[0]
        angles, seen = gather(recording, joints, measured, options, progress)
        others = accounting.other_topics(
            recording.topics, {joints.name, *(topic.name for topic in measured)}
        )
        damage = recording.damage
    check_gathered(str(file), joints, points, angles, seen)
    pick = compose if is_transform(points.type) else choose
    pair, whole = pick(str(file), points.name, seen, options)
    names = _present(file, joints.name, angles, names)
    track, not_finite = _finite(whole)

    tracks = angles.tracks(names)
    start = min(int(part.stamps[0]) for _, part in tracks)
    motion = JointMotion(names, tracks, start, options.tolerance)
    stamps = seconds(track.stamps, start)
    delay = _delay(stamps, track.values, motion, arm, options)
    moments = stamps - delay.seconds
    matched = motion.at(moments)
    if not matched.usable.any():
        raise LogError(_apart(file, (joints.name, points.name), tracks, track, options))

    kept = matched.usable
    values, oriented = _columns(names, moments[kept], matched.angles[kept], track.values[kept])
    reading = checked_log(
        Table(f"{file}: {points.name}", {}, track.numbers[kept]),
        values,
        [name + col.JOINT_SUFFIX for name in names],
        [name for name in angles.names if name not in names],
        skip_bad=skip_bad,
    )
    report = BagReport(
        joints_topic=joints.name,
        points_topic=points.name,
        measured=accounting.named(pair),
        oriented=oriented,
        start=start,
        tolerance=options.tolerance,
        delay=delay,
        interpolated=int(np.sum(matched.interpolated)),
        unused=(
            *accounting.faults(joints.name, angles.faults),
            *accounting.other_joints(joints.name, angles, names),
            *accounting.faults(points.name, seen.faults),
            *accounting.other_sightings(points.name, seen, pair, whole),
            *([Unused(points.name, not_finite, REASONS["finite"])] if not_finite else []),
            *accounting.unmatched(points.name, moments, matched, options.tolerance),
        ),
        others=others,
        damage=damage,
    )
    return BagReading(replace(reading.log, name=str(file)), reading.rejected, report=report)


def _delay(
    stamps: Array,
    values: Array,
    motion: JointMotion,
    arm: Kinematics | None,
    options: BagOptions,
) -> Delay:
    if options.delay is not None:
        return stated(options.delay)
    return estimate_delay(stamps, values[:, :3], motion, arm)


def _finite(track: Track) -> tuple[Track, int]:
    """The sightings whose position is known, and how many are not: a sensor that saw nothing."""
    good = np.isfinite(track.values[:, :3]).all(axis=1)
    kept = Track(track.stamps[good], track.values[good], track.numbers[good], track.lag)
    return kept, int(np.sum(~good))


def _columns(
    names: Sequence[str], moments: Array, angles: Array, values: Array
) -> tuple[dict[str, Array], bool]:
    """Columns of the log, and whether they have the orientation: only if every row has one."""
    columns = {col.TIME: moments}
    columns |= {name + col.JOINT_SUFFIX: angles[:, i] for i, name in enumerate(names)}
    oriented = bool(np.isfinite(values[:, 3:]).all())
    measured = (*col.POSITION, *col.ORIENTATION) if oriented else col.POSITION
    return columns | {name: values[:, i] for i, name in enumerate(measured)}, oriented


def _present(
    file: Path, topic: str, angles: Joints, wanted: Sequence[str] | None
) -> tuple[str, ...]:
    """The joints of the log.

    Raises:
        LogError: naming those that the recording lacks, with near names.
    """
    if wanted is None:
        return angles.names
    missing = [name for name in wanted if name not in angles.names]
    if not missing:
        return tuple(wanted)
    lines = [
        f"{file}: {topic} lacks joints of the robot: {', '.join(missing)}",
        f"  it has: {', '.join(angles.names)}",
    ]
    unknown = [name for name in angles.names if name not in wanted]
    for name in missing:
        near = [other for other in unknown if name in other or other in name]
        near = near or get_close_matches(name, unknown, n=1, cutoff=0.6)
        lines += [f"  {near[0]} may be {name}"] if near else []
    lines.append(
        "  Give the URDF that the robot was driven with, or --tip with a link before these joints. "
        "To rename joints, write a table with `handeye convert` and rename its columns."
    )
    raise LogError("\n".join(lines))


def _apart(
    file: Path,
    topics: tuple[str, str],
    tracks: Sequence[tuple[tuple[str, ...], Track]],
    track: Track,
    options: BagOptions,
) -> str:
    """Why no measurement has joint states around it."""
    start = f"{file}: no measurement of {topics[1]} has joint states of {topics[0]} around it: "
    slowest = max((part for _, part in tracks), key=lambda part: int(part.stamps[0]))
    first, last = int(slowest.stamps[0]), int(slowest.stamps[-1])
    if len(track.stamps) and (track.stamps[-1] < first or track.stamps[0] > last):
        away = max(first - int(track.stamps[-1]), int(track.stamps[0]) - last) / 1e9
        between = (slowest.lag - track.lag) / 1e9
        return (
            f"{start}their stamps are {away:.4g} s apart, so that their clocks differ; synchronise "
            f"them and record again, or state the delay (by the times of receipt, --delay "
            f"{between:.3f}; in Python: delay=)"
        )
    gap = float(np.median(np.diff(slowest.stamps))) / 1e9 if len(slowest.stamps) > 1 else np.inf
    return (
        f"{start}these come every {gap:.3g} s, and the tolerance is {options.tolerance:g} s; raise "
        "it with --tolerance (in Python: tolerance=), or record joint states more often"
    )
