"""What a predicate over records finds."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from handeye.thesis.records import Records

Limits = Mapping[str, float]


@dataclass(frozen=True)
class Finding:
    """Whether a statement holds.

    held   in which replicates it does
    holds  the verdict over all of them
    note   a sentence with the numbers that decide
    """

    held: tuple[bool, ...]
    holds: bool
    note: str


Shape = Callable[[Records, Limits], Finding]


def in_every_replicate(held: tuple[bool, ...], note: str) -> Finding:
    """A statement that must hold each time."""
    return Finding(held, bool(held) and all(held), note)
