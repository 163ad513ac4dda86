"""Points in space, seen by a sensor on a stand or in the hand, or touched."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, Integers, shaped
from handeye.calibration.arm.measurements.seeing import PointInstrument, in_turn
from handeye.calibration.arm.measurements.settling import linear, settled
from handeye.calibration.arm.measurements.sight import Sight, carriers
from handeye.calibration.arm.measurements.unknowns import Frame, Points, Unknown
from handeye.calibration.hand_eye.samples import Setup
from handeye.errors import InvalidInput
from handeye.geometry import make_pose, nearest_rotation

# The closed form has 15 unknowns, three equations a row.
_LEAST = 5


@dataclass(frozen=True, eq=False, kw_only=True)
class PointSightings(PointInstrument):
    """A point of the target in the sensor's frame, measured (N, 3) [m].

        s = P^-1 G Q c

    A tracker, a depth camera, a pair of cameras that triangulates; eye to hand or in hand.
    """

    @property
    def kinds(self) -> tuple[str, ...]:
        """A position."""
        return ("position",) * 3

    def values(self, s: Array, others: list[Array]) -> tuple[Array, Array, list[Array]]:
        """s itself."""
        del others
        return s, np.broadcast_to(np.eye(3), (len(s), 3, 3)), []

    @classmethod
    def start(
        cls,
        joints: ArrayLike,
        flanges: Array,
        measured: ArrayLike,
        *,
        setup: Setup = "eye_to_hand",
        name: str = "",
        std: ArrayLike = 0.0,
        sensor: str = "sensor",
        target: str = "marker",
    ) -> Self:
        """One unknown point seen N >= 5 times; nominal flanges T_base_flange (N, 4, 4).

        R_P s + t_P - R_G c = t_G is linear in R_P, t_P and c, taken as 15 numbers; then again in
        t_P and c with the rotation nearest to R_P; then `settled`.

        Raises:
            InvalidInput: for too few rows, or arrays that do not fit together.
        """
        s = shaped(measured, (None, 3), "measured")
        G = carriers(setup, flanges)
        if not len(s) == len(G) >= _LEAST:
            raise InvalidInput(
                f"{sensor} and {target} need at least {_LEAST} sightings to be placed, one for "
                f"each pose of the flange, got {len(s)} for {len(G)} poses"
            )
        n = len(s)
        system = np.zeros((n, 3, 15))
        for i in range(3):
            system[:, i, 3 * i : 3 * i + 3] = s
        system[:, :, 9:12] = np.eye(3)
        system[:, :, 12:] = -G[:, :3, :3]
        wanted = G[:, :3, 3].reshape(-1)
        R = nearest_rotation(linear(system, wanted)[:9].reshape(3, 3))
        t = linear(system[:, :, 9:], wanted - (s @ R.T).reshape(-1))
        sight = Sight(
            setup, Frame.near(sensor, make_pose(R, t[:3])), Frame.known(),
            Points.near(target, t[np.newaxis, 3:]), np.zeros(n, np.int64),
        )  # fmt: skip
        rough = cls(
            joints=np.asarray(joints), measured=s, std=np.asarray(std), name=name, sight=sight
        )
        return settled(rough, flanges)[0]


@dataclass(frozen=True, eq=False, kw_only=True)
class Touches(PointInstrument):
    """A point of the flange in one of several places that do not move: 0 = s - h, measured is 0.

        s = P^-1 A Q c      the tip in the frame of what is touched

    A ball in sockets, a pin in holes, a probe that comes back to the same point. What is touched
    may be points of known distances (a plate at P with sockets h that are known, or known to a
    tolerance), or free points.

    places   h in the frame of the sensor P
    touched  (N,) the place of each row
    """

    places: Points
    touched: Integers

    @property
    def kinds(self) -> tuple[str, ...]:
        """A contact."""
        return ("contact",) * 3

    @property
    def others(self) -> tuple[Unknown, ...]:
        """The places."""
        return (self.places,)

    def folds(self, count: int) -> Integers:
        """Blocks of rows within each place, so that every place is in all but one of them."""
        out = np.empty(len(self.touched), np.int64)
        for place in range(len(self.places.reference)):
            rows = np.flatnonzero(self.touched == place)
            out[rows] = in_turn(self.joints[rows], count)
        return out

    def values(self, s: Array, others: list[Array]) -> tuple[Array, Array, list[Array]]:
        """s - h."""
        n = len(self.places.reference)
        by_places = np.zeros((len(s), 3, n, 3))
        by_places[np.arange(len(s)), :, self.touched] = -np.eye(3)
        misses = s - self.places.places(others[0])[self.touched]
        return misses, np.broadcast_to(np.eye(3), (len(s), 3, 3)), [by_places.reshape(-1, 3, 3 * n)]

    @classmethod
    def start(
        cls,
        joints: ArrayLike,
        flanges: Array,
        touched: ArrayLike,
        *,
        geometry: ArrayLike | None = None,
        geometry_std: float = 0.0,
        tip: Points | None = None,
        name: str = "",
        std: ArrayLike = 0.0,
        plate: str = "plate",
    ) -> Self:
        """Places numbered `touched` (N,), from nominal flanges T_base_flange (N, 4, 4).

        geometry (P, 3) [m] of the places in a frame of their own, within geometry_std of each;
        without it the places are free points. tip: the point that touches, in the flange's frame,
        by default 1 mm about its origin. Free places begin at the means of the tip, a plate
        where these fit its geometry best (Kabsch 1976).

        Raises:
            InvalidInput: for arrays that do not fit together, or a place without a touch.
        """
        which, q = np.asarray(touched), np.asarray(joints, np.float64)
        tip = tip or Points.near("tip", tolerance=1e-3)
        if which.shape != (len(flanges),) or which.dtype.kind not in "iu":
            raise InvalidInput(
                f"touched must name a place for each of {len(flanges)} poses as a whole number, "
                f"got {which.dtype} {which.shape}"
            )
        count = 1 + int(which.max(initial=-1)) if geometry is None else len(np.asarray(geometry))
        if sorted(set(which.tolist())) != list(range(count)):
            raise InvalidInput(
                f"touched must name every one of {count} places, numbered from 0, got "
                f"{sorted(set(which.tolist()))}"
            )
        tips = flanges[:, :3, :3] @ tip.reference[0] + flanges[:, :3, 3]
        means = np.array([tips[which == k].mean(axis=0) for k in range(count)])
        if geometry is None:
            frame, places = Frame.known(), Points.near(plate, means)
        else:
            known = shaped(geometry, (count, 3), "geometry")
            frame = Frame.near(plate, _fitted(known, means))
            places = Points.near(f"{plate} geometry", known, geometry_std)
        sight = Sight("eye_to_hand", frame, Frame.known(), tip, np.zeros(len(q), np.int64))
        return cls(
            joints=q, measured=np.zeros((len(q), 3)), std=np.asarray(std), name=name,
            sight=sight, places=places, touched=which.astype(np.int64),
        )  # fmt: skip


def _fitted(known: Array, found: Array) -> Array:
    """The pose that carries known points (P, 3) nearest to those found; any turn about one line."""
    a, b = known - known.mean(axis=0), found - found.mean(axis=0)
    R = nearest_rotation(b.T @ a)
    return make_pose(R, found.mean(axis=0) - R @ known.mean(axis=0))
