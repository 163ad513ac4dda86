"""Robots with an error that no model here was made for, to see what calibrators make of it."""

from dataclasses import dataclass, fields

import numpy as np

from handeye.arrays import Array
from handeye.calibration.plant import PlanarPlant


@dataclass(frozen=True)
class Misfit(PlanarPlant):
    """A planar robot with errors that are none of the thesis's.

    gear  eccentric gears that turn three and seven times for one turn of their joint: amplitude of
          the error of alpha and beta, half as much of the faster [rad]
    sag   the second link bends under its own weight, most when it is level, by so much at the hand
          [m]; that depends on both joints together
    kink  two lens elements that do not meet: beyond a range of 1.5 m, angles to the left of the
          axis are seen larger by this share, those to the right smaller
    """

    gear: float = 0.0
    sag: float = 0.0
    kink: float = 0.0

    @classmethod
    def of(
        cls, plant: PlanarPlant, *, gear: float = 0.0, sag: float = 0.0, kink: float = 0.0
    ) -> "Misfit":
        """A plant with these errors besides its own."""
        own = {field.name: getattr(plant, field.name) for field in fields(PlanarPlant)}
        return cls(**own, gear=gear, sag=sag, kink=kink)

    def tips(self, readings: Array) -> Array:
        """As PlanarPlant."""
        turned = readings + self.gear * (
            np.sin(3.0 * readings) + 0.5 * np.sin(7.0 * readings + 1.0)
        )
        level = turned.sum(axis=-1) + self.alpha.offset + self.beta.offset
        fall = -self.sag * np.cos(level)
        return super().tips(turned) + np.stack([np.zeros_like(fall), fall], axis=-1)

    def sight(
        self, tips: Array, eccentricity: Array, unit_noise: Array
    ) -> tuple[Array, Array, Array]:
        """As PlanarPlant."""
        pointing, r, measured = super().sight(tips, eccentricity, unit_noise)
        far = np.hypot(tips[..., 0] - self.v_x, tips[..., 1] - self.v_y) > 1.5
        return pointing, r, measured + self.kink * np.where(far, np.abs(eccentricity), 0.0)
