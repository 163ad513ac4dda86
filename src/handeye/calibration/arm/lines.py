"""The equations of a system as straight lines about a point, weighted, in units of tolerances."""

from typing import NamedTuple

import numpy as np
from scipy.linalg import LinAlgError, cholesky
from scipy.linalg.blas import dsyrk

from handeye.arrays import Array, Booleans
from handeye.calibration.arm.student import Noise
from handeye.calibration.arm.system import Rows, System

# Sums over many rows lose more than a single one.
_ROUNDING = 10.0


class Lines(NamedTuple):
    """Weighted equations of each channel about a point: S (C, n, n), J^T r (C, n), r^2 (C,).

    values (C,): how many there are; stated (C,): share of their variance that was stated; tails
    (C,) what tails leave of information.
    """

    information: Array
    gradient: Array
    squares: Array
    values: Array
    stated: Array
    tails: Array


def lines_at(system: System, x: Array, noise: Noise, used: Booleans) -> Lines:
    """All equations, linearised at x (n,), by channel."""
    n, C = int(used.sum()), system.n_channels
    sums, g = [np.zeros((n, n), order="F") for _ in range(C)], np.zeros((C, n))
    squares, values, stated = np.zeros(C), np.zeros(C), np.zeros(C)
    for rows in system.rows(x):
        r, J = whitened(rows, system.tolerance, noise, used)
        for c in np.unique(rows.channels):
            own = rows.channels == c
            flat = np.ascontiguousarray(J[:, own]).reshape(-1, n)
            wanted = r[:, own].reshape(-1)
            sums[c] = dsyrk(1.0, flat.T, beta=1.0, c=sums[c], overwrite_c=1, lower=True)
            g[c] += flat.T @ wanted
            squares[c] += wanted @ wanted
            values[c] += len(wanted)
            variance = rows.std[:, own] ** 2
            stated[c] += np.sum(variance / (variance + noise.noise[c] ** 2))
    S = np.array([part + np.tril(part, -1).T for part in sums])
    return Lines(S, g, squares, values, stated / np.maximum(values, 1.0), noise.tails)


def whitened(rows: Rows, tau: Array, noise: Noise, used: Booleans) -> tuple[Array, Array]:
    """Residuals (M, k) and slopes (M, k, n) of used unknowns in tolerances, weighted."""
    inside = slice(rows.first, rows.first + len(rows.residuals))
    weights = noise.weights()[inside][:, rows.channels]
    scale = np.sqrt(weights / (rows.std**2 + noise.noise[rows.channels] ** 2))
    slopes = rows.slopes if used.all() else rows.slopes[:, :, used]
    return rows.residuals * scale, slopes * (scale[..., np.newaxis] * tau[used])


def root_of(information: Array, width: Array) -> Array:
    """(n, n) lower triangular, root root^T = information + diag(1 / width^2).

    Of rows without noise, information is so great that rounding hides the prior: there, what
    rounding loses is added.
    """
    whole = information + np.diag(width**-2.0)
    try:
        return cholesky(whole, lower=True)
    except LinAlgError:
        lost = len(whole) * np.finfo(np.float64).eps * np.max(np.diag(whole))
        return cholesky(whole + _ROUNDING * lost * np.eye(len(whole)), lower=True)
