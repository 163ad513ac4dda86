"""What N sightings say of the parameters: values and derivatives, in compiled loops.

A sighting is a row (6,): alpha_meas, beta_meas, r_meas, bearing gamma_meas + eps_meas, and the
standard deviations of range and bearing. Parameters p (8,) are in the order of `parameters.NAMES`.
"""

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array

# A hand in the eye has no bearing; nearer than this [m] it is treated as if it were this far.
_NEAREST = 1e-6


@compiled
def wrapped(angle: float) -> float:
    """The same angle in (-pi, pi]."""
    return np.pi - (np.pi - angle) % (2.0 * np.pi)


@compiled
def residual_rows(p: Array, rows: Array, values: Array, slopes: Array) -> None:
    """Signed residuals over their standard deviations, and their derivatives (eq 3.3 to 3.12).

        (r_meas - s |t - v|) / std_r,    wrap(bearing + O_gamma - arg(t - v)) / std_theta

    rows (N, 6); values (2 N,) and slopes (2 N, 8), overwritten, range before bearing.
    """
    for i in range(len(rows)):
        alpha = rows[i, 0] + p[4]
        both = alpha + rows[i, 1] + p[5]
        b_x, b_y = p[1] * np.cos(both), p[1] * np.sin(both)
        t_x, t_y = p[0] * np.cos(alpha) + b_x, p[0] * np.sin(alpha) + b_y
        x, y = t_x - p[2], t_y - p[3]
        d = max(np.sqrt(x * x + y * y), _NEAREST)
        along, across = slopes[2 * i], slopes[2 * i + 1]
        values[2 * i] = (rows[i, 2] - p[7] * d) / rows[i, 4]
        values[2 * i + 1] = wrapped(rows[i, 3] + p[6] - np.arctan2(y, x)) / rows[i, 5]
        for k in range(6):
            # The hand's displacement in the eye's frame by parameter k.
            if k == 0:
                dx, dy = np.cos(alpha), np.sin(alpha)
            elif k == 1:
                dx, dy = np.cos(both), np.sin(both)
            elif k == 2:
                dx, dy = -1.0, 0.0
            elif k == 3:
                dx, dy = 0.0, -1.0
            elif k == 4:
                dx, dy = -t_y, t_x
            else:
                dx, dy = -b_y, b_x
            along[k] = -p[7] * (x * dx + y * dy) / (d * rows[i, 4])
            across[k] = -(x * dy - y * dx) / (d * d * rows[i, 5])
        along[6], across[6] = 0.0, 1.0 / rows[i, 5]
        along[7], across[7] = -d / rows[i, 4], 0.0


@compiled
def forward_rows(p: Array, rows: Array, values: Array, slopes: Array) -> None:
    """The thesis's scalar objective y = r^2 + theta^2 and its derivatives (eq 3.117 to 3.126).

    With gamma_act = gamma_meas + O_gamma (note E5) theta is the bearing as the encoder reads it,
    wrapped, in the measured and in the computed y. values (N,) measured minus computed y, slopes
    (N, 8), overwritten; the derivative by range_scale, which the thesis has not, is 0.
    """
    for i in range(len(rows)):
        alpha = rows[i, 0] + p[4]
        both = alpha + rows[i, 1] + p[5]
        b_x, b_y = p[1] * np.cos(both), p[1] * np.sin(both)
        t_x, t_y = p[0] * np.cos(alpha) + b_x, p[0] * np.sin(alpha) + b_y
        x, y = t_x - p[2], t_y - p[3]
        d2 = max(x * x + y * y, _NEAREST**2)
        theta = wrapped(np.arctan2(y, x) - p[6])
        seen_r, seen_theta = rows[i, 2] / p[7], wrapped(rows[i, 3])
        values[i] = seen_r**2 + seen_theta**2 - (d2 + theta**2)
        # y = ... moves by these when the hand moves along x and y.
        by_x = 2.0 * (x - theta * y / d2)
        by_y = 2.0 * (y + theta * x / d2)
        slopes[i, 0] = -(by_x * np.cos(alpha) + by_y * np.sin(alpha))
        slopes[i, 1] = -(by_x * np.cos(both) + by_y * np.sin(both))
        slopes[i, 2] = by_x
        slopes[i, 3] = by_y
        slopes[i, 4] = by_x * t_y - by_y * t_x
        slopes[i, 5] = by_x * b_y - by_y * b_x
        slopes[i, 6] = 2.0 * theta
        slopes[i, 7] = 0.0


@compiled
def arm_angles(p: Array, row: Array) -> tuple[float, float, float]:
    """Angles alpha and beta that bring the hand to the sighting row (6,), and cos beta unclipped.

    Eq 3.11 to 3.17, as `PlanarPlant.joints_for` before its encoder offsets.
    """
    a, b = p[0], p[1]
    elbow = 1.0 if row[1] >= 0.0 else -1.0
    r, theta = row[2] / p[7], row[3] + p[6]
    t_x, t_y = r * np.cos(theta) + p[2], r * np.sin(theta) + p[3]
    t2 = t_x * t_x + t_y * t_y
    cos_beta = (t2 - a * a - b * b) / (2.0 * a * b)
    cos_phi = (t2 + a * a - b * b) / (2.0 * a * max(np.sqrt(t2), _NEAREST))
    beta = elbow * np.arccos(min(max(cos_beta, -1.0), 1.0))
    phi = np.arccos(min(max(cos_phi, -1.0), 1.0))
    return np.arctan2(t_y, t_x) - elbow * phi, beta, cos_beta


@compiled
def commanded_rows(parameters: Array, rows: Array, joints: Array) -> None:
    """Encoder readings joints (N, 2), overwritten, that parameters (N, 8) command for sightings."""
    for i in range(len(rows)):
        p = parameters[i]
        alpha, beta, _ = arm_angles(p, rows[i])
        joints[i, 0], joints[i, 1] = wrapped(alpha - p[4]), wrapped(beta - p[5])


@compiled
def reverse_rows(p: Array, rows: Array, values: Array, slopes: Array) -> None:
    """y = alpha^2 + beta^2 by the inverse kinematics, and its derivatives (section 3.6.2).

    The angles are what the encoders should read at the sighting. Derivatives from
    f(alpha, beta; a, b) = t(v, O_gamma), whose Jacobian is singular for a stretched arm; towards a
    hand out of reach only alpha turns. values (N,) measured minus computed y, slopes (N, 8),
    overwritten; the derivative by range_scale, which the thesis has not, is 0.
    """
    for i in range(len(rows)):
        a, b = p[0], p[1]
        alpha, beta, cos_beta = arm_angles(p, rows[i])
        alpha_read, beta_read = wrapped(alpha - p[4]), wrapped(beta - p[5])
        seen_alpha, seen_beta = wrapped(rows[i, 0]), wrapped(rows[i, 1])
        values[i] = seen_alpha**2 + seen_beta**2 - (alpha_read**2 + beta_read**2)
        slopes[i, :] = 0.0
        slopes[i, 4], slopes[i, 5] = 2.0 * alpha_read, 2.0 * beta_read
        r, theta = rows[i, 2] / p[7], rows[i, 3] + p[6]
        e_x, e_y = r * np.cos(theta), r * np.sin(theta)
        t_x, t_y = e_x + p[2], e_y + p[3]
        if abs(cos_beta) < 1.0:
            b_x, b_y = b * np.cos(alpha + beta), b * np.sin(alpha + beta)
            # Rows of the inverse Jacobian, times 2 alpha and 2 beta: y by a displacement of t.
            scale = 2.0 / (a * b * np.sin(beta))
            by_x = scale * (alpha_read * b_x - beta_read * t_x)
            by_y = scale * (alpha_read * b_y - beta_read * t_y)
            slopes[i, 0] = by_x * np.cos(alpha) + by_y * np.sin(alpha)
            slopes[i, 1] = by_x * np.cos(alpha + beta) + by_y * np.sin(alpha + beta)
        else:
            turn = 2.0 * alpha_read / max(t_x * t_x + t_y * t_y, _NEAREST**2)
            by_x, by_y = -turn * t_y, turn * t_x
        slopes[i, 2] = -by_x
        slopes[i, 3] = -by_y
        slopes[i, 6] = by_x * e_y - by_y * e_x
