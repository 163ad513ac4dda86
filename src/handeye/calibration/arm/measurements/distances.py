"""How far a point of the flange is from what stands still: along a wire, or to a plane."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, shaped
from handeye.calibration.arm.measurements.seeing import PointInstrument
from handeye.calibration.arm.measurements.settling import linear, settled
from handeye.calibration.arm.measurements.sight import Sight
from handeye.calibration.arm.measurements.unknowns import Frame, Numbers, Points, Unknown
from handeye.errors import InvalidInput
from handeye.geometry import make_pose

# Of points that are nearer than this to the anchor the direction of the wire is not known [m].
_NEAREST = 1e-9
# An anchor has three coordinates, its wire a zero, and one more to see whether they fit.
_LEAST_DISTANCES = 5
_LEAST_CONTACTS = 4
_ZERO_LABEL = (("zero", "m"),)


@dataclass(frozen=True, eq=False, kw_only=True)
class Distances(PointInstrument):
    """From a fixed anchor to a point of the flange, measured (N, 1) [m].

        d = |s| + z      s = P^-1 A Q c

    A draw-wire encoder, a ball bar (the same d in every row), a laser interferometer. P is known
    but for its origin, the anchor; z is the zero of the instrument.
    """

    zero: Numbers

    @property
    def kinds(self) -> tuple[str, ...]:
        """A distance."""
        return ("distance",)

    @property
    def others(self) -> tuple[Unknown, ...]:
        """The zero."""
        return (self.zero,)

    def values(self, s: Array, others: list[Array]) -> tuple[Array, Array, list[Array]]:
        """|s| + z."""
        length = np.maximum(np.linalg.norm(s, axis=1, keepdims=True), _NEAREST)
        z = self.zero.reference + others[0]
        by_zero = np.ones((len(s), 1, 1))
        return length + z, (s / length)[:, np.newaxis], [by_zero]

    @classmethod
    def start(
        cls,
        joints: ArrayLike,
        flanges: Array,
        measured: ArrayLike,
        *,
        tip: Points | None = None,
        zero_std: float = 0.0,
        name: str = "",
        std: ArrayLike = 0.0,
        anchor: str = "anchor",
    ) -> Self:
        """From N >= 5 distances (N,) and nominal flanges T_base_flange (N, 4, 4).

        tip: the point of the flange, by default within 0.1 m of its origin; zero_std [m] of the
        instrument's zero, 0 where it is known. With p the tip, |p|^2 - d^2 = 2 p a - 2 d z + k is
        linear in the anchor a, z and k = z^2 - |a|^2; then `settled`.

        Raises:
            InvalidInput: for too few rows, or arrays that do not fit together.
        """
        tip = tip or Points.near("wire end")
        d = shaped(measured, (None,), "measured")
        if not len(d) == len(flanges) >= _LEAST_DISTANCES:
            raise InvalidInput(
                f"{anchor} needs at least {_LEAST_DISTANCES} distances to be placed, one for each "
                f"pose of the flange, got {len(d)} for {len(flanges)} poses"
            )
        p = _tips(flanges, tip)
        columns = [2.0 * p, np.ones((len(d), 1))]
        if zero_std > 0.0 and np.ptp(d) > 0.0:
            columns.append(-2.0 * d[:, np.newaxis])
        wanted = np.sum(p**2, axis=1) - d**2
        found = linear(np.hstack(columns), wanted)
        zero = Numbers(
            f"{anchor} zero", np.array([zero_std]), np.append(found, 0.0)[[4]], _ZERO_LABEL
        )
        frame = Frame.near(anchor, make_pose(np.eye(3), found[:3]), turn=0.0)
        rough = cls(
            joints=np.asarray(joints), measured=d[:, np.newaxis], std=np.asarray(std), name=name,
            sight=_fixed(frame, tip, len(d)), zero=zero,
        )  # fmt: skip
        return settled(rough, flanges)[0]


@dataclass(frozen=True, eq=False, kw_only=True)
class PlaneContacts(PointInstrument):
    """A point of the flange is in a plane that stands still: 0 = s_z, measured (N, 1) is 0.

        s = P^-1 A Q c      the plane is z = 0 of P

    A probe on a granite table, a pin at a wall. Of P height and tilts are unknown; measured may be
    other than 0 where a gauge tells how far above the plane [m] the point is.
    """

    @property
    def kinds(self) -> tuple[str, ...]:
        """A contact, across the plane."""
        return ("height",)

    def values(self, s: Array, others: list[Array]) -> tuple[Array, Array, list[Array]]:
        """s_z."""
        del others
        return s[:, 2:], np.broadcast_to([[[0.0, 0.0, 1.0]]], (len(s), 1, 3)), []

    @classmethod
    def start(
        cls,
        joints: ArrayLike,
        flanges: Array,
        *,
        tip: Points | None = None,
        name: str = "",
        std: ArrayLike = 0.0,
        plane: str = "plane",
        heights: ArrayLike | None = None,
    ) -> Self:
        """From N >= 4 contacts and nominal flanges T_base_flange (N, 4, 4).

        tip: the point of the flange, by default within 1 mm of its origin. heights (N,): how far
        above the plane a gauge has the point [m], 0 by default. The plane is the one of which the
        tips have the least sum of squared distances (SVD); with heights z = n p + d is linear in
        the normal n and d, and n points to where the gauge counts up.

        Raises:
            InvalidInput: for too few rows, or arrays that do not fit together.
        """
        tip = tip or Points.near("tip", tolerance=1e-3)
        if len(flanges) < _LEAST_CONTACTS:
            raise InvalidInput(
                f"{plane} needs at least {_LEAST_CONTACTS} contacts to be placed, got "
                f"{len(flanges)}"
            )
        p = _tips(flanges, tip)
        middle = p.mean(axis=0)
        z = np.zeros(len(p)) if heights is None else shaped(heights, (len(p),), "heights")
        if np.ptp(z) > 0.0:
            normal = linear(np.column_stack([p - middle, np.ones(len(p))]), z)[:3]
        else:
            normal = np.linalg.svd(p - middle, full_matrices=False)[2][2]
        R = _upright(normal / np.linalg.norm(normal))
        at = make_pose(R, middle - z.mean() * R[:, 2])
        loose = Frame.near(plane, at).tolerance * [0, 0, 1, 1, 1, 0]
        placed = cls(
            joints=np.asarray(joints), measured=z[:, np.newaxis], std=np.asarray(std),
            name=name, sight=_fixed(Frame(plane, loose, at), tip, len(p)),
        )  # fmt: skip
        return settled(placed, flanges)[0]


def _upright(normal: Array) -> Array:
    """A rotation (3, 3) whose z axis is a unit normal (3,)."""
    across = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    across /= np.linalg.norm(across)
    return np.asarray(np.stack([across, np.cross(normal, across), normal], axis=1), np.float64)


def _tips(flanges: Array, tip: Points) -> Array:
    return flanges[:, :3, :3] @ tip.reference[0] + flanges[:, :3, 3]


def _fixed(frame: Frame, tip: Points, n: int) -> Sight:
    return Sight("eye_to_hand", frame, Frame.known(), tip, np.zeros(n, np.int64))
