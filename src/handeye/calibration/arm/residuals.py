"""What an observation says of a serial arm: residuals for the engine, in compiled loops."""

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array
from handeye.calibration.arm.kernels import SerialArm, pose_slopes
from handeye.calibration.arm.rotations import turn_between
from handeye.calibration.engine.chain import reach, residuals


@compiled
def measured_at(kernel: SerialArm) -> int:
    """Where the measured position begins in a row."""
    return kernel.n_readings + (len(kernel.slides) if kernel.compliant else 0)


@compiled
def matrix_of(wxyz: Array, R: Array) -> None:
    """R (3, 3), overwritten, of a unit quaternion (4,)."""
    w, x, y, z = wxyz[0], wxyz[1], wxyz[2], wxyz[3]
    R[0, 0], R[1, 1] = 1.0 - 2.0 * (y * y + z * z), 1.0 - 2.0 * (x * x + z * z)
    R[2, 2] = 1.0 - 2.0 * (x * x + y * y)
    R[0, 1], R[1, 0] = 2.0 * (x * y - w * z), 2.0 * (x * y + w * z)
    R[0, 2], R[2, 0] = 2.0 * (x * z + w * y), 2.0 * (x * z - w * y)
    R[1, 2], R[2, 1] = 2.0 * (y * z - w * x), 2.0 * (y * z + w * x)


@compiled
def misfit(kernel: SerialArm, x: Array, seen: Array, values: Array, slopes: Array) -> None:
    """Measured minus predicted values (k,) [m], [rad] in the sensor's axes; and slopes (k, n_x).

    Both overwritten; k is 6 where orientation is seen, else 3. A turn is the rotation vector from
    the predicted to the measured orientation.
    """
    at = measured_at(kernel)
    T, by = np.empty((3, 4)), np.empty((6, len(x)))
    pose_slopes(kernel, x, seen, T, by)
    for i in range(3):
        values[i] = seen[at + i] - T[i, 3]
        for c in range(len(x)):
            slopes[i, c] = -by[i, c]
    if kernel.oriented:
        R, K = np.empty((3, 3)), np.empty((3, 3))
        matrix_of(seen[at + 6 :], R)
        turn_between(T[:, :3], R, values[3:], K)
        for i in range(3):
            for c in range(len(x)):
                slopes[3 + i, c] = -(K[i, 0] * by[3, c] + K[i, 1] * by[4, c] + K[i, 2] * by[5, c])


@compiled
def deviations(kernel: SerialArm, seen: Array, doubt: float, out: Array) -> None:
    """Standard deviations out (k,), overwritten, of an observation's residuals."""
    at = measured_at(kernel) + 3
    for i in range(len(out)):
        if i < 3:
            out[i] = np.hypot(seen[at + i], doubt)
        else:
            out[i] = np.hypot(kernel.turn_std, doubt / kernel.lever)


@residuals.of(SerialArm)
def arm_residuals(
    kernel: SerialArm, x: Array, seen: Array, doubt: float, values: Array, slopes: Array
) -> None:
    """Of position, and orientation where it is seen, over their standard deviations."""
    std = np.empty(len(values))
    misfit(kernel, x, seen, values, slopes)
    deviations(kernel, seen, doubt, std)
    for i in range(len(values)):
        values[i] /= std[i]
        for c in range(len(x)):
            slopes[i, c] /= std[i]


@reach.of(SerialArm)
def arm_reach(kernel: SerialArm, x: Array, seen: Array, doubt: float, out: Array) -> None:  # noqa: ARG001
    """Of a position the residual itself, in the sensor's axes; a turn moves the marker nowhere."""
    std = np.empty(out.shape[1])
    deviations(kernel, seen, doubt, std)
    for i in range(len(out)):
        for c in range(out.shape[1]):
            out[i, c] = std[i] if c == i else 0.0
