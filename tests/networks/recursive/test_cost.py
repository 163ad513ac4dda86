"""Work per sample, counted, not timed."""

import numpy as np
import pytest

from handeye.networks.recursive import kernels, linear
from handeye.networks.recursive.units import Pending, Scratch, Units

KNOWN = 4


class Counted(float):
    """A number that counts products and quotients."""

    count = 0

    def __mul__(self, other):
        Counted.count += 1
        return Counted(float(self) * float(other))

    def __truediv__(self, other):
        Counted.count += 1
        return Counted(float(self) / float(other))

    def __sub__(self, other):
        return Counted(float(self) - float(other))


def plain(kernel):
    return getattr(kernel, "py_func", kernel)


@pytest.fixture(autouse=True)
def _uncompiled(monkeypatch):
    for name in ("_subtract_one", "_triangle", "subtract", "substitute"):
        for module in (linear, kernels):
            monkeypatch.setattr(module, name, plain(getattr(linear, name)), raising=False)


def counted(array):
    return np.array([Counted(v) for v in np.ravel(array)], dtype=object).reshape(np.shape(array))


def of_triangle(n):
    rng = np.random.default_rng(n)
    factor = np.triu(rng.normal(size=(n, n))) + 5.0 * np.eye(n)
    row = rng.normal(size=(1, n))
    numbers, Counted.count = counted(row), 0
    linear.substitute(counted(factor), 0, n, numbers)
    np.testing.assert_allclose(numbers.astype(float)[0], np.linalg.solve(factor.T, row[0]))
    return Counted.count


def of_sample(n, block):
    """Solving for one sample with n neurons in blocks."""
    blocks = n // block
    factor = counted(np.tile(np.eye(block), (blocks, 1, 1)))
    units = Units(np.empty(0), np.empty(0), np.full(blocks, block), factor)
    pending = Pending(np.empty(0), counted(np.zeros((blocks, block, KNOWN))),
                      np.empty(0), np.empty(0))  # fmt: skip
    scratch = Scratch(np.empty(0), np.empty(0), counted(np.ones((1, block))),
                      counted(np.zeros((1, KNOWN))), np.empty(0))  # fmt: skip
    Counted.count = 0
    for b in range(blocks):
        plain(kernels.solve_block)(units, pending, b, KNOWN, scratch, 1)
    return Counted.count


@pytest.mark.parametrize("n", [1, 7, 8, 9, 30])
def test_a_triangle_takes_half_its_square(n):
    assert of_triangle(n) == n * (n + 1) // 2


def test_the_cost_grows_like_the_neurons_in_blocks_of_a_size():
    counts = [of_sample(n, 8) for n in (16, 32, 64)]
    assert counts == [n * (9 / 2 + KNOWN) for n in (16, 32, 64)]


def test_the_cost_grows_like_their_square_in_one_block():
    counts = [of_sample(n, n) for n in (16, 32, 64)]
    assert counts == [n * ((n + 1) / 2 + KNOWN) for n in (16, 32, 64)]
