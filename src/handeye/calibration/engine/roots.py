"""Square-root information arithmetic: triangular rows, folded into and loosened.

What is known of n unknowns d is the sum of squares `|R d - z|^2`, kept as one array (n, n + 1):
R, triangular, and z as its last column. R^T R is the information. Nothing that must stay positive
is ever subtracted from: rows are folded in by rotations.
"""

import numpy as np

from handeye._compiled import compiled, compiled_sums
from handeye.arrays import Array, Integers


@compiled
def absorb(root: Array, lines: Array) -> tuple[float, float]:
    """Fold lines (k, n + 1), on which `lines[:, :n] d = lines[:, n]` up to unit noise, into root.

    One Givens rotation for each line and unknown: O(k n^2). root (m, n + 1) is triangular with
    m <= n pivots, none negative; it is overwritten, and lines then hold what the pivots leave.
    Returns what the lines say of the root, when it has n pivots: the squared surprise
    `r^T S^-1 r` with S = I + H P H^T, and log sqrt(det S), by which the information grew.
    """
    left, growth = 0.0, 1.0
    width = root.shape[1]
    for i in range(len(lines)):
        line = lines[i]
        for j in range(len(root)):
            part = line[j]
            if part == 0.0:
                continue
            row = root[j]
            old = row[j]
            length = np.sqrt(old * old + part * part)
            c, s = old / length, part / length
            for k in range(j, width):
                above, below = row[k], line[k]
                row[k] = c * above + s * below
                line[k] = c * below - s * above
            if old > 0.0:  # not in a root that is being filled
                growth *= length / old
        left += line[width - 1] * line[width - 1]
    return left, np.log(growth)


@compiled_sums
def absorb_threes(root: Array, lines: Array) -> tuple[float, float]:
    """The same for a whole number of threes of lines and a root with n pivots, faster.

    One Householder reflection for three lines and an unknown, so that every row of the root is
    passed a third as often.
    """
    left, growth = 0.0, 1.0
    width = root.shape[1]
    for first in range(0, len(lines), 3):
        one, two, three = lines[first], lines[first + 1], lines[first + 2]
        for j in range(len(root)):
            a, b, c = one[j], two[j], three[j]
            squared = a * a + b * b + c * c
            if squared == 0.0:
                continue
            row = root[j]
            old = row[j]
            length = np.sqrt(old * old + squared)
            # The reflection of (old, a, b, c) on (length, 0, 0, 0) is along (v, a, b, c).
            v = -squared / (old + length)
            twice = 2.0 / (v * v + squared)
            for k in range(j, width):
                part = twice * (v * row[k] + a * one[k] + b * two[k] + c * three[k])
                row[k] -= v * part
                one[k] -= a * part
                two[k] -= b * part
                three[k] -= c * part
            growth *= length / old
        for i in range(3):
            left += lines[first + i, width - 1] ** 2
    return left, np.log(growth)


@compiled_sums
def minimum(root: Array, d: Array) -> None:
    """d (n,), overwritten: where `|R d - z|^2` is least."""
    n = len(root)
    for i in range(n - 1, -1, -1):
        row = root[i]
        total = row[n]
        for j in range(i + 1, n):
            total -= row[j] * d[j]
        d[i] = total / row[i]


@compiled
def spread_of(root: Array, lines: Array, out: Array) -> None:
    """out (k, n) = lines R^-1, overwritten: `out out^T` is the covariance H P H^T of lines (k, n).

    lines may have more columns; only the first n count.
    """
    n = len(root)
    whole = len(out) // 3 * 3
    for i in range(len(out)):
        for j in range(n):
            out[i, j] = lines[i, j]
    for first in range(0, whole, 3):
        one, two, three = out[first], out[first + 1], out[first + 2]
        for j in range(n):
            row = root[j]
            pivot = row[j]
            one[j] /= pivot
            two[j] /= pivot
            three[j] /= pivot
            a, b, c = one[j], two[j], three[j]
            for k in range(j + 1, n):
                one[k] -= a * row[k]
                two[k] -= b * row[k]
                three[k] -= c * row[k]
    for i in range(whole, len(out)):
        w = out[i]
        for j in range(n):
            row = root[j]
            w[j] /= row[j]
            part = w[j]
            for k in range(j + 1, n):
                w[k] -= part * row[k]


@compiled_sums
def surprise(values: Array, spread: Array) -> tuple[float, float]:
    """r^T S^-1 r and log sqrt(det S) for residuals values (k,), S = I + spread spread^T, (k, n)."""
    k = len(values)
    S = np.eye(k)
    for i in range(k):
        for j in range(i + 1):
            total = 0.0
            for c in range(spread.shape[1]):
                total += spread[i, c] * spread[j, c]
            S[i, j] += total
    # Cholesky in place, and forward substitution.
    squared, log_size = 0.0, 0.0
    y = np.empty(k)
    for i in range(k):
        for j in range(i + 1):
            for c in range(j):
                S[i, j] -= S[i, c] * S[j, c]
            if i == j:
                S[i, i] = np.sqrt(S[i, i])
            else:
                S[i, j] /= S[j, j]
        y[i] = values[i]
        for c in range(i):
            y[i] -= S[i, c] * y[c]
        y[i] /= S[i, i]
        squared += y[i] * y[i]
        log_size += np.log(S[i, i])
    return squared, log_size


@compiled
def wander(root: Array, m: int, step: float) -> None:
    """The first m unknowns move on: d' = phi d + w, w of variance step^2, phi^2 = 1 - step^2.

    With that phi, what no sighting tells stays as uncertain as the priors say, for ever. Touches
    m rows only, so it costs O(m^2 n).
    """
    n = len(root)
    phi = np.sqrt(1.0 - step * step)
    moves = np.zeros((m, m + n + 1))
    lines = np.zeros((m, m + n + 1))
    fresh = np.zeros((m, n + 1))
    rest = np.empty((m, n + 1))
    for i in range(m):
        moves[i, i] = 1.0 / step
        for j in range(i, n + 1):
            lines[i, m + j] = root[i, j] / phi if j < m else root[i, j]
        for j in range(i, m):
            lines[i, j] = -lines[i, m + j]
    absorb(moves, lines)
    for i in range(m):
        for j in range(n + 1):
            rest[i, j] = lines[i, m + j]
    absorb(fresh, rest)
    for i in range(m):
        for j in range(n + 1):
            root[i, j] = fresh[i, j]


@compiled
def loosen(root: Array, places: Integers, std: float) -> None:
    """The unknowns at places (m,) may have jumped: independent noise of std is added to them.

    Places below 0 are none.
    """
    n, m = len(root), len(places)
    moves = np.zeros((m + n, m + n + 1))
    lines = np.zeros((n, m + n + 1))
    for i in range(m):
        moves[i, i] = 1.0 / std
    for i in range(n):
        for j in range(m):
            if places[j] >= 0:
                lines[i, j] = -root[i, places[j]]
        for j in range(n + 1):
            lines[i, m + j] = root[i, j]
    absorb(moves, lines)
    for i in range(n):
        for j in range(n + 1):
            root[i, j] = moves[m + i, m + j]


@compiled
def fade(root: Array, keep: float) -> None:
    """Old information counts `keep` (0 to 1) as much, and the priors fill what is lost.

    R^T R becomes `keep R^T R + (1 - keep) I`, so that it never falls below the priors.
    """
    n = len(root)
    lines = np.zeros((n, n + 1))
    for i in range(n):
        lines[i, i] = np.sqrt(1.0 - keep)
        for j in range(n + 1):
            root[i, j] *= np.sqrt(keep)
    absorb(root, lines)
