"""A point of a target as a sensor has it before it, and how that changes with all unknowns.

The sensor sits at P on its carrier, the target at Q on the other, and c is a point of the target:

    s = P^-1 G Q c      G = A where the sensor stands still (eye to hand), A^-1 where the flange
                        carries it (eye in hand), with A = T_base_flange

A wire from a fixed anchor, a plane that is touched and a socket that holds a ball are sensors too:
fixed frames in which a point of the flange has some place.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from handeye.arrays import Array, Integers
from handeye.calibration.arm.measurements.unknowns import Frame, Points
from handeye.calibration.hand_eye.samples import Setup
from handeye.calibration.hand_eye.turns import cross_matrix
from handeye.errors import InvalidInput
from handeye.geometry import invert


class Seen(NamedTuple):
    """Points in sensors' frames, s (N, 3) [m], and their derivatives.

    by_flange (N, 3, 6): shift of the flange's origin [m] and turn about it [rad], in axes of the
    base; by_sensor and by_target (N, 3, 6), by_points (N, 3, 3 P): their components.
    """

    s: Array
    by_flange: Array
    by_sensor: Array
    by_target: Array
    by_points: Array


@dataclass(frozen=True, eq=False)
class Sight:
    """Who looks at what, in N rows.

    setup   "eye_to_hand": sensor in the base's frame, target in the flange's; "eye_in_hand": the
            other way round
    sensor  P
    target  Q
    points  c, in the target's frame
    which   (N,) the point of each row

    Raises InvalidInput for points that are not there.
    """

    setup: Setup
    sensor: Frame
    target: Frame
    points: Points
    which: Integers

    def __post_init__(self) -> None:
        if self.setup not in {"eye_in_hand", "eye_to_hand"}:
            raise InvalidInput(f"setup must be 'eye_in_hand' or 'eye_to_hand', got {self.setup!r}")
        which, n = np.asarray(self.which), len(self.points.reference)
        if which.ndim != 1 or which.dtype.kind not in "iu":
            raise InvalidInput(f"which must be whole numbers (N,), got {which.dtype} {which.shape}")
        if which.size and not (which.min() >= 0 and which.max() < n):
            raise InvalidInput(
                f"which must name points 0 to {n - 1} of {self.points.name}, got "
                f"{which.min()} to {which.max()}"
            )
        object.__setattr__(self, "which", which.astype(np.int64))

    @property
    def unknowns(self) -> tuple[Frame, Frame, Points]:
        """Sensor, target, points."""
        return self.sensor, self.target, self.points

    def look(self, flanges: Array, sensor: Array, target: Array, points: Array) -> Seen:
        """At T_base_flange (N, 4, 4) and all components of the unknowns: (6,), (6,), (3 P,)."""
        P, Q = self.sensor.pose(sensor), self.target.pose(target)
        G = carriers(self.setup, flanges)
        from_target = self.points.places(points)[self.which] @ Q[:3, :3].T
        on_carrier = from_target + Q[:3, 3]
        turned = np.einsum("nij,nj->ni", G[:, :3, :3], on_carrier)
        reach = turned + G[:, :3, 3] - P[:3, 3]
        into = P[:3, :3].T
        along = into @ G[:, :3, :3]
        # Of the flange: a shift, and a turn about its origin, of what it carries.
        if self.setup == "eye_in_hand":
            back = -along
            lever = on_carrier - flanges[:, :3, 3]
        else:
            back = np.broadcast_to(into, along.shape)
            lever = turned
        by_flange = np.concatenate([back, -back @ cross_matrix(lever)], axis=2)
        still = np.broadcast_to(-into, along.shape)
        by_sensor = np.concatenate([still, into @ cross_matrix(reach)], axis=2)
        by_target = np.concatenate([along, -along @ cross_matrix(from_target)], axis=2)
        return Seen(
            reach @ into.T,
            by_flange,
            by_sensor @ self.sensor.ways(sensor),
            by_target @ self.target.ways(target),
            self._by_points(along @ Q[:3, :3]),
        )

    def turns(self, flanges: Array, sensor: Array, target: Array) -> tuple[Array, Array, Array]:
        """How the target's orientation turns [rad] in axes of the sensor, (N, 3, 6) each.

        By the flange's pose, and by the components of sensor and target; no shift turns anything.
        """
        into = self.sensor.pose(sensor)[:3, :3].T
        along = into @ carriers(self.setup, flanges)[:, :3, :3]
        still = np.broadcast_to(into, along.shape)
        return (
            _turning(-along if self.setup == "eye_in_hand" else still),
            _turning(-still) @ self.sensor.ways(sensor),
            _turning(along) @ self.target.ways(target),
        )

    def _by_points(self, by_one: Array) -> Array:
        """(N, 3, 3 P) of derivatives (N, 3, 3) by the point of each row."""
        n, count = len(by_one), len(self.points.reference)
        out = np.zeros((n, 3, count, 3))
        if self.points.free.any():
            out[np.arange(n), :, self.which] = by_one
        return out.reshape(n, 3, 3 * count)


def carriers(setup: Setup, flanges: Array) -> Array:
    """G (N, 4, 4): where the target's carrier is in the sensor's."""
    return invert(flanges) if setup == "eye_in_hand" else flanges


def _turning(R: Array) -> Array:
    """(N, 3, 6) of derivatives (N, 3, 3) by a turn: a shift turns nothing."""
    return np.concatenate([np.zeros_like(R), R], axis=2)
