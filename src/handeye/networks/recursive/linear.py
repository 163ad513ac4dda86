"""Triangular systems, solved for one right-hand side or several with the same rounding.

Every number is summed in the same order however many rows are solved together, so a stream learned
at once is, to the bit, the stream learned one by one.
"""

import numpy as np
from scipy.linalg import cholesky
from scipy.linalg.blas import dsymm, dsyrk
from scipy.linalg.lapack import dpotrf, dtrtrs

from handeye._compiled import compiled, compiled_sums
from handeye.arrays import Array

DEPTH = 8
"""Rows of a factor taken off at a time: what is left is then read and written once for all."""

PANEL = 128
"""Most rows solved together: the factor is then read from memory once for all of them."""

_TILE = 256  # so many numbers of each row of the factor stay in the first-level cache for all rows


@compiled
def _subtract_one(matrix: Array, k: int, low: int, high: int, by: Array, out: Array) -> None:
    """DEPTH rows of the matrix, from row k on, taken off one row."""
    m0, m1 = matrix[k, low:high], matrix[k + 1, low:high]
    m2, m3 = matrix[k + 2, low:high], matrix[k + 3, low:high]
    m4, m5 = matrix[k + 4, low:high], matrix[k + 5, low:high]
    m6, m7 = matrix[k + 6, low:high], matrix[k + 7, low:high]
    b0, b1, b2, b3 = by[k], by[k + 1], by[k + 2], by[k + 3]
    b4, b5, b6, b7 = by[k + 4], by[k + 5], by[k + 6], by[k + 7]
    row = out[low:high]
    for i in range(high - low):
        # One fused operation each: the sum of the products first would take one more.
        left_over = row[i] - m0[i] * b0
        left_over -= m1[i] * b1
        left_over -= m2[i] * b2
        left_over -= m3[i] * b3
        left_over -= m4[i] * b4
        left_over -= m5[i] * b5
        left_over -= m6[i] * b6
        row[i] = left_over - m7[i] * b7


@compiled
def _subtract_pairs(matrix: Array, k: int, low: int, high: int, by: Array, out: Array) -> None:
    """The same for rows two by two, which halves the reading; an odd one at the end stays."""
    taken = np.empty((DEPTH, _TILE))  # the compiler sees that no row is part of it
    for left in range(low, high, _TILE):
        right = min(left + _TILE, high)
        for a in range(DEPTH):
            m = matrix[k + a, left:right]
            for i in range(right - left):
                taken[a, i] = m[i]
        for s in range(0, len(by) - 1, 2):
            b0, b1, b2, b3 = by[s, k], by[s, k + 1], by[s, k + 2], by[s, k + 3]
            b4, b5, b6, b7 = by[s, k + 4], by[s, k + 5], by[s, k + 6], by[s, k + 7]
            c0, c1, c2, c3 = by[s + 1, k], by[s + 1, k + 1], by[s + 1, k + 2], by[s + 1, k + 3]
            c4, c5, c6, c7 = by[s + 1, k + 4], by[s + 1, k + 5], by[s + 1, k + 6], by[s + 1, k + 7]
            row, next_row = out[s, left:right], out[s + 1, left:right]
            for i in range(right - left):
                m0, m1, m2, m3 = taken[0, i], taken[1, i], taken[2, i], taken[3, i]
                m4, m5, m6, m7 = taken[4, i], taken[5, i], taken[6, i], taken[7, i]
                one = row[i] - m0 * b0
                two = next_row[i] - m0 * c0
                one -= m1 * b1
                two -= m1 * c1
                one -= m2 * b2
                two -= m2 * c2
                one -= m3 * b3
                two -= m3 * c3
                one -= m4 * b4
                two -= m4 * c4
                one -= m5 * b5
                two -= m5 * c5
                one -= m6 * b6
                two -= m6 * c6
                row[i] = one - m7 * b7
                next_row[i] = two - m7 * c7


@compiled
def subtract(matrix: Array, start: int, stop: int, low: int, high: int, by: Array, out: Array) -> None:  # fmt: skip  # noqa: E501
    """`out[s, low:high] -= sum_k by[s, k] matrix[k, low:high]`, k from start to stop."""
    deep = start + (stop - start) // DEPTH * DEPTH
    for k in range(start, deep, DEPTH):
        if len(by) > 1:
            _subtract_pairs(matrix, k, low, high, by, out)
        if len(by) % 2 == 1:
            _subtract_one(matrix, k, low, high, by[-1], out[-1])
    for k in range(deep, stop):
        for s in range(len(by)):
            for i in range(low, high):
                out[s, i] -= matrix[k, i] * by[s, k]


@compiled
def _triangle(factor: Array, start: int, stop: int, rows: Array) -> None:
    """`rows[:, start:stop]` solved with the triangle of at most DEPTH rows on the diagonal."""
    if len(rows) == 1:
        row = rows[0]
        for b in range(start, stop):
            row[b] /= factor[b, b]
            for a in range(b + 1, stop):
                row[a] -= factor[b, a] * row[b]
        return
    solved = np.empty((DEPTH, PANEL))
    for s in range(len(rows)):
        for a in range(stop - start):
            solved[a, s] = rows[s, start + a]
    for a in range(stop - start):
        for b in range(a):
            above = factor[start + b, start + a]
            for s in range(len(rows)):
                solved[a, s] -= above * solved[b, s]
        own = factor[start + a, start + a]
        for s in range(len(rows)):
            solved[a, s] /= own
    for s in range(len(rows)):
        for a in range(stop - start):
            rows[s, start + a] = solved[a, s]


@compiled
def substitute(factor: Array, start: int, stop: int, rows: Array) -> None:
    """Every row r (s, at least stop), in place, becomes `U^-T r`, U the upper triangle of factor.

    From entry `start`, a multiple of DEPTH, whose predecessors are solved and taken off, to `stop`;
    at most PANEL rows.
    """
    for k in range(start, stop, DEPTH):
        end = min(k + DEPTH, stop)
        _triangle(factor, k, end, rows)
        if end < stop:
            subtract(factor, k, end, end, stop, rows, rows)


@compiled_sums
def squared_norm(row: Array, n: int) -> float:
    """|row[:n]|^2."""
    total = 0.0
    for i in range(n):
        total += row[i] * row[i]
    return total


# LAPACK and BLAS count columns first: to them a matrix is its transpose, and upper is lower.


def back_substituted(factor: Array, columns: Array) -> Array:
    """`U^-1 c` for every column c of (n, m), U the upper triangle of factor (n, n)."""
    return np.asarray(dtrtrs(factor.T, columns, lower=1, trans=1)[0])


def whitened(factor: Array, columns: Array) -> Array:
    """`U^-T c` for every column c of (n, m)."""
    return np.asarray(dtrtrs(factor.T, columns, lower=1)[0])


def upper_factor(matrix: Array) -> Array:
    """U of `matrix = U^T U`, reading the upper triangle only; zeros below the diagonal.

    Raises numpy.linalg.LinAlgError if the matrix is not positive to rounding.
    """
    return np.asarray(cholesky(matrix, check_finite=False))


def factorize(matrix: Array) -> bool:
    """The same in the place of the matrix, whose lower triangle becomes anything; False if not."""
    factor, failed = dpotrf(matrix.T, lower=1, clean=0, overwrite_a=1)
    if not np.shares_memory(factor, matrix):
        matrix[...] = factor.T
    return not failed


def add_squares(matrix: Array, rows: Array, keep: float) -> None:
    """The upper triangle of matrix (n, n), in place, becomes keep times itself plus rows^T rows."""
    out = dsyrk(1.0, rows.T, beta=keep, c=matrix.T, lower=1, overwrite_c=1)
    if not np.shares_memory(out, matrix):
        matrix[...] = out.T


def symmetric_product(matrix: Array, columns: Array) -> Array:
    """A symmetric matrix (n, n), of which the upper triangle is read, times columns (n, m)."""
    return np.asarray(dsymm(1.0, matrix.T, columns, lower=1))


def symmetric(matrix: Array) -> Array:
    """A full matrix from its upper triangle."""
    return np.triu(matrix) + np.triu(matrix, 1).T
