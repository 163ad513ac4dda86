"""Small turns: rotation vectors, their matrices, and how they change.

Rotation vectors (..., 3) are axis times angle [rad]. [v]x w = v x w.
"""

from typing import cast

import numpy as np
from scipy.spatial.transform import Rotation

from handeye.arrays import Array

# Below this angle the closed forms lose digits and their series is exact to rounding [rad].
_SMALL = 1e-3


def cross_matrix(v: Array) -> Array:
    """[v]x (..., 3, 3)."""
    out = np.zeros((*v.shape, 3))
    out[..., 0, 1], out[..., 0, 2], out[..., 1, 2] = -v[..., 2], v[..., 1], -v[..., 0]
    out[..., 1, 0], out[..., 2, 0], out[..., 2, 1] = v[..., 2], -v[..., 1], v[..., 0]
    return out


def turn(v: Array) -> Array:
    """The rotation matrices (..., 3, 3) of rotation vectors."""
    return Rotation.from_rotvec(v.reshape(-1, 3)).as_matrix().reshape(*v.shape, 3)


def turned_by(R: Array) -> Array:
    """The rotation vectors (..., 3) of rotation matrices, no longer than pi."""
    flat = Rotation.from_matrix(R.reshape(-1, 3, 3)).as_rotvec()
    return cast("Array", flat).reshape(R.shape[:-1])


def left_jacobian(v: Array) -> Array:
    """J of exp(v + d) = exp(J d) exp(v) to first order in d, (..., 3, 3).

    J = 1 + (1 - cos a)/a^2 [v]x + (a - sin a)/a^3 [v]x^2   with   a = |v|
    """
    a = np.linalg.norm(v, axis=-1)
    safe = np.where(a < _SMALL, 1.0, a)
    first = np.where(a < _SMALL, 0.5 - a**2 / 24.0, (1.0 - np.cos(safe)) / safe**2)
    second = np.where(a < _SMALL, 1.0 / 6.0 - a**2 / 120.0, (safe - np.sin(safe)) / safe**3)
    V = cross_matrix(v)
    return np.eye(3) + first[..., None, None] * V + second[..., None, None] * (V @ V)


def inverse_right_jacobian(v: Array) -> Array:
    """K of log(exp(v) exp(d)) = v + K d to first order in d, (..., 3, 3), for |v| < 2 pi.

    K = 1 + [v]x/2 + (1/a^2 - cot(a/2)/(2 a)) [v]x^2   with   a = |v|
    """
    a = np.linalg.norm(v, axis=-1)
    safe = np.where(a < _SMALL, 1.0, a)
    closed = 1.0 / safe**2 - 1.0 / (2.0 * safe * np.tan(safe / 2.0))
    second = np.where(a < _SMALL, 1.0 / 12.0 + a**2 / 720.0, closed)
    V = cross_matrix(v)
    return np.eye(3) + 0.5 * V + second[..., None, None] * (V @ V)
