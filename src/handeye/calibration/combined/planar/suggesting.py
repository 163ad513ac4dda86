"""Poses of the planar robot to choose from, as it would see them."""

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array, count
from handeye.calibration.combined.planar.kernels import PARAMETERS, Planar, camera_sum, joint_curves
from handeye.calibration.estimation.kernels import wrapped
from handeye.calibration.world import Region
from handeye.randomness import stream


@compiled
def expected_sightings(kernel: Planar, x: Array, seen: Array) -> None:
    """Pointing and range of rows (N, 5), overwritten, from their joints and eccentricities.

    What would be measured of the hand there without noise. The pointing encoder's own curve is
    undone to first order, which is enough to choose a pose.
    """
    p = kernel.nominal + x[:PARAMETERS]
    n_bearing = len(kernel.bearing_terms)
    first = PARAMETERS + 3 * kernel.n_curve
    terms = np.empty((3, kernel.n_curve))
    for i in range(len(seen)):
        seen[i, 2] = 0.0
        c_alpha, c_beta, _ = joint_curves(kernel, x, seen[i], terms)
        alpha = seen[i, 0] + p[4] + c_alpha
        both = alpha + seen[i, 1] + p[5] + c_beta
        e_x = p[0] * np.cos(alpha) + p[1] * np.cos(both) - p[2]
        e_y = p[0] * np.sin(alpha) + p[1] * np.sin(both) - p[3]
        d, eps = np.sqrt(e_x * e_x + e_y * e_y), seen[i, 4]
        c_eps, _ = camera_sum(kernel, eps, d, kernel.bearing_terms, x[first : first + n_bearing])
        c_r, _ = camera_sum(kernel, eps, d, kernel.range_terms, x[first + n_bearing :])
        straight = wrapped(np.arctan2(e_y, e_x) - eps - c_eps - p[6])
        seen[i, 2] = straight
        _, _, c_gamma = joint_curves(kernel, x, seen[i], terms)
        seen[i, 2] = straight - c_gamma
        seen[i, 3] = p[7] * d + c_r


def sightings_of(kernel: Planar, x: Array, region: Region, n: int) -> tuple[Array, Array]:
    """n poses (n, 3) of a region, joints and eccentricity, and what would be seen there (n, 5)."""
    joints, eccentricity = region.sample(count(n, "candidates"), stream("combined: candidates", n))
    poses = np.column_stack([joints, eccentricity])
    rows = np.zeros((n, 5))
    rows[:, :2], rows[:, 4] = joints, eccentricity
    expected_sightings(kernel, x, rows)
    return poses, rows
