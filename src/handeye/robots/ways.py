"""The joints between two links of a robot whose links form a tree."""

from typing import NamedTuple, Self


class Way(NamedTuple):
    """From one joint of a tree to another, each given by its number.

    up    joints from the first one's towards the root, as far as where both branches part
    down  joints from there to the second one's
    """

    up: tuple[int, ...]
    down: tuple[int, ...]

    @classmethod
    def between(cls, first: list[int], second: list[int]) -> Self:
        """first, second: the joints from the root to each of both, itself the last."""
        shared = sum(1 for a, b in zip(first, second, strict=False) if a == b)
        return cls(tuple(reversed(first[shared:])), tuple(second[shared:]))

    @property
    def joints(self) -> tuple[int, ...]:
        """All, in order."""
        return self.up + self.down
