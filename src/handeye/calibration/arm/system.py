"""Equations in unknowns, as a fit reads them."""

from collections.abc import Iterator
from typing import NamedTuple, Protocol

from handeye.arrays import Array, Booleans, Integers


class Rows(NamedTuple):
    """Some rows of a system, linearised.

    residuals (M, k) measured minus predicted, slopes (M, k, n) their derivatives by the unknowns,
    std (M, k) as stated, channels (k,) of the values, first: number of the first row.
    """

    residuals: Array
    slopes: Array
    std: Array
    channels: Integers
    first: int


class System(Protocol):
    """Equations in n unknowns, nominally 0."""

    @property
    def tolerance(self) -> Array:
        """(n,) standard deviations of the priors, as stated."""
        ...

    @property
    def groups(self) -> Integers:
        """(n,) numbers from 0 of what shares a width, or -1 where it is as stated."""
        ...

    @property
    def shown(self) -> Booleans:
        """(n,) unknowns that so many rows can show; the others stay 0."""
        ...

    @property
    def n_rows(self) -> int:
        """Of equations."""
        ...

    @property
    def n_channels(self) -> int:
        """Of noise."""
        ...

    def rows(self, x: Array, *, slopes: bool = True) -> Iterator[Rows]:
        """All equations at x (n,), some rows at a time; without `slopes` these are empty."""
        ...
