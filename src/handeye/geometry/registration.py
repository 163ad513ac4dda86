"""The rigid motion that best carries one set of points onto another."""

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, shaped
from handeye.errors import InvalidInput
from handeye.geometry.poses import make_pose
from handeye.geometry.rotations import nearest_rotation

# Points that stray from a line by less than this share of their extent count as collinear: the
# turn about the line would be made of rounding and noise.
_COLLINEAR = 1e-6


def rigid_transform(a: ArrayLike, b: ArrayLike) -> Array:
    """The pose T (4, 4) that minimises sum_i |b_i - T a_i|^2 over points a, b (N, 3) [m].

        R = nearest rotation to sum_i (b_i - mean b)(a_i - mean a)^T,   t = mean b - R mean a

    (Kabsch 1976; Umeyama 1991, without scale). Planar sets are fine.

    Raises:
        InvalidInput: for fewer than three pairs, unequal lengths, or points on one line.
    """
    start, end = shaped(a, (None, 3), "a"), shaped(b, (None, 3), "b")
    if len(start) != len(end):
        raise InvalidInput(f"a and b must pair up, got {len(start)} and {len(end)} points")
    if len(start) < 3:
        raise InvalidInput(f"a rigid motion needs at least 3 pairs of points, got {len(start)}")
    from_start, from_end = start - start.mean(axis=0), end - end.mean(axis=0)
    for name, points in (("a", from_start), ("b", from_end)):
        extent = np.linalg.svd(points, compute_uv=False)
        if extent[1] <= _COLLINEAR * extent[0]:
            raise InvalidInput(
                f"the points {name} lie on one line (or in one place), so the turn about it is "
                "not determined: add points off the line"
            )
    R = nearest_rotation(from_end.T @ from_start)
    return make_pose(R, end.mean(axis=0) - R @ start.mean(axis=0))
