"""The single eye of the catching robot (section 4.4.1, Vision)."""

from dataclasses import dataclass

import numpy as np

from handeye.arrays import Array, scalar


@dataclass(frozen=True)
class Retina:
    """Orthographic view of the plane of motion: a square field, the same scale everywhere.

    It looks at right angles to the plane, at its centre. Eye and arm are calibrated, so what it
    reports is in metres in the arm's frame; velocities are signed and linear.

    center_x, center_z  of the field [m]
    width               of the field, and its height [m]
    """

    center_x: float
    center_z: float
    width: float

    def __post_init__(self) -> None:
        scalar(self.center_x, "center_x")
        scalar(self.center_z, "center_z")
        scalar(self.width, "width", above=0.0)

    def sight(self, x: Array, z: Array, vx: Array, vz: Array) -> tuple[Array, Array, Array, Array]:
        """Positions [m] and velocities [m/s] of centroids, each (N,); NaN outside the field."""
        half = 0.5 * self.width
        seen = (np.abs(x - self.center_x) <= half) & (np.abs(z - self.center_z) <= half)
        if seen.all():
            return x, z, vx, vz
        blind = np.where(seen, 0.0, np.nan)
        return x + blind, z + blind, vx + blind, vz + blind
