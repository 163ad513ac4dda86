"""Where a camera is from points that it sees: closed forms, to start from.

All take points in a frame and (a, b) = (x, y) / z of them in the camera's, without distortion.
"""

import numpy as np

from handeye.arrays import Array
from handeye.errors import InvalidInput
from handeye.geometry import make_pose, nearest_rotation

# Points whose third extent is below this share of the first lie in a plane.
_FLAT = 1e-3
_LEAST_FLAT, _LEAST = 4, 6


def resection(points: Array, ab: Array) -> Array:
    """T_camera_frame (4, 4) from points (N, 3) [m] and their (a, b) (N, 2).

    The direct linear transformation: z (a, b, 1) = R p + t is homogeneous and linear in R and t.
    For points in a plane in two columns of R and t (Zhang 2000). Then the nearest rotation.

    Raises:
        InvalidInput: for fewer than 6 points, 4 of a plane, or points on one line.
    """
    middle = points.mean(axis=0)
    _, extents, axes = np.linalg.svd(points - middle, full_matrices=True)
    extents = np.append(extents, np.zeros(3))[:3]
    axes[2] *= np.sign(np.linalg.det(axes))
    flat = extents[2] < _FLAT * extents[0]
    if len(points) < (_LEAST_FLAT if flat else _LEAST) or extents[1] < _FLAT * extents[0]:
        raise InvalidInput(
            f"a camera is placed by at least {_LEAST} points, or {_LEAST_FLAT} of a plane, that "
            f"are not on one line; got {len(points)}"
        )
    local = (points - middle) @ axes.T / extents[0]
    columns = local[:, :2] if flat else local
    ones = np.column_stack([columns, np.ones(len(points))])
    zero = np.zeros_like(ones)
    a, b = ab[:, :1], ab[:, 1:]
    system = np.block([[ones, zero, -a * ones], [zero, ones, -b * ones]])
    found = np.linalg.svd(system)[2][-1].reshape(3, -1)
    # All points are ahead of the camera.
    found *= np.sign(np.median(ones @ found[2]))
    if flat:
        first, second = found[:, 0], found[:, 1]
        size = np.sqrt(np.linalg.norm(first) * np.linalg.norm(second))
        turn = np.stack([first, second, np.cross(first, second) / size], axis=1)
    else:
        turn = found[:, :3]
        size = np.cbrt(np.abs(np.linalg.det(turn)))
    t = found[:, -1] / size
    R = nearest_rotation(turn) @ axes
    return make_pose(R, extents[0] * t - R @ middle)
