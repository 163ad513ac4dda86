"""Triangular systems for one row or many, to the same bit."""

import numpy as np
import pytest
from tests.networks.samples import fewer

from handeye.networks.recursive.linear import PANEL, substitute, subtract


def factor(n):
    return np.triu(np.random.default_rng(n).normal(size=(n, n))) + 2.0 * np.sqrt(n) * np.eye(n)


@pytest.mark.parametrize("n", [1, 7, 8, 21, fewer(300, 40)])
@pytest.mark.parametrize("rows", [1, 2, 5, PANEL])
def test_many_rows_are_solved_like_one(n, rows):
    U, right = factor(n), np.random.default_rng(rows).normal(size=(rows, n))
    together = right.copy()
    substitute(U, 0, n, together)
    np.testing.assert_allclose(together, np.linalg.solve(U.T, right.T).T, rtol=1e-9, atol=1e-12)
    for row, solved in zip(right, together, strict=True):
        one = row[np.newaxis].copy()
        substitute(U, 0, n, one)
        np.testing.assert_array_equal(one[0], solved)


@pytest.mark.parametrize("rows", [1, 2, 7])
def test_products_are_taken_off(rows):
    rng = np.random.default_rng(rows)
    matrix, by, out = rng.normal(size=(40, 600)), rng.normal(size=(rows, 40)), np.zeros((rows, 600))
    subtract(matrix, 3, 30, 5, 590, by, out)
    np.testing.assert_allclose(out[:, 5:590], -by[:, 3:30] @ matrix[3:30, 5:590], atol=1e-12)
    assert not out[:, :5].any()
    assert not out[:, 590:].any()
