"""Triangular systems, solved for one right-hand side or several with the same rounding.

Every number is summed in the same order however many rows are solved together, so a stream learned
at once is, to the bit, the stream learned one by one.
"""

import numpy as np
from scipy.linalg import LinAlgError, cholesky, solve_triangular
from scipy.linalg.blas import dsyrk
from scipy.linalg.lapack import dpotrf

from handeye._compiled import compiled
from handeye.arrays import Array

DEPTH = 8
"""Rows of a factor taken off at a time: what is left is then read and written once for all."""

_TILE = 256  # so many numbers of each of them stay in the first-level cache for all rows


@compiled
def subtract(matrix: Array, start: int, stop: int, low: int, high: int, by: Array, out: Array) -> None:  # fmt: skip  # noqa: E501
    """`out[s, low:high] -= sum_k by[s, k] matrix[k, low:high]`, k from start to stop."""
    deep = start + (stop - start) // DEPTH * DEPTH
    for k in range(start, deep, DEPTH):
        for left in range(low, high, _TILE):
            right = min(left + _TILE, high)
            m0, m1 = matrix[k, left:right], matrix[k + 1, left:right]
            m2, m3 = matrix[k + 2, left:right], matrix[k + 3, left:right]
            m4, m5 = matrix[k + 4, left:right], matrix[k + 5, left:right]
            m6, m7 = matrix[k + 6, left:right], matrix[k + 7, left:right]
            for s in range(len(by)):
                b0, b1, b2, b3 = by[s, k], by[s, k + 1], by[s, k + 2], by[s, k + 3]
                b4, b5, b6, b7 = by[s, k + 4], by[s, k + 5], by[s, k + 6], by[s, k + 7]
                row = out[s, left:right]
                for i in range(right - left):
                    # One fused operation each: the sum of the products first would take one more.
                    left_over = row[i] - m0[i] * b0
                    left_over -= m1[i] * b1
                    left_over -= m2[i] * b2
                    left_over -= m3[i] * b3
                    left_over -= m4[i] * b4
                    left_over -= m5[i] * b5
                    left_over -= m6[i] * b6
                    row[i] = left_over - m7[i] * b7
    for k in range(deep, stop):
        for s in range(len(by)):
            for i in range(low, high):
                out[s, i] -= matrix[k, i] * by[s, k]


@compiled
def substitute(factor: Array, start: int, stop: int, rows: Array) -> None:
    """Every row r (s, at least stop), in place, becomes `U^-T r`, U the upper triangle of factor.

    From entry `start`, a multiple of DEPTH, whose predecessors are solved and taken off, to `stop`.
    """
    for k in range(start, stop, DEPTH):
        end = min(k + DEPTH, stop)
        for s in range(len(rows)):
            for a in range(k, end):
                for b in range(k, a):
                    rows[s, a] -= factor[b, a] * rows[s, b]
                rows[s, a] /= factor[a, a]
        if end < stop:
            subtract(factor, k, end, end, stop, rows, rows)


@compiled
def squared_norm(row: Array, n: int) -> float:
    """|row[:n]|^2."""
    total = 0.0
    for i in range(n):
        total += row[i] * row[i]
    return total


def back_substituted(factor: Array, columns: Array) -> Array:
    """`U^-1 c` for every column c of (n, m), U the upper triangle of factor (n, n)."""
    return np.asarray(solve_triangular(factor, columns, check_finite=False))


def whitened(factor: Array, columns: Array) -> Array:
    """`U^-T c` for every column c of (n, m)."""
    return np.asarray(solve_triangular(factor, columns, trans=1, check_finite=False))


def upper_factor(matrix: Array) -> Array:
    """U of `matrix = U^T U`, reading the upper triangle only; zeros below the diagonal.

    Raises numpy.linalg.LinAlgError if the matrix is not positive to rounding.
    """
    return np.asarray(cholesky(matrix, check_finite=False))


def factorize(matrix: Array) -> None:
    """The same in the place of the matrix, whose lower triangle becomes anything."""
    # LAPACK counts columns first: to it this is the transpose, and upper is lower.
    factor, failed = dpotrf(matrix.T, lower=1, clean=0, overwrite_a=1)
    if failed:
        raise LinAlgError("the information is not positive")
    if not np.shares_memory(factor, matrix):
        matrix[...] = factor.T


def add_squares(matrix: Array, rows: Array, keep: float) -> None:
    """The upper triangle of matrix (n, n), in place, becomes keep times itself plus rows^T rows."""
    # BLAS counts columns first: to it both arrays are their transposes, and upper is lower.
    out = dsyrk(1.0, rows.T, beta=keep, c=matrix.T, lower=1, overwrite_c=1)
    if not np.shares_memory(out, matrix):
        matrix[...] = out.T


def symmetric(matrix: Array) -> Array:
    """A full matrix from its upper triangle."""
    return np.triu(matrix) + np.triu(matrix, 1).T
