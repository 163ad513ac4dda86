"""What became of everything in a recording."""

from dataclasses import dataclass, field
from typing import Any

from handeye.arrays import scalar
from handeye.io.bags.delay import Delay
from handeye.io.records import LogReading


@dataclass(frozen=True)
class BagOptions:
    """What a user can say about a recording.

    joints_topic   topic of the joint states; by default the only one that fits
    points_topic   topic of the measurements; by default the only one that fits
    frame          frame of the sensor: the frame of points and poses, the parent of a transform
    marker         what is measured: the child frame of a transform, or the number of an AprilTag
    tolerance      longest time between the joint states on both sides of a measurement [s]
    delay          how much later the measurements' stamps are than the joints' [s]; by default
                   it is estimated
    receipt_times  use the times of receipt instead of the stamps in the messages
    """

    joints_topic: str | None = None
    points_topic: str | None = None
    frame: str | None = None
    marker: str | None = None
    tolerance: float = 0.1
    delay: float | None = None
    receipt_times: bool = False

    def __post_init__(self) -> None:
        scalar(self.tolerance, "tolerance", above=0.0)
        if self.delay is not None:
            scalar(self.delay, "delay")


@dataclass(frozen=True)
class Unused:
    """Messages of a topic that no row of the log was made of, and why."""

    topic: str
    count: int
    reason: str

    def __str__(self) -> str:
        return f"{self.topic}: {self.count} messages not used: {self.reason}"


@dataclass(frozen=True)
class BagReport:
    """Where the rows of a log come from.

    measured      what was measured, in which frame
    oriented      whether the log has the orientation of what was measured
    start         the time in the recording at which the log's clock is 0 [ns]
    tolerance     as in `BagOptions` [s]
    interpolated  how many rows have their joint angles from between two joint states; the others
                  from a single one
    unused        messages of the topics that were read, of which no row was made
    others        the topics that were not read
    damage        where the recording goes wrong; empty for a whole one
    """

    joints_topic: str
    points_topic: str
    measured: str
    oriented: bool
    start: int
    tolerance: float
    delay: Delay
    interpolated: int
    unused: tuple[Unused, ...]
    others: tuple[Unused, ...] = ()
    damage: str = ""

    def lines(self) -> list[str]:
        """For people, one line each."""
        orientation = "" if self.oriented else ", without orientation"
        points = f"{self.measured} from {self.points_topic}{orientation}"
        lines = [
            f"joints from {self.joints_topic}, {points}",
            f"delay of the sensor: {self.delay.status}",
            *(str(unused) for unused in self.unused),
        ]
        if self.others:
            total = sum(other.count for other in self.others)
            lines.append(f"{len(self.others)} other topics ({total} messages) not read")
        return lines + ([self.damage] if self.damage else [])

    def as_data(self) -> dict[str, Any]:
        """For JSON; times in seconds."""
        return {
            "joints_topic": self.joints_topic,
            "points_topic": self.points_topic,
            "measured": self.measured,
            "oriented": self.oriented,
            "start_s": self.start / 1e9,
            "tolerance_s": self.tolerance,
            "delay_s": self.delay.seconds,
            "delay_estimate_s": self.delay.estimate,
            "delay_std_s": self.delay.std,
            "delay_status": self.delay.status,
            "n_interpolated": self.interpolated,
            "unused": [
                {"topic": u.topic, "count": u.count, "reason": u.reason}
                for u in (*self.unused, *self.others)
            ],
            "damage": self.damage,
        }


@dataclass(frozen=True)
class BagReading(LogReading):
    """A log made from a recording; its rows are numbered by measurement, from 1."""

    report: BagReport = field(kw_only=True)
