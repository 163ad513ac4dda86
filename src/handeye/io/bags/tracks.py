"""Readings and sightings gathered from messages, put in the order of their stamps."""

from array import array
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from handeye.arrays import Array, Integers
from handeye.io.bags.messages import JointReading, Sighting

Fault = Literal["decoded", "stamped", "finite", "repeated"]
"""What messages that are dropped while gathering are not; or that they repeat a stamp."""


@dataclass
class Stream:
    """Numbers of `width` each, as they came: stamps and times of receipt [ns]."""

    width: int
    stamps: "array[int]" = field(default_factory=lambda: array("q"))
    received: "array[int]" = field(default_factory=lambda: array("q"))
    values: "array[float]" = field(default_factory=lambda: array("d"))

    def add(self, stamp: int, received: int, values: Iterable[float]) -> None:
        """Take one."""
        self.stamps.append(stamp)
        self.received.append(received)
        self.values.extend(values)

    def __len__(self) -> int:
        return len(self.stamps)


class Track(NamedTuple):
    """Numbers in the order of their stamps, none of which repeats.

    stamps   (M,) [ns]
    values   (M, width)
    numbers  (M,) which of the stream each was, from 1
    lag      median time from stamp to receipt [ns]
    """

    stamps: Integers
    values: Array
    numbers: Integers
    lag: int

    @classmethod
    def of(cls, stream: Stream) -> "Track":
        """The stream in order; of equal stamps the first."""
        stamps = np.array(stream.stamps, dtype=np.int64)
        values = np.array(stream.values, dtype=np.float64).reshape(len(stream), stream.width)
        _, first = np.unique(stamps, return_index=True)
        lag = np.median(np.array(stream.received, dtype=np.int64) - stamps) if len(stream) else 0
        return cls(stamps[first], values[first], first.astype(np.int64) + 1, int(lag))


@dataclass
class Joints:
    """Joint readings, one stream for each set of joints that is reported together."""

    streams: dict[tuple[str, ...], Stream] = field(default_factory=dict[tuple[str, ...], Stream])
    faults: Counter[Fault] = field(default_factory=Counter[Fault])

    def add(self, reading: JointReading | None, received: int) -> None:
        """Take a reading, or note what is wrong with it."""
        if reading is None:
            self.faults["decoded"] += 1
        elif not reading.stamp:
            self.faults["stamped"] += 1
        elif not np.isfinite(reading.positions).all():
            self.faults["finite"] += 1
        elif reading.names:
            stream = self.streams.setdefault(reading.names, Stream(len(reading.names)))
            stream.add(reading.stamp, received, reading.positions)

    @property
    def names(self) -> tuple[str, ...]:
        """Every joint, in the order of its first appearance."""
        return tuple(dict.fromkeys(name for names in self.streams for name in names))

    def tracks(self, wanted: Sequence[str]) -> list[tuple[tuple[str, ...], Track]]:
        """Joints of `wanted` that are reported together, with their angles in order."""
        sources: dict[tuple[tuple[str, ...], ...], list[str]] = {}
        for joint in wanted:
            reporting = tuple(names for names in self.streams if joint in names)
            sources.setdefault(reporting, []).append(joint)
        return [
            (tuple(joints), self._merged(reporting, joints))
            for reporting, joints in sources.items()
        ]

    def _merged(self, reporting: Sequence[tuple[str, ...]], joints: Sequence[str]) -> Track:
        merged = Stream(len(joints))
        for names in reporting:
            stream, columns = self.streams[names], [names.index(joint) for joint in joints]
            table = np.array(stream.values, dtype=np.float64).reshape(len(stream), -1)
            merged.stamps.extend(stream.stamps)
            merged.received.extend(stream.received)
            merged.values.frombytes(np.ascontiguousarray(table[:, columns]).tobytes())
        track = Track.of(merged)
        self.faults["repeated"] += len(merged) - len(track.stamps)
        return track


@dataclass
class Sightings:
    """Sightings by frame and marker.

    posed   whether a sighting needs an orientation
    fixed   transforms that hold for good, by parent and child: x, y, z, w, x, y, z
    blank   messages in which nothing was seen
    """

    posed: bool = False
    streams: dict[tuple[str, str], Stream] = field(default_factory=dict[tuple[str, str], Stream])
    fixed: dict[tuple[str, str], tuple[float, ...]] = field(
        default_factory=dict[tuple[str, str], tuple[float, ...]]
    )
    faults: Counter[Fault] = field(default_factory=Counter[Fault])
    blank: int = 0

    def add(self, found: Sequence[Sighting] | None, received: int) -> None:
        """Take what a message has seen, or note what is wrong with it."""
        if found is None:
            self.faults["decoded"] += 1
            return
        self.blank += not found
        for seen in found:
            if not seen.stamp:
                self.faults["stamped"] += 1
                continue
            if self.posed and not np.isfinite(seen.pose).all():
                self.faults["finite"] += 1
                continue
            stream = self.streams.setdefault((seen.frame, seen.marker), Stream(7))
            stream.add(seen.stamp, received, seen.pose)

    def fix(self, found: Sequence[Sighting] | None) -> None:
        """Take transforms that hold for good; the last of each counts."""
        for seen in found or ():
            if not np.isfinite(seen.pose).all():
                self.faults["finite"] += 1
                continue
            self.fixed[seen.frame, seen.marker] = seen.pose


def seconds(stamps: NDArray[np.int64], start: int) -> Array:
    """Stamps [ns] as seconds since `start` [ns], to the nanosecond for years."""
    return (stamps - start) / 1e9
