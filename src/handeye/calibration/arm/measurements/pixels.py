"""Where points appear in the picture of a pinhole camera."""

from dataclasses import dataclass, replace
from typing import Self, TypeVar

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from handeye.arrays import Array, shaped
from handeye.calibration.arm.measurements.lens import project, straightened
from handeye.calibration.arm.measurements.resection import resection
from handeye.calibration.arm.measurements.seeing import PointInstrument
from handeye.calibration.arm.measurements.settling import linear, settled
from handeye.calibration.arm.measurements.sight import Sight, carriers
from handeye.calibration.arm.measurements.unknowns import Frame, Numbers, Points, Unknown
from handeye.calibration.hand_eye.samples import Setup
from handeye.calibration.hand_eye.solution import solve
from handeye.errors import InvalidInput
from handeye.geometry import invert, make_pose

_LEAST_POSES, _LEAST_POINTS = 3, 6
_BEST = 4
# Corners of one picture from which its board is placed.
_CORNERS = 6
_ONE_POINT = "marker"

_Sightings = TypeVar("_Sightings", bound="PixelSightings")


@dataclass(frozen=True, eq=False, kw_only=True)
class PixelSightings(PointInstrument):
    """A point in the picture, measured (N, 2) [px]: one row for each point of each picture.

        (u, v) = project(s)      s = P^-1 G Q c      (`lens`, `sight`)

    Points of a board of known geometry, or a single point; camera on a stand or in the hand. Of
    several cameras each is a measurement of its own, and they share target and points by name.

    camera  its nine numbers (`lens.lens`)
    """

    camera: Numbers

    @property
    def kinds(self) -> tuple[str, ...]:
        """A place in the picture."""
        return ("pixels",) * 2

    @property
    def others(self) -> tuple[Unknown, ...]:
        """The camera's numbers."""
        return (self.camera,)

    def values(self, s: Array, others: list[Array]) -> tuple[Array, Array, list[Array]]:
        """(u, v)."""
        uv, by_s, by_numbers = project(self.camera.reference + others[0], s)
        return uv, by_s, [by_numbers]

    @classmethod
    def start(
        cls,
        joints: ArrayLike,
        flanges: Array,
        measured: ArrayLike,
        *,
        camera: Numbers,
        board: Points | None = None,
        which: ArrayLike | None = None,
        setup: Setup = "eye_to_hand",
        name: str = "",
        std: ArrayLike = 0.0,
        sensor: str = "camera",
        target: str | None = None,
    ) -> Self:
        """From pixels (N, 2), and nominal flanges T_base_flange (N, 4, 4), the same for a picture.

        camera: intrinsics to begin with. board: points of known geometry, of which `which` (N,)
        is seen; it is placed in each picture that shows 6 of them (`resection.resection`), and
        `hand_eye.solve` gives both frames. Without it one unknown point is seen in every row:
        `_of_one_point`. Then `settled`.

        Raises:
            InvalidInput: for too few pictures or points, or arrays that do not fit together.
        """
        uv = shaped(measured, (None, 2), "measured")
        if len(uv) != len(flanges):
            raise InvalidInput(f"{len(uv)} pixels do not pair up with {len(flanges)} flanges")
        ab = straightened(camera.reference, uv)
        target = target or (_ONE_POINT if board is None else "board")
        number = np.zeros(len(uv), np.int64) if which is None else np.asarray(which)
        rough = cls(
            joints=np.asarray(joints), measured=uv, std=np.asarray(std), name=name, camera=camera,
            sight=Sight(
                setup, Frame.near(sensor, np.eye(4)),
                Frame.known() if board is None else Frame.near(target, np.eye(4)),
                Points.near(target) if board is None else board, number,
            ),
        )  # fmt: skip
        if board is None:
            begin = [_placed(rough, X, Q) for X, Q in _of_one_point(setup, flanges, ab)]
        else:
            begin = [_placed(rough, *_of_board(rough.sight, flanges, ab))]
        ends = [settled(one, flanges) for one in begin]
        return min(ends, key=lambda end: end[1])[0]


def _placed(rough: _Sightings, X: Array, Q: Array) -> _Sightings:
    """With the camera at X (4, 4), and the board at Q (4, 4) or the point at Q (3,)."""
    sight = replace(rough.sight, sensor=replace(rough.sight.sensor, reference=X))
    if Q.ndim == 2:
        sight = replace(sight, target=replace(sight.target, reference=Q))
    else:
        sight = replace(sight, points=replace(sight.points, reference=Q[np.newaxis]))
    return replace(rough, sight=sight)


def _of_board(sight: Sight, flanges: Array, ab: Array) -> tuple[Array, Array]:
    pictures = np.unique(flanges.reshape(-1, 16), axis=0, return_inverse=True)[1].reshape(-1)
    A: list[Array] = []
    S: list[Array] = []
    for picture in range(pictures.max(initial=-1) + 1):
        rows = np.flatnonzero(pictures == picture)
        if len(rows) >= _CORNERS:
            A.append(flanges[rows[0]])
            S.append(resection(sight.points.reference[sight.which[rows]], ab[rows]))
    if len(S) < _LEAST_POSES:
        raise InvalidInput(
            f"a camera and a board are placed by at least {_LEAST_POSES} pictures that show "
            f"{_CORNERS} of its points, got {len(S)}"
        )
    fit = solve(np.array(A), np.array(S), setup=sight.setup)
    return (fit.X, fit.Z) if sight.setup == "eye_in_hand" else (fit.Z, fit.X)


def _of_one_point(setup: Setup, flanges: Array, ab: Array) -> list[tuple[Array, Array]]:
    """Camera and point, several to try.

    On the flange the point is near its origin, and a camera that stands still is where it sees that
    (`resection`). A camera in the hand may look anywhere: for each of the cube's rotations (none is
    more than 63 degrees off) its place and the point's are linear.
    """
    if len(ab) < _LEAST_POINTS:
        raise InvalidInput(
            f"a camera and a single point are placed by at least {_LEAST_POINTS} sightings, got "
            f"{len(ab)}"
        )
    if setup == "eye_to_hand":
        return [(invert(resection(flanges[:, :3, 3], ab)), np.zeros(3))]
    G = carriers(setup, flanges)
    rays = np.column_stack([ab, np.ones(len(ab))])
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    found: list[tuple[float, Array, Array]] = []
    for R in Rotation.create_group("O").as_matrix():
        # What is across the ray of G c - t must vanish.
        across = np.eye(3) - (rays @ R.T)[:, :, np.newaxis] * (rays @ R.T)[:, np.newaxis]
        system = across @ np.concatenate(
            [G[:, :3, :3], np.broadcast_to(-np.eye(3), (len(G), 3, 3))], axis=2
        )
        wanted = -(across @ G[:, :3, 3:]).reshape(-1)
        x = linear(system, wanted)
        miss = float(np.sum((system.reshape(len(wanted), 6) @ x - wanted) ** 2))
        found.append((miss, make_pose(R, x[3:]), x[:3]))
    found.sort(key=lambda one: one[0])
    return [(X, c) for _, X, c in found[:_BEST]]
