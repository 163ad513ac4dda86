"""A pinhole camera with OpenCV's model of distortion.

With a = x / z, b = y / z of a point (x, y, z) in the camera's frame (z ahead, x right, y down) and
r^2 = a^2 + b^2,

    g  = 1 + k1 r^2 + k2 r^4 + k3 r^6
    a' = a g + 2 p1 a b + p2 (r^2 + 2 a^2)        u = fx a' + cx
    b' = b g + p1 (r^2 + 2 b^2) + 2 p2 a b        v = fy b' + cy

(Brown 1971, as OpenCV has it). The nine numbers of a camera, in this order: fx, fy, cx, cy [px],
k1, k2, p1, p2, k3.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, shaped
from handeye.calibration.arm.measurements.unknowns import Numbers
from handeye.errors import InvalidInput

LABELS = (
    ("fx", "px"), ("fy", "px"), ("cx", "px"), ("cy", "px"),
    ("k1", ""), ("k2", ""), ("p1", ""), ("p2", ""), ("k3", ""),
)  # fmt: skip

# A point nearer than this, or behind, is taken for one at this depth [m]: so far off the picture
# that it counts as wrong, but with finite numbers.
_NEAREST = 1e-3
# Newton's steps to undo a distortion: five suffice for the widest lens the model can describe.
_STEPS = 20
_UNDONE = 1e-12

TOLERANCE = np.array([5.0, 5.0, 5.0, 5.0, 0.02, 0.05, 0.002, 0.002, 0.05])
"""How far intrinsics may be from what the maker, or an earlier calibration, says."""


def lens(
    name: str,
    matrix: Sequence[float],
    distortion: Sequence[float] = (),
    tolerance: ArrayLike = 0.0,
) -> Numbers:
    """A camera of known intrinsics, or unknown ones where a tolerance is above 0.

    matrix fx, fy, cx, cy [px]; distortion k1, k2, p1, p2, k3, of which the last may be left out;
    tolerance (9,), or one share of `TOLERANCE` for all.

    Raises:
        InvalidInput: for focal lengths that are not positive, or other numbers of numbers.
    """
    four = shaped(matrix, (4,), f"{name}: fx, fy, cx, cy")
    five = np.zeros(5)
    given = shaped(distortion, (None,), f"{name}: distortion")
    if len(given) > 5:
        raise InvalidInput(
            f"{name}: distortion is k1, k2, p1, p2, k3, got {len(given)} numbers; for a lens with "
            "more, calibrate it with these five"
        )
    if not np.all(four[:2] > 0.0):
        raise InvalidInput(f"{name}: focal lengths must be positive, got {four[:2]}")
    five[: len(given)] = given
    std = np.asarray(tolerance, np.float64)
    return Numbers(
        name, std * TOLERANCE if std.ndim == 0 else std, np.concatenate([four, five]), LABELS
    )


def project(numbers: Array, s: Array) -> tuple[Array, Array, Array]:
    """Pixels (N, 2) of points s (N, 3); derivatives by s (N, 2, 3) and by the numbers (N, 2, 9)."""
    f, c = numbers[:2], numbers[2:4]
    near = s[:, 2] < _NEAREST
    z = np.where(near, _NEAREST, s[:, 2])
    ab = s[:, :2] / z[:, np.newaxis]
    bent, by_ab, by_k = distort(numbers[4:], ab)
    ab_by_s = np.zeros((len(s), 2, 3))
    ab_by_s[:, 0, 0] = ab_by_s[:, 1, 1] = 1.0 / z
    ab_by_s[:, :, 2] = np.where(near[:, np.newaxis], 0.0, -ab / z[:, np.newaxis])
    by_numbers = np.zeros((len(s), 2, 9))
    by_numbers[:, 0, 0], by_numbers[:, 1, 1] = bent[:, 0], bent[:, 1]
    by_numbers[:, 0, 2] = by_numbers[:, 1, 3] = 1.0
    by_numbers[:, :, 4:] = f[:, np.newaxis] * by_k
    return f * bent + c, f[:, np.newaxis] * (by_ab @ ab_by_s), by_numbers


def distort(k: Array, ab: Array) -> tuple[Array, Array, Array]:
    """(a', b') (N, 2) of (a, b); derivatives by (a, b) (N, 2, 2) and by k1 ... k3 (N, 2, 5)."""
    k1, k2, p1, p2, k3 = k
    a, b = ab[:, 0], ab[:, 1]
    q = a * a + b * b
    g = 1.0 + q * (k1 + q * (k2 + q * k3))
    g_q = k1 + q * (2.0 * k2 + 3.0 * q * k3)
    bent = np.stack(
        [
            a * g + 2.0 * p1 * a * b + p2 * (q + 2.0 * a * a),
            b * g + p1 * (q + 2.0 * b * b) + 2.0 * p2 * a * b,
        ],
        axis=-1,
    )
    by_ab = np.empty((len(ab), 2, 2))
    by_ab[:, 0, 0] = g + 2.0 * a * a * g_q + 2.0 * p1 * b + 6.0 * p2 * a
    by_ab[:, 0, 1] = by_ab[:, 1, 0] = 2.0 * a * b * g_q + 2.0 * p1 * a + 2.0 * p2 * b
    by_ab[:, 1, 1] = g + 2.0 * b * b * g_q + 6.0 * p1 * b + 2.0 * p2 * a
    radial = np.stack([q, q**2, q**3], axis=-1)
    by_k = np.empty((len(ab), 2, 5))
    by_k[:, :, [0, 1, 4]] = ab[:, :, np.newaxis] * radial[:, np.newaxis]
    by_k[:, 0, 2], by_k[:, 0, 3] = 2.0 * a * b, q + 2.0 * a * a
    by_k[:, 1, 2], by_k[:, 1, 3] = q + 2.0 * b * b, 2.0 * a * b
    return bent, by_ab, by_k


def straightened(numbers: Array, pixels: Array) -> Array:
    """(a, b) (N, 2) of pixels (N, 2), by Newton's method from the point without distortion."""
    bent = (pixels - numbers[2:4]) / numbers[:2]
    ab = bent.copy()
    for _ in range(_STEPS):
        there, by_ab, _ = distort(numbers[4:], ab)
        step = np.linalg.solve(by_ab, (bent - there)[..., np.newaxis])[..., 0]
        ab += step
        if np.max(np.abs(step), initial=0.0) < _UNDONE:
            break
    return ab
