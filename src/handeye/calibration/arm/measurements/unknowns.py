"""What a measurement does not know: frames, points, numbers, each a reference and a change."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, Booleans, finite, shaped
from handeye.calibration.arm.measurement import Block
from handeye.calibration.hand_eye.turns import left_jacobian, turn
from handeye.errors import InvalidInput
from handeye.geometry import make_pose, wxyz_from_matrix

_SHIFT, _TURN = 0.1, 0.2
"""How far a frame may be from where it is put at first [m], [rad]."""


@dataclass(frozen=True, eq=False)
class Unknown(ABC):
    """Something with m components, each of which is known or free.

    name       in words, "camera": what has the same name in several measurements is the same
    tolerance  (m,) standard deviations of how far each component may be from its reference; what
               has 0 is known

    Raises InvalidInput for a tolerance below 0 or of another length.
    """

    name: str
    tolerance: Array

    @property
    @abstractmethod
    def components(self) -> tuple[tuple[str, str], ...]:
        """Name and unit of each of the m components."""

    @abstractmethod
    def moved(self, x: Array) -> Self:
        """The same with its reference changed by x (m,)."""

    def __post_init__(self) -> None:
        std = shaped(self.tolerance, (len(self.components),), f"tolerance of {self.name}")
        if np.any(std < 0.0):
            raise InvalidInput(f"{self.name}: a tolerance must be at least 0 (0: known), got {std}")
        object.__setattr__(self, "tolerance", std)

    @property
    def free(self) -> Booleans:
        """(m,) which components are to be found."""
        return self.tolerance > 0.0

    @property
    def block(self) -> Block | None:
        """The free components, None where all is known."""
        free = np.flatnonzero(self.free)
        if not free.size:
            return None
        names, units = zip(*(self.components[i] for i in free), strict=True)
        labels = tuple(f"{self.name} {name}" for name in names)
        return Block(self.name, labels, units, self.tolerance[free])

    def held(self) -> Self:
        """The same, as if it were known."""
        return replace(self, tolerance=np.zeros(len(self.tolerance)))

    def whole(self, own: Array) -> Array:
        """All components (m,) of changes of the free ones."""
        out = np.zeros(len(self.tolerance))
        out[self.free] = own
        return out


_POSE = (
    ("x", "m"), ("y", "m"), ("z", "m"), ("rx", "rad"), ("ry", "rad"), ("rz", "rad"),
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Frame(Unknown):
    """A frame at T = reference E(x): E(t, r) shifts by t, then turns by exp([r]x).

    reference  (4, 4) pose in the frame that carries it; tolerance (6,): shift [m], turn [rad]

    Raises InvalidInput also for a reference that is no pose.
    """

    reference: Array = field(default_factory=lambda: np.eye(4))

    def __post_init__(self) -> None:
        super().__post_init__()
        T = shaped(self.reference, (4, 4), f"reference of {self.name}")
        wxyz_from_matrix(T[:3, :3])
        object.__setattr__(self, "reference", T)

    @classmethod
    def known(cls, name: str = "where it is fixed", reference: ArrayLike | None = None) -> Self:
        """A frame of which nothing is to be found; by default the one that carries it."""
        return cls(name, np.zeros(6), np.eye(4) if reference is None else finite(reference, name))

    @classmethod
    def near(
        cls, name: str, reference: ArrayLike, shift: float = _SHIFT, turn: float = _TURN
    ) -> Self:
        """A frame to be found, about where a start puts it; a tolerance of 0 keeps that part."""
        return cls(name, np.repeat([shift, turn], 3), finite(reference, name))

    @property
    def components(self) -> tuple[tuple[str, str], ...]:
        """Shift, then turn."""
        return _POSE

    def pose(self, x: Array) -> Array:
        """T (4, 4) at x (6,)."""
        return self.reference @ make_pose(turn(x[3:]), x[:3])

    def ways(self, x: Array) -> Array:
        """(6, 6): how T's origin shifts [m] and T turns about it [rad] with x, in outer axes."""
        R, out = self.reference[:3, :3], np.zeros((6, 6))
        out[:3, :3] = R
        out[3:, 3:] = R @ left_jacobian(x[3:])
        return out

    def moved(self, x: Array) -> Self:
        """With the reference at x."""
        return replace(self, reference=self.pose(x))


@dataclass(frozen=True, eq=False)
class Points(Unknown):
    """P points in a frame: c = reference + x, known, roughly known (a printed board) or free.

    reference (P, 3) [m]; tolerance (3 P,) [m].
    """

    reference: Array = field(default_factory=lambda: np.zeros((1, 3)))

    def __post_init__(self) -> None:
        places = shaped(self.reference, (None, 3), f"points of {self.name}")
        if not len(places):
            raise InvalidInput(f"{self.name}: give at least one point")
        object.__setattr__(self, "reference", places)
        super().__post_init__()

    @classmethod
    def known(cls, name: str = "origin", reference: ArrayLike = ((0.0, 0.0, 0.0),)) -> Self:
        """Points of known geometry; by default the origin of their frame."""
        return cls.near(name, reference, 0.0)

    @classmethod
    def near(
        cls, name: str, reference: ArrayLike = ((0.0, 0.0, 0.0),), tolerance: float = _SHIFT
    ) -> Self:
        """Points within a tolerance [m] of their reference (P, 3)."""
        places = shaped(reference, (None, 3), name)
        return cls(name, np.full(3 * len(places), float(tolerance)), places)

    @property
    def components(self) -> tuple[tuple[str, str], ...]:
        """x, y and z of each."""
        n = len(self.reference)
        return tuple(
            (axis if n == 1 else f"point {i + 1} {axis}", "m") for i in range(n) for axis in "xyz"
        )

    def places(self, x: Array) -> Array:
        """c (P, 3) at x (3 P,)."""
        return self.reference + x.reshape(-1, 3)

    def moved(self, x: Array) -> Self:
        """With the reference at x."""
        return replace(self, reference=self.places(x))


@dataclass(frozen=True, eq=False)
class Numbers(Unknown):
    """m numbers of an instrument, reference + x: a lens, the zero of a wire.

    reference (m,); labels (m,): name and unit of each.
    """

    reference: Array
    labels: tuple[tuple[str, str], ...]

    def __post_init__(self) -> None:
        super().__post_init__()
        numbers = shaped(self.reference, (len(self.labels),), f"numbers of {self.name}")
        object.__setattr__(self, "reference", numbers)

    @property
    def components(self) -> tuple[tuple[str, str], ...]:
        """As labelled."""
        return self.labels

    def moved(self, x: Array) -> Self:
        """With the reference at x."""
        return replace(self, reference=self.reference + x)


def blocks_of(unknowns: Sequence[Unknown]) -> tuple[Block, ...]:
    """The blocks of those that are not known, in order."""
    return tuple(block for unknown in unknowns if (block := unknown.block) is not None)


def wholes_of(unknowns: Sequence[Unknown], own: Sequence[Array]) -> list[Array]:
    """All components of each, from the values of the blocks."""
    values = iter(own)
    return [
        unknown.whole(next(values) if unknown.free.any() else np.zeros(0)) for unknown in unknowns
    ]


def free_of(unknowns: Sequence[Unknown], slopes: Sequence[Array]) -> tuple[Array, ...]:
    """Of derivatives (..., m) by all components, those by the blocks."""
    return tuple(
        slope[..., unknown.free]
        for unknown, slope in zip(unknowns, slopes, strict=True)
        if unknown.free.any()
    )
