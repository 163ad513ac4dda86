"""Plants that change while the robot works (section 3.5.7)."""

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from handeye.arrays import Array, Integers
from handeye.calibration.plant import PlanarPlant
from handeye.errors import InvalidInput
from handeye.robots.encoder import AxisEncoder
from handeye.robots.planar import TwoLinkArm

Trials = int | Integers
"""One trial number, or one for each of N observations."""


class Drift(Protocol):
    """Says what a plant has become."""

    def __call__(self, plant: PlanarPlant, trial: Trials) -> PlanarPlant:
        """The plant at a trial or at each of trials (N,), counted from 0."""
        ...


def steady(plant: PlanarPlant, trial: Trials) -> PlanarPlant:
    """No drift."""
    return plant


def _shifted(encoder: AxisEncoder, by: Array) -> AxisEncoder:
    return replace(encoder, offset=encoder.offset + by)


@dataclass(frozen=True)
class OffsetStep:
    """An encoder slips, or a link yields in a collision: its offset jumps by `size` [rad].

    axis is "alpha", "beta" or "gamma"; the jump is there from trial `at` on.
    """

    axis: str
    size: float
    at: int

    def __call__(self, plant: PlanarPlant, trial: Trials) -> PlanarPlant:
        """The plant with the offset it has at each trial."""
        jump = np.where(np.asarray(trial) >= self.at, self.size, 0.0)
        return replace(plant, **{self.axis: _shifted(getattr(plant, self.axis), jump)})


@dataclass(frozen=True)
class Thermal:
    """Sun on one side of arm and eye, coming and going with a period of so many trials.

    Lengths are multiplied by `1 + expansion sin(phase)` (eq 3.97, 3.98). Offsets of the arm's
    encoders grow by `bend sin(phase)`, that of the pointing encoder falls by as much, the range
    scale grows by `scale sin(phase)` and v_y by the displacement of the eye's base when it turns
    by bend clockwise around the arm's base (eq 3.99). phase = 2 pi trial / period + `phase_shift`.

    expansion  expansion coefficient times temperature amplitude; default aluminium and 50 deg C
    bend       [rad]; default one degree
    """

    period: float
    expansion: float = 26e-6 * 50.0
    bend: float = np.pi / 180.0
    scale: float = 0.02
    phase_shift: float = 0.0

    def __post_init__(self) -> None:
        # An endless period stays at its phase.
        if not self.period > 0.0:
            raise InvalidInput(f"period must be positive, got {self.period}")

    def __call__(self, plant: PlanarPlant, trial: Trials) -> PlanarPlant:
        """The plant at each trial."""
        wave = np.sin(2.0 * np.pi * np.asarray(trial) / self.period + self.phase_shift)
        grow = 1.0 + self.expansion * wave
        # Turning clockwise moves a base at (v_x, 0) by -v_x * angle in y.
        eye_lift = -np.asarray(plant.v_x) * self.bend * wave
        return replace(
            plant,
            arm=TwoLinkArm(plant.arm.a * grow, plant.arm.b * grow),
            v_x=plant.v_x * grow,
            v_y=plant.v_y * grow + eye_lift,
            alpha=_shifted(plant.alpha, self.bend * wave),
            beta=_shifted(plant.beta, self.bend * wave),
            gamma=_shifted(plant.gamma, -self.bend * wave),
            head=replace(plant.head, range_scale=plant.head.range_scale + self.scale * wave),
        )
