"""The space of a network's inputs, and the units in which distances in it are measured."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, finite, shaped
from handeye.errors import InvalidInput
from handeye.networks.units import LARGEST, moderate


@dataclass(frozen=True, eq=False)
class InputSpace:
    """A box and one scale per input; two inputs lie |(x - y) / scales| apart.

    low, high   corners of the box that inputs usually lie in, (d,), in input units. Inputs may
                leave it: it only sets the diameter and where grids are laid.
    scales      (d,), in input units: a difference of one scale counts as a distance of one.
                With scales (rad, rad, m) of (1, 1, 0.5), half a metre weighs as much as a radian.

    Raises InvalidInput if the box is empty in a direction, a scale is not positive, or the box is
    smaller or larger in scaled units than double precision can square.
    """

    low: Array
    high: Array
    scales: Array

    def __post_init__(self) -> None:
        n = finite(self.low, "low").size
        for name in ("low", "high", "scales"):
            array = shaped(getattr(self, name), (n,), name).copy()
            array.setflags(write=False)
            object.__setattr__(self, name, array)
        if n == 0 or not np.all(self.high > self.low):
            raise InvalidInput(
                f"the input box must have high > low for every input, got {self.low} to {self.high}"
            )
        if not np.all(self.scales > 0.0):
            raise InvalidInput(f"scales must be positive, got {self.scales}")
        with np.errstate(over="ignore"):
            diameter = self.diameter
        if not 1.0 / LARGEST <= diameter <= LARGEST:
            raise InvalidInput(f"the box measures {diameter} scales across: scale it to about one")

    @classmethod
    def box(cls, low: ArrayLike, high: ArrayLike, *, unit: bool = False) -> "InputSpace":
        """Distances in raw input units, as in the thesis; with `unit` every side counts as one."""
        corner = finite(low, "low")
        other = shaped(high, corner.shape, "high")
        return cls(corner, other, other - corner if unit else np.ones_like(corner))

    @classmethod
    def scaled(cls, scales: ArrayLike) -> "InputSpace":
        """Inputs that each span about one scale, anywhere."""
        spans = finite(scales, "scales")
        return cls(np.zeros_like(spans), spans, spans)

    @classmethod
    def of_arrays(cls, arrays: dict[str, Array]) -> "InputSpace":
        """The space of `arrays`; other entries do not matter."""
        return cls(arrays["low"], arrays["high"], arrays["scales"])

    @property
    def arrays(self) -> dict[str, Array]:
        """Low, high and scales by name, to be stored."""
        return {"low": self.low, "high": self.high, "scales": self.scales}

    @property
    def n_inputs(self) -> int:
        """d."""
        return self.low.size

    @property
    def diameter(self) -> float:
        """D: length of the diagonal of the box, in scaled units."""
        return float(np.linalg.norm((self.high - self.low) / self.scales))

    def of(self, n_inputs: int) -> Self:
        """Itself; InvalidInput unless it has so many inputs."""
        if self.n_inputs != n_inputs:
            raise InvalidInput(f"inputs describes {self.n_inputs} inputs, not {n_inputs}")
        return self

    def scaled_inputs(self, x: Array) -> Array:
        """Inputs x (N, d) in scaled units; InvalidInput if one is too far away to be squared."""
        with np.errstate(over="ignore"):
            return moderate(x / self.scales, "inputs over scales")

    def __repr__(self) -> str:
        """The constructor's call."""
        low, high, scales = (np.array2string(a, separator=", ", precision=4)
                             for a in (self.low, self.high, self.scales))  # fmt: skip
        return f"InputSpace(low={low}, high={high}, scales={scales})"
