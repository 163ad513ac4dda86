"""Rigid poses as homogeneous matrices."""

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, finite
from handeye.errors import InvalidInput


def make_pose(rotation: ArrayLike, translation: ArrayLike) -> Array:
    """Poses (..., 4, 4) from rotation matrices (..., 3, 3) and translations (..., 3) [m].

    Raises:
        InvalidInput: for other shapes, or leading axes that do not broadcast.
    """
    R, t = finite(rotation, "rotation"), finite(translation, "translation")
    if R.shape[-2:] != (3, 3) or t.shape[-1:] != (3,):
        raise InvalidInput(
            "a pose needs a rotation (..., 3, 3) and a translation (..., 3), "
            f"got {R.shape} and {t.shape}"
        )
    try:
        lead = np.broadcast_shapes(R.shape[:-2], t.shape[:-1])
    except ValueError:
        raise InvalidInput(
            f"rotations {R.shape} and translations {t.shape} do not belong together"
        ) from None
    pose = np.zeros((*lead, 4, 4))
    pose[..., :3, :3] = R
    pose[..., :3, 3] = t
    pose[..., 3, 3] = 1.0
    return pose


def invert(pose: Array) -> Array:
    """The inverse poses (..., 4, 4): T_b_a from T_a_b.

        T^-1 = [R^T, -R^T t; 0, 1]

    Raises:
        InvalidInput: for another shape.
    """
    T = _poses(pose)
    back = T[..., :3, :3].swapaxes(-1, -2)
    return make_pose(back, -(back @ T[..., :3, 3:])[..., 0])


def transform(pose: Array, points: ArrayLike) -> Array:
    """Points (..., 3) [m] carried from frame b to frame a by T_a_b (..., 4, 4): R p + t.

    Raises:
        InvalidInput: for other shapes.
    """
    T, p = _poses(pose), finite(points, "points")
    if p.shape[-1:] != (3,):
        raise InvalidInput(f"points must have shape (..., 3), got {p.shape}")
    return (T[..., :3, :3] @ p[..., None])[..., 0] + T[..., :3, 3]


def _poses(pose: Array) -> Array:
    T = finite(pose, "pose")
    if T.shape[-2:] != (4, 4):
        raise InvalidInput(f"a pose must have shape (..., 4, 4), got {T.shape}")
    return T
