"""Rotation matrices and unit quaternions; the algebra itself is SciPy's `Rotation`."""

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from handeye.arrays import Array, finite
from handeye.errors import InvalidInput


def matrix_from_wxyz(wxyz: ArrayLike) -> Array:
    """The rotation matrices (..., 3, 3) of quaternions (..., 4), w first.

    The quaternions need not have unit length; q and -q are the same rotation.

    Raises:
        InvalidInput: for another shape, or a quaternion of length zero.
    """
    quaternions = finite(wxyz, "wxyz")
    if quaternions.shape[-1:] != (4,):
        raise InvalidInput(f"wxyz must have shape (..., 4), got {quaternions.shape}")
    if not np.all(np.any(quaternions != 0.0, axis=-1)):
        raise InvalidInput("a quaternion of length zero is no rotation")
    rotations = Rotation.from_quat(quaternions.reshape(-1, 4), scalar_first=True)
    return rotations.as_matrix().reshape(*quaternions.shape[:-1], 3, 3)


def wxyz_from_matrix(matrix: ArrayLike) -> Array:
    """Unit quaternions (..., 4), w first and w >= 0, of rotation matrices (..., 3, 3).

    Raises:
        InvalidInput: for another shape, or a matrix that is no rotation (R R^T = 1, det R = 1).
    """
    matrices = finite(matrix, "matrix")
    if matrices.shape[-2:] != (3, 3):
        raise InvalidInput(f"a rotation matrix must have shape (..., 3, 3), got {matrices.shape}")
    flat = matrices.reshape(-1, 3, 3)
    orthonormal = np.allclose(flat @ flat.swapaxes(1, 2), np.eye(3), rtol=0.0, atol=1e-6)
    if not orthonormal or np.any(np.linalg.det(flat) < 0.0):
        raise InvalidInput("matrix is no rotation: its rows must be orthonormal, right-handed")
    wxyz = Rotation.from_matrix(flat).as_quat(canonical=True, scalar_first=True)
    return wxyz.reshape(*matrices.shape[:-2], 4)


def nearest_rotation(matrix: ArrayLike) -> Array:
    """The rotation closest to each matrix (..., 3, 3) in the Frobenius norm.

        R = U diag(1, 1, det(U V^T)) V^T   with   M = U S V^T

    (orthogonal Procrustes problem; Kabsch 1978, Umeyama 1991). Where the two smallest singular
    values vanish, several rotations are equally close and one of them is returned.

    Raises:
        InvalidInput: for another shape.
    """
    matrices = finite(matrix, "matrix")
    if matrices.shape[-2:] != (3, 3):
        raise InvalidInput(f"matrix must have shape (..., 3, 3), got {matrices.shape}")
    left, _, right = np.linalg.svd(matrices)
    sign = np.ones(matrices.shape[:-1])
    sign[..., 2] = np.linalg.det(left @ right)
    return (left * sign[..., None, :]) @ right
