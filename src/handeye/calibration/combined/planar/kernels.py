"""The planar robot as a chain of stages with a small learned function each, in compiled loops.

Unknowns x, in this order, as deviations from nominal except for the curves, which are nominally 0:

    a, b, v_x, v_y, O_alpha, O_beta, O_gamma, range_scale      as in estimation.parameters
    m weights each of the curves c_alpha, c_beta, c_gamma      over the axis's own reading [rad]
    weights of c_eps(eps, r) [rad] and c_r(eps, r) [m]         Legendre products

    alpha_act = alpha + O_alpha + c_alpha(alpha), beta_act alike          (eq 3.35 to 3.38)
    r_meas    = s d + c_r(eps_meas, d)                                    (eq 3.40)
    gamma_meas + O_gamma + c_gamma(gamma_meas) + eps_meas + c_eps(eps_meas, d) = arg(t - v)

with t the hand, d = |t - v|. An observation is a row (5,): alpha, beta, gamma, r, eps, measured.
"""

from typing import NamedTuple

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array, Integers
from handeye.calibration.combined.planar.curves import legendre, sine_slope, sine_terms
from handeye.calibration.engine.chain import reach, residuals
from handeye.calibration.estimation.kernels import wrapped

PARAMETERS = 8
_NEAREST = 1e-6
_DEGREES = 7
_SETTLED = 1e-13


class Planar(NamedTuple):
    """What the kernels know: sizes and the nominal head.

    nominal (8,); half, n_curve: the interval and number of terms of an axis's curve; bearing_terms
    and range_terms (p, 2): degrees of eccentricity and range of each Legendre product; field,
    middle and span: eccentricity [rad] and range [m] that are +-1 to them; pitch, baseline: pixel
    pitch over focal length, and metres (eq 3.24, 3.28).
    """

    nominal: Array
    half: float
    n_curve: int
    bearing_terms: Integers
    range_terms: Integers
    field: float
    middle: float
    span: float
    pitch: float
    baseline: float


@compiled
def camera_terms(kernel: Planar, eps: float, d: float, terms: Integers, out: Array) -> None:
    """out (2, p), overwritten: Legendre products at (eps, d), and their derivatives by d."""
    across, along = np.empty((2, _DEGREES)), np.empty((2, _DEGREES))
    legendre(eps / kernel.field, across[0], across[1])
    legendre((d - kernel.middle) / kernel.span, along[0], along[1])
    for i in range(len(terms)):
        p = across[0, terms[i, 0]]
        out[0, i] = p * along[0, terms[i, 1]]
        out[1, i] = p * along[1, terms[i, 1]] / kernel.span


@compiled
def camera_sum(
    kernel: Planar, eps: float, d: float, terms: Integers, weights: Array
) -> tuple[float, float]:
    """A camera curve and its derivative by d."""
    out = np.empty((2, len(terms)))
    camera_terms(kernel, eps, d, terms, out)
    value, slope = 0.0, 0.0
    for i in range(len(terms)):
        value += weights[i] * out[0, i]
        slope += weights[i] * out[1, i]
    return value, slope


@compiled
def noise(kernel: Planar, d: float, eps: float, doubt: float) -> tuple[float, float]:
    """Standard deviations of range [m] (eq 3.24) and bearing [rad] (eq 3.28), with the doubt."""
    c = np.cos(eps)
    along = np.hypot(d * d * c / kernel.baseline, d * c * np.sin(eps))
    range_std = kernel.pitch / np.sqrt(6.0) * along
    bearing_std = kernel.pitch / (2.0 * np.sqrt(6.0)) * c * c
    return np.hypot(range_std, doubt), np.hypot(bearing_std, doubt)


@compiled
def joint_curves(kernel: Planar, x: Array, seen: Array, terms: Array) -> tuple[float, float, float]:
    """terms (3, m), overwritten: sine terms at the three readings; returns the three errors."""
    m = kernel.n_curve
    total = np.zeros(3)
    for axis in range(3):
        sine_terms(seen[axis], kernel.half, terms[axis])
        at = PARAMETERS + axis * m
        for k in range(m):
            total[axis] += x[at + k] * terms[axis, k]
    return total[0], total[1], total[2]


@compiled
def hand_motion(
    k: int, alpha: float, both: float, t: tuple[float, float], b: tuple[float, float]
) -> tuple[float, float]:
    """The hand's displacement in the eye's frame by a, b, v_x, v_y, O_alpha or O_beta (k 0 to 5).

    t is the hand, b the second link.
    """
    if k == 0:
        return np.cos(alpha), np.sin(alpha)
    if k == 1:
        return np.cos(both), np.sin(both)
    if k == 2:
        return -1.0, 0.0
    if k == 3:
        return 0.0, -1.0
    if k == 4:
        return -t[1], t[0]
    return -b[1], b[0]


@residuals.of(Planar)
def planar_residuals(
    kernel: Planar, x: Array, seen: Array, doubt: float, values: Array, slopes: Array
) -> None:
    """Range and bearing residual of a sighting of the hand, and their derivatives."""
    p = kernel.nominal + x[:PARAMETERS]
    m, n_bearing = kernel.n_curve, len(kernel.bearing_terms)
    first = PARAMETERS + 3 * m
    terms = np.empty((3, m))
    c_alpha, c_beta, c_gamma = joint_curves(kernel, x, seen, terms)
    alpha = seen[0] + p[4] + c_alpha
    both = alpha + seen[1] + p[5] + c_beta
    b_x, b_y = p[1] * np.cos(both), p[1] * np.sin(both)
    t_x, t_y = p[0] * np.cos(alpha) + b_x, p[0] * np.sin(alpha) + b_y
    e_x, e_y = t_x - p[2], t_y - p[3]
    d = max(np.sqrt(e_x * e_x + e_y * e_y), _NEAREST)
    eps = seen[4]
    bearing, along = np.empty((2, n_bearing)), np.empty((2, len(kernel.range_terms)))
    camera_terms(kernel, eps, d, kernel.bearing_terms, bearing)
    camera_terms(kernel, eps, d, kernel.range_terms, along)
    c_eps, c_eps_d, c_r, c_r_d = 0.0, 0.0, 0.0, 0.0
    for i in range(n_bearing):
        c_eps += x[first + i] * bearing[0, i]
        c_eps_d += x[first + i] * bearing[1, i]
    for i in range(along.shape[1]):
        c_r += x[first + n_bearing + i] * along[0, i]
        c_r_d += x[first + n_bearing + i] * along[1, i]
    range_std, bearing_std = noise(kernel, d, eps, doubt)
    theta = seen[2] + p[6] + c_gamma + eps + c_eps
    values[0] = (seen[3] - p[7] * d - c_r) / range_std
    values[1] = wrapped(theta - np.arctan2(e_y, e_x)) / bearing_std
    slopes[:, :] = 0.0
    by_d = -(p[7] + c_r_d) / range_std
    for k in range(6):
        d_x, d_y = hand_motion(k, alpha, both, (t_x, t_y), (b_x, b_y))
        farther = (e_x * d_x + e_y * d_y) / d
        slopes[0, k] = by_d * farther
        slopes[1, k] = (c_eps_d * farther - (e_x * d_y - e_y * d_x) / (d * d)) / bearing_std
    slopes[1, 6] = 1.0 / bearing_std
    slopes[0, 7] = -d / range_std
    for k in range(m):
        for axis in range(2):
            at = PARAMETERS + axis * m + k
            slopes[0, at] = slopes[0, 4 + axis] * terms[axis, k]
            slopes[1, at] = slopes[1, 4 + axis] * terms[axis, k]
        slopes[1, PARAMETERS + 2 * m + k] = terms[2, k] / bearing_std
    for i in range(n_bearing):
        slopes[1, first + i] = bearing[0, i] / bearing_std
    for i in range(along.shape[1]):
        slopes[0, first + n_bearing + i] = -along[0, i] / range_std


@compiled
def located(kernel: Planar, x: Array, seen: Array) -> tuple[float, float]:
    """Range d and direction theta from the eye of what is seen (5,): the stages undone."""
    m, n_bearing = kernel.n_curve, len(kernel.bearing_terms)
    first = PARAMETERS + 3 * m
    scale = kernel.nominal[7] + x[7]
    d, eps = seen[3] / scale, seen[4]
    for _ in range(20):
        c_r, c_r_d = camera_sum(kernel, eps, d, kernel.range_terms, x[first + n_bearing :])
        move = (seen[3] - scale * d - c_r) / (scale + c_r_d)
        d += move
        if abs(move) < _SETTLED:
            break
    c_eps, _ = camera_sum(kernel, eps, d, kernel.bearing_terms, x[first : first + n_bearing])
    c_gamma, _ = sine_slope(seen[2], kernel.half, x[PARAMETERS + 2 * m : PARAMETERS + 3 * m])
    return d, seen[2] + kernel.nominal[6] + x[6] + c_gamma + eps + c_eps


@compiled
def reading_at(kernel: Planar, x: Array, axis: int, actual: float) -> float:
    """What the encoder of an arm joint (0 or 1) reads with the joint at `actual`, in (-pi, pi]."""
    at = PARAMETERS + axis * kernel.n_curve
    weights = x[at : at + kernel.n_curve]
    straight = actual - kernel.nominal[4 + axis] - x[4 + axis]
    reading = wrapped(straight)
    for _ in range(20):
        error, slope = sine_slope(reading, kernel.half, weights)
        move = wrapped(straight - reading - error) / max(1.0 + slope, 0.5)
        reading += move
        if abs(move) < _SETTLED:
            break
    return wrapped(reading)


@compiled
def planar_command(kernel: Planar, x: Array, seen: Array, joints: Array) -> None:
    """Encoder readings joints (2,), overwritten, for the sighting seen (5,); seen[1] is the elbow.

    Eq 3.11 to 3.17 with every learned function undone. A place out of reach is answered with the
    arm stretched towards it or folded.
    """
    a, b = kernel.nominal[0] + x[0], kernel.nominal[1] + x[1]
    d, theta = located(kernel, x, seen)
    t_x = d * np.cos(theta) + kernel.nominal[2] + x[2]
    t_y = d * np.sin(theta) + kernel.nominal[3] + x[3]
    squared = t_x * t_x + t_y * t_y
    elbow = 1.0 if seen[1] >= 0.0 else -1.0
    cos_beta = (squared - a * a - b * b) / (2.0 * a * b)
    cos_phi = (squared + a * a - b * b) / (2.0 * a * max(np.sqrt(squared), _NEAREST))
    beta = elbow * np.arccos(min(max(cos_beta, -1.0), 1.0))
    phi = np.arccos(min(max(cos_phi, -1.0), 1.0))
    joints[0] = reading_at(kernel, x, 0, np.arctan2(t_y, t_x) - elbow * phi)
    joints[1] = reading_at(kernel, x, 1, beta)


@reach.of(Planar)
def planar_reach(kernel: Planar, x: Array, seen: Array, doubt: float, out: Array) -> None:
    """Along and across the line of sight, turned into the base frame."""
    d, theta = located(kernel, x, seen)
    range_std, bearing_std = noise(kernel, d, seen[4], doubt)
    along, across = range_std / (kernel.nominal[7] + x[7]), d * bearing_std
    out[0, 0], out[1, 0] = along * np.cos(theta), along * np.sin(theta)
    out[0, 1], out[1, 1] = -across * np.sin(theta), across * np.cos(theta)
