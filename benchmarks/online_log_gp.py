"""Local Gaussian processes in a tree, after LoG-GP (Lederer, Ordonez Conejo, Maier, Xiao,
Umlauft and Hirche 2021): each leaf a process over at most so many samples, grown row by row.
"""  # noqa: D205

from typing import NamedTuple

import numba
import numpy as np


class Tree(NamedTuple):
    """Nodes: axis -1 marks a leaf. All leaves keep samples, the factor L and `K^-1 y`."""

    axis: np.ndarray
    middle: np.ndarray
    overlap: np.ndarray
    child: np.ndarray
    count: np.ndarray
    x: np.ndarray
    y: np.ndarray
    factor: np.ndarray
    solved: np.ndarray


class LogGP:
    """One Gaussian process a leaf, with the hyperparameters given.

    A full leaf is cut at the mean along its longest side. In a strip around the cut, `overlap` of
    the side, samples go to either child at random, with a probability that falls linearly;
    predictions are averaged by that probability over the predicted variance.
    """

    def __init__(
        self, scales: np.ndarray, signal: float, noise: float, n_outputs: int,
        points: int, samples: int, overlap: float = 0.05,
    ) -> None:  # fmt: skip
        nodes, d = 2 * (4 * samples // points + 2), len(scales)
        self.scales, self.signal, self.noise, self.overlap = scales, signal, noise, overlap
        self.used = np.ones(1, np.int64)
        self.tree = Tree(
            np.full(nodes, -1), np.zeros(nodes), np.zeros(nodes), np.zeros(nodes, np.int64),
            np.zeros(nodes, np.int64), np.zeros((nodes, points, d)),
            np.zeros((nodes, points, n_outputs)), np.zeros((nodes, points, points)),
            np.zeros((nodes, points, n_outputs)),
        )  # fmt: skip
        self.rng = np.random.default_rng(0)

    def learn_many(self, x: np.ndarray, y: np.ndarray) -> None:
        """In order."""
        x = x / self.scales
        dice = self.rng.random((len(x), 64))
        grow(self.tree, self.used, self.signal, self.noise, self.overlap, x, y, dice)

    def predict_many(self, x: np.ndarray) -> np.ndarray:
        """(N, m)."""
        out = np.zeros((len(x), self.tree.y.shape[2]))
        ask(self.tree, self.signal, self.noise, x / self.scales, out)
        return out


@numba.njit
def right_share(tree, node, x):
    """Probability of the right child."""
    away = x[tree.axis[node]] - tree.middle[node]
    if tree.overlap[node] <= 0.0:
        return 1.0 if away > 0.0 else 0.0
    return min(max(0.5 + away / tree.overlap[node], 0.0), 1.0)


@numba.njit
def covariances(tree, leaf, n, signal, x, k):
    """Of x with the first n samples of a leaf."""
    for i in range(n):
        z = 0.0
        for a in range(x.size):
            z += (tree.x[leaf, i, a] - x[a]) ** 2
        k[i] = signal * np.exp(-0.5 * z)


@numba.njit
def forward(factor, n, k):
    """`L^-1 k` in place."""
    for i in range(n):
        for j in range(i):
            k[i] -= factor[i, j] * k[j]
        k[i] /= factor[i, i]


@numba.njit
def append(tree, leaf, signal, noise, x, y):
    """One more row of the factor of a leaf."""
    n = tree.count[leaf]
    row = np.empty(n)
    covariances(tree, leaf, n, signal, x, row)
    forward(tree.factor[leaf], n, row)
    tree.factor[leaf, n, :n] = row
    tree.factor[leaf, n, n] = np.sqrt(max(signal + noise - (row * row).sum(), noise))
    tree.x[leaf, n], tree.y[leaf, n] = x, y
    tree.count[leaf] = n + 1


@numba.njit
def solve(tree, leaf):
    """`K^-1 y` of a leaf."""
    n, factor = tree.count[leaf], tree.factor[leaf]
    for k in range(tree.y.shape[2]):
        v = tree.y[leaf, :n, k].copy()
        forward(factor, n, v)
        for i in range(n - 1, -1, -1):
            v[i] /= factor[i, i]
            for j in range(i):
                v[j] -= factor[i, j] * v[i]
        tree.solved[leaf, :n, k] = v


@numba.njit
def split(tree, used, leaf, signal, noise, overlap, dice):
    """Cut a full leaf in two."""
    points = tree.x[leaf]
    widest, axis = -1.0, 0
    for a in range(points.shape[1]):
        side = points[:, a].max() - points[:, a].min()
        if side > widest:
            widest, axis = side, a
    tree.axis[leaf], tree.middle[leaf] = axis, points[:, axis].mean()
    tree.overlap[leaf], tree.child[leaf] = overlap * widest, used[0]
    used[0] += 2
    for i in range(len(points)):
        right = dice[i % dice.size] < right_share(tree, leaf, points[i])
        append(
            tree, tree.child[leaf] + (1 if right else 0), signal, noise, points[i], tree.y[leaf, i]
        )
    solve(tree, tree.child[leaf])
    solve(tree, tree.child[leaf] + 1)


@numba.njit
def grow(tree, used, signal, noise, overlap, x, y, dice):
    """Learn samples in order; with each, its leaf predicts anew."""
    for s in range(len(x)):
        node, depth = 0, 0
        while tree.axis[node] >= 0:
            right = dice[s, depth % 64] < right_share(tree, node, x[s])
            node, depth = tree.child[node] + (1 if right else 0), depth + 1
        append(tree, node, signal, noise, x[s], y[s])
        if tree.count[node] == tree.x.shape[1]:
            split(tree, used, node, signal, noise, overlap, dice[s])
        else:
            solve(tree, node)


@numba.njit
def ask(tree, signal, noise, x, out):
    """Predictions of the leaves that x can belong to, by probability over variance."""
    nodes, shares = np.empty(len(tree.axis), np.int64), np.empty(len(tree.axis))
    k = np.empty(tree.x.shape[1])
    for s in range(len(x)):
        nodes[0], shares[0], open_, total = 0, 1.0, 1, 0.0
        while open_ > 0:
            open_ -= 1
            node, share = nodes[open_], shares[open_]
            if tree.axis[node] >= 0:
                right = right_share(tree, node, x[s])
                for side, part in ((0, 1.0 - right), (1, right)):
                    if part > 0.0:
                        nodes[open_], shares[open_] = tree.child[node] + side, share * part
                        open_ += 1
                continue
            n = tree.count[node]
            covariances(tree, node, n, signal, x[s], k)
            mean = np.zeros(out.shape[1])
            for i in range(n):
                mean += k[i] * tree.solved[node, i]
            forward(tree.factor[node], n, k)
            weight = share / max(signal + noise - (k[:n] * k[:n]).sum(), noise)
            out[s] += weight * mean
            total += weight
        out[s] /= total
