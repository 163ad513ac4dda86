"""Rotation vectors in compiled loops: matrices (3, 3) and how they change."""

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array

# Below this angle the closed forms lose digits and their series is exact to rounding [rad].
_SMALL = 1e-3


@compiled
def quadratic(v: Array, one: float, two: float, out: Array) -> None:
    """out (3, 3), overwritten: 1 + one [v]x + two [v]x^2 for v (3,)."""
    x, y, z = v[0], v[1], v[2]
    out[0, 0] = 1.0 - two * (y * y + z * z)
    out[1, 1] = 1.0 - two * (x * x + z * z)
    out[2, 2] = 1.0 - two * (x * x + y * y)
    out[0, 1] = two * x * y - one * z
    out[1, 0] = two * x * y + one * z
    out[0, 2] = two * x * z + one * y
    out[2, 0] = two * x * z - one * y
    out[1, 2] = two * y * z - one * x
    out[2, 1] = two * y * z + one * x


@compiled
def turned(v: Array, R: Array, L: Array) -> None:
    """R = exp([v]x) and L (3, 3), overwritten, with exp(v + d) = exp(L d) exp(v) for small d.

    With a = |v|: exp = 1 + sin a / a [v]x + (1 - cos a) / a^2 [v]x^2 (Rodrigues), and
    L = 1 + (1 - cos a) / a^2 [v]x + (a - sin a) / a^3 [v]x^2.
    """
    squared = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
    a = np.sqrt(squared)
    if a < _SMALL:
        first = 1.0 - squared / 6.0
        second = 0.5 - squared / 24.0
        third = 1.0 / 6.0 - squared / 120.0
    else:
        first = np.sin(a) / a
        second = (1.0 - np.cos(a)) / squared
        third = (a - np.sin(a)) / (squared * a)
    quadratic(v, first, second, R)
    quadratic(v, second, third, L)


@compiled
def turn_between(start: Array, end: Array, v: Array, K: Array) -> None:
    """v (3,) with end = exp([v]x) start, |v| <= pi, and K (3, 3); both overwritten.

    With start turned by a small d in the axes outside, exp([d]x) start, v becomes v - K d:
    K = 1 + [v]x / 2 + (1 / a^2 - cot(a / 2) / (2 a)) [v]x^2 with a = |v|. Through the quaternion of
    end start^T, which keeps its digits near 0 and near pi.
    """
    D = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            D[i, j] = 0.0
            for k in range(3):
                D[i, j] += end[i, k] * start[j, k]
    # The largest of (w^2, x^2, y^2, z^2) times 4, less 1, decides which formula keeps digits.
    sizes = np.empty(4)
    trace = D[0, 0] + D[1, 1] + D[2, 2]
    sizes[0] = trace
    for i in range(3):
        sizes[i + 1] = 2.0 * D[i, i] - trace
    most = int(np.argmax(sizes))
    q = np.empty(4)
    if most == 0:
        q[0] = 1.0 + trace
        q[1], q[2], q[3] = D[2, 1] - D[1, 2], D[0, 2] - D[2, 0], D[1, 0] - D[0, 1]
    else:
        i = most - 1
        j, k = (i + 1) % 3, (i + 2) % 3
        q[0] = D[k, j] - D[j, k]
        q[1 + i] = 1.0 + sizes[most]
        q[1 + j] = D[j, i] + D[i, j]
        q[1 + k] = D[k, i] + D[i, k]
    size = np.sqrt(np.sum(q * q))
    sign = 1.0 if q[0] >= 0.0 else -1.0
    w = sign * q[0] / size
    s = np.sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]) / size
    a = 2.0 * np.arctan2(s, w)
    scale = 2.0 if s < _SMALL * _SMALL else a / s
    for i in range(3):
        v[i] = scale * sign * q[1 + i] / size
    third = 1.0 / 12.0 + a * a / 720.0
    if a >= _SMALL:
        third = 1.0 / (a * a) - 1.0 / (2.0 * a * np.tan(0.5 * a))
    quadratic(v, 0.5, third, K)
