"""What an instrument says of an arm: the form that every kind of measurement takes in a fit."""

from dataclasses import dataclass
from typing import NamedTuple, Protocol

from handeye.arrays import Array, finite
from handeye.errors import InvalidInput


@dataclass(frozen=True, eq=False)
class Block:
    """Unknowns beside those of the arm: a frame, a point, a lens. All are nominally 0.

    Measurements that share a block, by its name, share its unknowns.

    name        in words, "tracker"; no other block of a fit has it
    names       of its unknowns, m of them
    units       of its unknowns: "m", "rad", "px" or ""
    tolerance   (m,) standard deviations of how far from 0 they may be

    Raises InvalidInput for parts that do not fit together.
    """

    name: str
    names: tuple[str, ...]
    units: tuple[str, ...]
    tolerance: Array

    def __post_init__(self) -> None:
        std = finite(self.tolerance, f"tolerance of {self.name}")
        object.__setattr__(self, "tolerance", std)
        if not len(self.names) == len(self.units) == len(std):
            raise InvalidInput(
                f"{self.name}: names, units and tolerance must be as many, got "
                f"{len(self.names)}, {len(self.units)} and {len(std)}"
            )
        if not (std > 0.0).all():
            raise InvalidInput(f"{self.name}: every unknown needs a tolerance above 0")


class Equations(NamedTuple):
    """N rows of k values, linearised.

    residuals  (N, k) measured minus predicted
    by_flange  (N, k, 6) their derivatives by the flange's pose: shift of its origin [m] and turn
               about it [rad], in axes of the base
    by_blocks  (N, k, m) for each block of the measurement
    """

    residuals: Array
    by_flange: Array
    by_blocks: tuple[Array, ...]


class Measurement(Protocol):
    """N rows of what one instrument said, k values each."""

    @property
    def joints(self) -> Array:
        """(N, n) encoder readings [rad] or [m], of the joints between `base` and `link`."""
        ...

    @property
    def link(self) -> str | None:
        """The link of the flange, that of the arm unless another one is named."""
        ...

    @property
    def base(self) -> str | None:
        """The link of the base, likewise."""
        ...

    @property
    def blocks(self) -> tuple[Block, ...]:
        """What else is unknown."""
        ...

    @property
    def channels(self) -> tuple[str, ...]:
        """For each of the k values what it is part of, "position": what errs alike, and together.

        The noise of a channel is found in the fit, and a row is believed or not by channels.
        """
        ...

    @property
    def std(self) -> Array:
        """(N, k) standard deviations as stated; 0 where nothing is stated."""
        ...

    def equations(self, flanges: Array, own: tuple[Array, ...]) -> Equations:
        """At T_base_flange (N, 4, 4) and values of the blocks, (m,) each."""
        ...
