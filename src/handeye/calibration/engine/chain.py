"""A chain of stages from joints to what is measured: what the engine knows of a robot.

The engine learns unknowns x (n,) from observations, each a row of numbers. Everything about the
robot is in a `Chain`: what the unknowns are and how far from nominal they may be, and, as a kind
of NamedTuple for compiled loops, what an observation says about them.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from handeye._compiled import by_kind
from handeye.arrays import Array, Booleans, finite, shaped
from handeye.errors import InvalidInput


class Group(NamedTuple):
    """Unknowns at `places` that belong together, in words: a part that is made, or that slips."""

    words: str
    places: tuple[int, ...]


class Direction(NamedTuple):
    """A change of the unknowns together, (n,) in tolerances, that no observation notices."""

    direction: Array
    words: str


@dataclass(frozen=True, eq=False)
class Chain:
    """Everything that the engine is told about a robot.

    kernel      its kind, a NamedTuple, for `residuals` and `reach`
    names       of the unknowns, n of them; those that may drift steadily first
    units       of the unknowns, as text
    nominal     (n,) where they are expected
    tolerance   (n,) standard deviations of how far from there they may be
    curved      (n,) which belong to learned functions: zero for a robot exactly as it is drawn
    n_moving    unknowns, from the first on, that follow drift from one observation to the next
    n_values    residuals of an observation, k
    n_hand      components of a displacement of the hand, m
    n_seen      numbers of an observation, w
    groups      parts of the robot; every unknown is in one
    changes     what may change of a sudden, each a group that then re-learns
    gauges      directions that no observation notices

    Raises InvalidInput for parts that do not fit together.
    """

    kernel: Any
    names: tuple[str, ...]
    units: tuple[str, ...]
    nominal: Array
    tolerance: Array
    curved: Booleans
    n_moving: int
    n_values: int
    n_hand: int
    n_seen: int
    groups: tuple[Group, ...]
    changes: tuple[Group, ...]
    gauges: tuple[Direction, ...]

    def __post_init__(self) -> None:
        n = len(self.names)
        shaped(self.nominal, (n,), "nominal")
        if not np.all(shaped(self.tolerance, (n,), "tolerance") > 0.0):
            raise InvalidInput("every unknown needs a tolerance above 0")
        if len(self.units) != n or len(self.curved) != n or not 0 < self.n_moving <= n:
            raise InvalidInput(f"names, units, curved and n_moving must fit {n} unknowns")
        placed = sorted(place for group in self.groups for place in group.places)
        if placed != list(range(n)):
            raise InvalidInput("every unknown must be in exactly one group")
        for change in self.changes:
            if not change.places or not set(change.places) <= set(range(n)):
                raise InvalidInput(f"{change.words!r} names no unknowns")
        for gauge in self.gauges:
            finite(gauge.direction, gauge.words)


@by_kind
def residuals(
    kernel: NamedTuple, x: Array, seen: Array, doubt: float, values: Array, slopes: Array
) -> None:
    """Measured minus predicted over standard deviations, and the derivatives by x.

    x (n,) unknowns, seen (w,) an observation, doubt the standard deviation of what the model
    leaves unexplained; values (k,) and slopes (k, n), overwritten.
    """


@by_kind
def reach(kernel: NamedTuple, x: Array, seen: Array, doubt: float, out: Array) -> None:
    """out (m, k), overwritten: the hand's displacement [m] by each residual.

    Were the robot to act on the sighting `seen`, residuals r would show that it misses by out r.
    """
