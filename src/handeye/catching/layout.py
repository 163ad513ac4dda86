"""Where everything happens: figure 4.1, whose dimensions are lost (note E9), in one place."""

from dataclasses import dataclass, fields

import numpy as np

from handeye.arrays import scalar, shaped
from handeye.errors import InvalidInput

GRAVITY = 9.81
"""[m/s^2]"""

Interval = tuple[float, float]


@dataclass(frozen=True)
class Cup:
    """What catches: a floor in the plane z = 0 between two thin walls (section 4.4.1).

    width          between the walls [m]
    height         of the walls above the floor [m]
    damping_ratio  zeta of a rebound from its outside and from the ground, see `restitution`
    """

    width: float = 0.2
    height: float = 0.08
    damping_ratio: float = 0.07

    def __post_init__(self) -> None:
        scalar(self.width, "width", above=0.0)
        scalar(self.height, "height", above=0.0)
        if not 0.0 <= scalar(self.damping_ratio, "damping_ratio") < 1.0:
            raise InvalidInput(
                f"damping_ratio must be from 0 to below 1 (underdamped), got {self.damping_ratio}"
            )

    @property
    def restitution(self) -> float:
        """Speed after an underdamped contact over the speed before it.

        A mass on a spring and damper leaves after half a period with exp(-pi zeta / sqrt(1 -
        zeta^2)) of its speed; stiff contacts last no time. The default 0.80 is a rubber ball on a
        hard floor.
        """
        zeta = self.damping_ratio
        return float(np.exp(-np.pi * zeta / np.sqrt(1.0 - zeta**2)))


@dataclass(frozen=True)
class Layout:
    """The catching place, in the vertical plane x, z with the ground at z = 0 (figure 4.1).

    The drawing is lost (note E9). Balls are thrown upwards near the ground at the left, where no
    arm can be, and come down 0.6 to 2.2 m farther right. The slowest arm at the farthest place can
    wait a quarter of a second to see which ball flies, and still be at rest where the ball will
    come down a tenth of a second before it.

    arm_travel       places of the cup's centre between the hard stops [m]
    arm_start        where the arm waits for a throw [m]
    launch_x         where the ball's centre is launched [m]
    launch_z         its height then [m]
    crossing_x       where it comes down [m]
    apex             the greatest height of its flight [m]
    bounds_x         beyond these the ball is out of bounds [m]
    ceiling          above this too [m]
    tick             of the clock [s]
    cup              what catches
    """

    arm_travel: Interval = (0.5, 2.5)
    arm_start: Interval = (0.8, 2.2)
    launch_x: Interval = (0.0, 0.2)
    launch_z: Interval = (0.05, 0.15)
    crossing_x: Interval = (0.8, 2.2)
    apex: Interval = (1.25, 1.5)
    bounds_x: Interval = (-1.0, 4.0)
    ceiling: float = 4.0
    tick: float = 1.0 / 40.0
    cup: Cup = Cup()

    def __post_init__(self) -> None:
        for field in fields(self):
            if field.name not in {"ceiling", "tick", "cup"}:
                low, high = shaped(getattr(self, field.name), (2,), field.name)
                if low > high:
                    raise InvalidInput(f"{field.name} must be (low, high), got {(low, high)}")
        scalar(self.tick, "tick", above=0.0)
        self._require_inside("arm_start", "arm_travel")
        self._require_inside("arm_travel", "bounds_x")
        self._require_inside("launch_x", "bounds_x")
        self._require_inside("crossing_x", "bounds_x")
        if not 0.0 < self.launch_z[0] <= self.launch_z[1] < self.apex[0]:
            raise InvalidInput(
                f"launch_z must lie between the ground and apex, got {self.launch_z}"
            )
        scalar(self.ceiling, "ceiling", above=self.apex[1])

    def _require_inside(self, inner: str, outer: str) -> None:
        (low, high), (least, most) = getattr(self, inner), getattr(self, outer)
        if low < least or high > most:
            raise InvalidInput(f"{inner} {(low, high)} must lie inside {outer} {(least, most)}")
