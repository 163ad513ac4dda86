"""What the comparator noticed."""

from dataclasses import dataclass
from typing import Literal

Kind = Literal["outlier", "change", "drift", "steady", "lost", "fallback", "recovered", "network"]


@dataclass(frozen=True)
class Event:
    """Something that was noticed while observations came in.

    observation  its number, from 0
    kind         what it was
    part         the part of the robot, in words; empty where it concerns all of it
    amount       by how much its most changed unknown changed, with standard deviation `std`, in
                 `unit`; 0 where nothing changed
    unknown      the name of that unknown
    done         what was done about it
    """

    observation: int
    kind: Kind
    part: str
    done: str
    amount: float = 0.0
    std: float = 0.0
    unit: str = ""
    unknown: str = ""

    def __str__(self) -> str:
        """One line for a log."""
        change = ""
        if self.unknown:
            change = f" by {self.amount:+.3g} +- {self.std:.2g} {self.unit}".rstrip()
            change += f" ({self.unknown})"
        part = f" of {self.part}" if self.part else ""
        return f"observation {self.observation}: {self.kind}{part}{change}; {self.done}"
