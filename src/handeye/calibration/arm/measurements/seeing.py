"""What all kinds of measurement share in which a point of a target is seen, touched or reached."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any, Self, TypeVar

import numpy as np

from handeye.arrays import Array, Integers, finite, shaped
from handeye.calibration.arm.measurement import Block, Equations
from handeye.calibration.arm.measurements.sight import Sight
from handeye.calibration.arm.measurements.unknowns import (
    Unknown,
    blocks_of,
    free_of,
    wholes_of,
)
from handeye.errors import InvalidInput
from handeye.robots.urdf import UrdfArm

Given = TypeVar("Given", bound="Instrument | Sight")

UNITS = {
    "position": "m", "orientation": "rad", "pixels": "px", "contact": "m", "distance": "m",
    "height": "m", "range": "m", "eccentricity": "rad",
}  # fmt: skip
"""Of each kind of value."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Instrument(ABC):
    """N rows of k values; a `Measurement`.

    joints  (N, n) encoder readings [rad] or [m], of the joints between `base` and `link`
    sight   instrument, target and the point of each row
    std     standard deviations of the values as stated, (N, k), (k,) or one; 0: not stated
    name    of the instrument; the noise of one is not that of another. May be empty.
    link    the link that is the flange here, "left_hand"; None for that of the arm that is fitted
    base    the link that is the base here, "head"; None likewise

    Raises InvalidInput for arrays that do not fit together, and two unknowns of one name.
    """

    joints: Array
    sight: Sight
    std: Array = field(default_factory=lambda: np.zeros(1))
    name: str = ""
    link: str | None = None
    base: str | None = None

    @property
    @abstractmethod
    def kinds(self) -> tuple[str, ...]:
        """(k,) what each value is part of: "position"."""

    @property
    def others(self) -> tuple[Unknown, ...]:
        """What else the values depend on."""
        return ()

    @property
    def unknowns(self) -> tuple[Unknown, ...]:
        """All that may be unknown, whether it is or not: instrument, target, points, others."""
        return (*self.sight.unknowns, *self.others)

    @abstractmethod
    def equations(self, flanges: Array, own: tuple[Array, ...]) -> Equations:
        """Measured minus predicted at T_base_flange (N, 4, 4) and values of the blocks."""

    def __post_init__(self) -> None:
        joints = shaped(self.joints, (None, None), f"joints of {self.what}")
        shape = (len(joints), len(self.kinds))
        try:
            std = np.broadcast_to(finite(self.std, f"std of {self.what}"), shape)
        except ValueError:
            raise InvalidInput(
                f"std of {self.what} must have shape {shape}, ({shape[1]},) or be one number, got "
                f"{np.shape(self.std)}"
            ) from None
        if np.any(std < 0.0):
            raise InvalidInput(f"std of {self.what} must be at least 0 (0: not stated)")
        names = [block.name for block in self.blocks]
        if len(set(names)) < len(names):
            raise InvalidInput(
                f"{self.what}: its unknowns need different names, got {', '.join(names)}"
            )
        if len(self.sight.which) != len(joints):
            raise InvalidInput(
                f"{self.what}: {len(joints)} rows of joints do not pair up with "
                f"{len(self.sight.which)} points that are seen"
            )
        object.__setattr__(self, "joints", joints)
        object.__setattr__(self, "std", std)

    @property
    def what(self) -> str:
        """The name, or that of its kind."""
        return self.name or type(self).__name__

    @property
    def blocks(self) -> tuple[Block, ...]:
        """Of the unknowns that are not known."""
        return blocks_of(self.unknowns)

    @property
    def channels(self) -> tuple[str, ...]:
        """(k,) kinds of values, of this instrument."""
        return tuple(f"{kind} of {self.name}" if self.name else kind for kind in self.kinds)

    @property
    def units(self) -> tuple[str, ...]:
        """(k,) of the values."""
        return tuple(UNITS[kind] for kind in self.kinds)

    def moved(self, changes: Mapping[str, Array]) -> Self:
        """With the references of its unknowns changed by values of their blocks, by name."""
        return self.given(
            {
                unknown.name: unknown.moved(unknown.whole(changes[unknown.name]))
                for unknown in self.unknowns
                if unknown.free.any() and unknown.name in changes
            }
        )

    def given(self, others: Mapping[str, Unknown]) -> Self:
        """With other unknowns in the place of those of the same name.

        Raises:
            InvalidInput: for a frame in the place of points, or the like.
        """
        return _given(self, others)

    def along(self, chain: UrdfArm) -> Self:
        """With the ends of a chain through the arm, whose joints are those of the rows."""
        return replace(self, link=chain.tip, base=chain.base)

    def only(self, rows: Integers) -> Self:
        """Some of the rows."""
        n = len(self.joints)
        new: dict[str, Any] = {}
        for one in fields(self):
            part: Any = getattr(self, one.name)
            if isinstance(part, Sight):
                new[one.name] = replace(part, which=part.which[rows])
            elif np.shape(part)[:1] == (n,):
                new[one.name] = part[rows]
        return replace(self, **new)

    def folds(self, count: int) -> Integers:
        """(N,) which of `count` blocks of rows that follow each other a row is in.

        Rows at the same joints, such as the points of one picture, are in the same block.
        """
        return in_turn(self.joints, count)


@dataclass(frozen=True, eq=False, kw_only=True)
class PointInstrument(Instrument):
    """Values that depend on where a point is in the instrument's frame.

    measured  (N, k)
    """

    measured: Array

    def __post_init__(self) -> None:
        super().__post_init__()
        shape = (len(self.joints), len(self.kinds))
        measured = shaped(self.measured, shape, f"measured of {self.what}")
        object.__setattr__(self, "measured", measured)

    @abstractmethod
    def values(self, s: Array, others: list[Array]) -> tuple[Array, Array, list[Array]]:
        """Values (N, k) at points s (N, 3) and components of the others; derivatives.

        By s (N, k, 3), and by each of the others (N, k, m).
        """

    def equations(self, flanges: Array, own: tuple[Array, ...]) -> Equations:
        """As declared."""
        sensor, target, points, *others = wholes_of(self.unknowns, own)
        seen = self.sight.look(flanges, sensor, target, points)
        values, by_s, by_others = self.values(seen.s, others)
        slopes = [by_s @ part for part in (seen.by_sensor, seen.by_target, seen.by_points)]
        slopes = [-slope for slope in (*slopes, *by_others)]
        return Equations(
            self.measured - values, -by_s @ seen.by_flange, free_of(self.unknowns, slopes)
        )


def in_turn(joints: Array, count: int) -> Integers:
    """(N,) numbers 0 to count - 1, in blocks of nearly as many different joints (N, n)."""
    _, first, which = np.unique(joints, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(np.argsort(first))
    return order[which.reshape(-1)] * count // max(len(first), 1)


def _given(thing: Given, others: Mapping[str, Unknown]) -> Given:
    new: dict[str, object] = {}
    for one in fields(thing):
        value = getattr(thing, one.name)
        if isinstance(value, Sight):
            new[one.name] = _given(value, others)
        elif isinstance(value, Unknown) and (other := others.get(value.name)) is not None:
            if len(other.components) != len(value.components) or type(other) is not type(value):
                raise InvalidInput(
                    f"{value.name} is used as two things: {_told(other)} and {_told(value)}; give "
                    "one of them another name"
                )
            new[one.name] = other
    return replace(thing, **new)


def _told(unknown: Unknown) -> str:
    return f"{type(unknown).__name__.lower()} with {len(unknown.components)} components"
