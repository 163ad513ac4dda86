"""The stereo head: range and eccentricity of a point, with noise and distortion (section 3.4.2)."""

from dataclasses import dataclass

import numpy as np

from handeye.arrays import Array, finite, scalar
from handeye.errors import InvalidInput


@dataclass(frozen=True)
class StereoHead:
    """Two cameras side by side that locate a point by range r and eccentricity eps.

    pixel_pitch, focal_length  rho and f [m]; their ratio sets the noise, and 0 pitch means none
    baseline                   distance between the cameras, 2 h [m]
    field_of_view              full angle [rad]
    eccentricity_warp          eta of eq 3.39, astigmatism
    range_warp                 zeta of eq 3.40
    range_scale                factor on every range; may be an array (N,), one for each trial
    """

    pixel_pitch: float = 0.0275e-3
    focal_length: float = 8.0e-3
    baseline: float = 0.5
    field_of_view: float = np.pi / 3.0
    eccentricity_warp: float = 0.0
    range_warp: float = 0.0
    range_scale: float | Array = 1.0

    def __post_init__(self) -> None:
        scalar(self.pixel_pitch, "pixel_pitch", least=0.0)
        for name in ("focal_length", "baseline", "field_of_view"):
            scalar(getattr(self, name), name, above=0.0)
        for name in ("eccentricity_warp", "range_warp"):
            scalar(getattr(self, name), name)
        if not np.all(finite(self.range_scale, "range_scale") > 0.0):
            raise InvalidInput(f"range_scale must be positive, got {self.range_scale}")

    def range_std(self, r: Array, eccentricity: Array) -> Array:
        """Standard deviation of a measured range [m] (eq 3.24)."""
        along = r**2 * np.cos(eccentricity) / self.baseline
        across = r * np.cos(eccentricity) * np.sin(eccentricity)
        return np.hypot(along, across) * self.pixel_pitch / (np.sqrt(6.0) * self.focal_length)

    def eccentricity_std(self, eccentricity: Array) -> Array:
        """Standard deviation of a measured eccentricity [rad] (eq 3.28)."""
        slope = self.pixel_pitch / (2.0 * np.sqrt(6.0) * self.focal_length)
        return np.cos(eccentricity) ** 2 * slope

    def eccentricity_error(self, r: Array, eccentricity: Array) -> Array:
        """Distortion of the eccentricity [rad] (eq 3.39, read as in note E1)."""
        return self.eccentricity_warp * np.sin(eccentricity) ** 2 * (r + 2.0) / (r + 1.0)

    def range_error(self, r: Array, eccentricity: Array) -> Array:
        """Distortion of the range [m] (eq 3.40)."""
        return self.range_warp * (self.eccentricity_error(r, eccentricity) + (r - 1.0) ** 2)

    def measure(self, r: Array, eccentricity: Array, unit_noise: Array) -> tuple[Array, Array]:
        """Measured range and eccentricity of points really at (r, eccentricity), each (...).

        unit_noise (..., 2) is standard normal: range, eccentricity (eq 3.4, 3.5).
        """
        range_measured = (
            self.range_scale * r
            + self.range_error(r, eccentricity)
            + self.range_std(r, eccentricity) * unit_noise[..., 0]
        )
        eccentricity_measured = (
            eccentricity
            + self.eccentricity_error(r, eccentricity)
            + self.eccentricity_std(eccentricity) * unit_noise[..., 1]
        )
        return range_measured, eccentricity_measured
