"""Pairs of poses: where the arm's controller says the flange is, and where the camera sees it."""

from dataclasses import dataclass
from typing import Literal, Self

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, Booleans, Integers, finite
from handeye.errors import InvalidInput
from handeye.geometry import invert, make_pose, nearest_rotation

Setup = Literal["eye_in_hand", "eye_to_hand"]

# Two motions about different axes are the least that can determine everything.
LEAST = 3
# A matrix this far from a rotation is a mistake rather than rounding (float32 has 1e-7).
_NO_ROTATION = 1e-3
_LEAST_DISTANCE = 1e-3


@dataclass(frozen=True, eq=False)
class Samples:
    """N pairs in an order of their own, so that the order in which they came does not matter.

    flanges  T_base_flange (N, 4, 4)
    sensed   T_camera_target (N, 4, 4)
    order    (N,) flanges[i] came as number order[i]
    distance half of the time the target is farther from the camera, in the camera's unit

    The camera stands on one carrier and the target on the other: on the flange and in the world
    ("eye_in_hand"), or in the world and on the flange ("eye_to_hand").
    """

    flanges: Array
    sensed: Array
    order: Integers
    setup: Setup
    distance: float

    @classmethod
    def of(cls, flanges: ArrayLike, sensed: ArrayLike, setup: Setup, *, in_order: bool) -> Self:
        """Checked and sorted, unless their order matters.

        Raises:
            InvalidInput: for arrays that are no poses, do not pair up, or are fewer than three.
        """
        if setup not in ("eye_in_hand", "eye_to_hand"):
            raise InvalidInput(f"setup must be 'eye_in_hand' or 'eye_to_hand', got {setup!r}")
        arm, eye = poses(flanges, "flanges"), poses(sensed, "sensed")
        if len(arm) != len(eye):
            raise InvalidInput(f"flanges and sensed must pair up, got {len(arm)} and {len(eye)}")
        if len(arm) < LEAST:
            raise InvalidInput(
                f"hand-eye calibration needs at least {LEAST} poses, got {len(arm)}: add poses "
                "that turn the flange about different axes; some dozens are good"
            )
        order = np.arange(len(arm))
        if not in_order:
            order = np.lexsort(np.concatenate([arm, eye], axis=1).reshape(len(arm), -1).T)
        distance = float(np.median(np.linalg.norm(eye[:, :3, 3], axis=1)))
        return cls(arm[order], eye[order], order, setup, max(distance, _LEAST_DISTANCE))

    @property
    def carriers(self) -> Array:
        """The target's carrier in the camera's carrier (N, 4, 4)."""
        return invert(self.flanges) if self.setup == "eye_in_hand" else self.flanges

    def as_given(self, values: Array) -> Array:
        """Values (N, ...) of the sorted samples in the order in which these came."""
        out = np.empty_like(values)
        out[self.order] = values
        return out


def poses(value: ArrayLike, name: str) -> Array:
    """Poses (N, 4, 4) with rotations that are rotations to rounding.

    Raises:
        InvalidInput: for another shape, numbers that are not finite, or matrices that are no poses.
    """
    T = finite(value, name)
    if T.ndim != 3 or T.shape[1:] != (4, 4):
        raise InvalidInput(f"{name} must be poses of shape (N, 4, 4), got {T.shape}")
    wrong = np.flatnonzero(~_are_poses(T))
    if wrong.size:
        i = int(wrong[0])
        if _are_poses(T[i : i + 1].swapaxes(1, 2))[0]:
            raise InvalidInput(
                f"{name}[{i}] is no pose: it is transposed, with the translation in its last row"
            )
        raise InvalidInput(
            f"{name}[{i}] is no pose: it needs a right-handed rotation above the last row "
            "(0, 0, 0, 1)"
        )
    return make_pose(nearest_rotation(T[:, :3, :3]), T[:, :3, 3])


def _are_poses(T: Array) -> Booleans:
    """Whether matrices (N, 4, 4) are a right-handed rotation and a translation, (N,)."""
    R = T[:, :3, :3]
    off = np.abs(R @ R.swapaxes(1, 2) - np.eye(3)).max(axis=(1, 2))
    last = np.abs(T[:, 3] - np.array([0.0, 0.0, 0.0, 1.0])).max(axis=1)
    return (off <= _NO_ROTATION) & (np.linalg.det(R) > 0.0) & (last <= _NO_ROTATION)
