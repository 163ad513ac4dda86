"""What no row was made of, and why."""

from collections.abc import Collection, Sequence

import numpy as np

from handeye.arrays import Array
from handeye.io.bags.frames import Pair
from handeye.io.bags.gathering import REASONS
from handeye.io.bags.matching import Matched
from handeye.io.bags.recording import Topic
from handeye.io.bags.report import Unused
from handeye.io.bags.tracks import Fault, Joints, Sightings, Track


def faults(topic: str, found: dict[Fault, int]) -> list[Unused]:
    """Messages that were dropped while gathering."""
    return [Unused(topic, count, REASONS[fault]) for fault, count in found.items() if count]


def other_joints(topic: str, angles: Joints, names: Collection[str]) -> list[Unused]:
    """Messages of joints of which none is in the log."""
    return [
        Unused(topic, len(stream), f"they are of other joints: {', '.join(joints)}")
        for joints, stream in angles.streams.items()
        if not set(joints) & set(names)
    ]


def other_sightings(topic: str, seen: Sightings, pair: Pair, track: Track) -> list[Unused]:
    """Messages without a sighting, and sightings of other things than the pair."""
    found: list[Unused] = []
    if seen.blank:
        found.append(Unused(topic, seen.blank, "nothing was seen in them"))
    own = seen.streams.get(pair)
    if own is not None and len(own) > len(track.stamps):
        found.append(Unused(topic, len(own) - len(track.stamps), REASONS["repeated"]))
    if not seen.posed:
        found += [
            Unused(topic, len(stream), f"they are of {named(other)}")
            for other, stream in seen.streams.items()
            if other != pair
        ]
    return found


def unmatched(topic: str, moments: Array, matched: Matched, tolerance: float) -> list[Unused]:
    """Measurements at moments (N,) that have no joint angles."""
    outside = ~matched.usable & np.isinf(matched.gap)
    between = ~matched.usable & np.isfinite(matched.gap)
    found: list[Unused] = []
    if outside.any():
        found.append(
            Unused(topic, int(outside.sum()), "no joint state comes before, or none after them")
        )
    if between.any():
        widest = float(matched.gap[between].max())
        first = float(moments[between][0])
        reason = (
            f"the joint states around them are up to {widest:.3g} s apart, more than the tolerance "
            f"of {tolerance:g} s (the first at {first:.3f} s)"
        )
        found.append(Unused(topic, int(between.sum()), reason))
    return found


def other_topics(topics: Sequence[Topic], used: Collection[str]) -> tuple[Unused, ...]:
    """Topics that were not read."""
    return tuple(
        Unused(topic.name, topic.count, f"{topic.type} is not needed")
        for topic in topics
        if topic.name not in used and topic.count
    )


def named(pair: Pair) -> str:
    """A sighting in words."""
    frame, marker = pair
    return (f"marker {marker} " if marker else "a point ") + f"in frame {frame or '(no name)'}"
