"""The kinematic parameters of a planar robot as a vector, and how well they are known at first."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from handeye.arrays import Array, Integers, finite, scalar
from handeye.calibration.plant import PlanarPlant
from handeye.errors import InvalidInput
from handeye.robots.planar import TwoLinkArm

NAMES = ("a", "b", "v_x", "v_y", "O_alpha", "O_beta", "O_gamma", "range_scale")
"""Order of every parameter vector (8,): metres, radians, and a number."""

THESIS = ("a", "b", "v_x", "v_y", "O_beta", "O_gamma")
"""What is left free when O_alpha = 0 says what the base's x-axis is (table 3.1).

Enough to explain any offset of alpha (the eye and its bearings turn about the arm's base instead)
and any range scale (all lengths grow with it).
"""


@dataclass(frozen=True)
class Tolerances:
    """How far actual parameters may lie from nominal ones: standard deviations.

    link         of a and b [m]
    eye          of v_x and v_y [m]
    offset       of O_alpha, O_beta and O_gamma [rad]
    range_scale  a number

    The defaults are those of a robot put together with a tape measure and a protractor.
    """

    link: float = 0.02
    eye: float = 0.05
    offset: float = 0.1
    range_scale: float = 0.05

    def __post_init__(self) -> None:
        for name in ("link", "eye", "offset", "range_scale"):
            scalar(getattr(self, name), f"tolerance {name}", above=0.0)

    def std(self) -> Array:
        """Of every parameter (8,)."""
        eye, link, offset = [self.eye] * 2, [self.link] * 2, [self.offset] * 3
        return np.array([*link, *eye, *offset, self.range_scale])


def indices(free: Iterable[str]) -> Integers:
    """Places of named parameters in the vector, ascending.

    Raises:
        InvalidInput: none, an unknown name, or one named twice.
    """
    names = list(free)
    unknown = [name for name in names if name not in NAMES]
    if unknown or not names or len(set(names)) < len(names):
        raise InvalidInput(
            f"free parameters must be some of {', '.join(NAMES)}, each once, got {names}"
        )
    return np.array(sorted(NAMES.index(name) for name in names), np.int64)


def vector(plant: PlanarPlant) -> Array:
    """The parameters (8,) of a plant; raises InvalidInput for one that drifts."""
    parts = (
        plant.arm.a,
        plant.arm.b,
        plant.v_x,
        plant.v_y,
        plant.alpha.offset,
        plant.beta.offset,
        plant.gamma.offset,
        plant.head.range_scale,
    )
    for part, name in zip(parts, NAMES, strict=True):
        if np.ndim(part):
            raise InvalidInput(
                f"{name} of the nominal plant changes from trial to trial: give one number; a "
                "Recursive estimator follows what drifts"
            )
    return finite([float(part) for part in parts], "parameters")


def plant_with(nominal: PlanarPlant, parameters: Array) -> PlanarPlant:
    """The nominal plant with parameters (8,)."""
    a, b, v_x, v_y, alpha, beta, gamma, scale = parameters.tolist()
    return replace(
        nominal,
        arm=TwoLinkArm(a, b),
        v_x=v_x,
        v_y=v_y,
        alpha=replace(nominal.alpha, offset=alpha),
        beta=replace(nominal.beta, offset=beta),
        gamma=replace(nominal.gamma, offset=gamma),
        head=replace(nominal.head, range_scale=scale),
    )
