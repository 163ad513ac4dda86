"""The compiled output against eq 3.58, within the bound that `kernels.evaluate` states."""

import math
from decimal import Decimal, localcontext

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from handeye.networks import kernels
from handeye.networks.responses import Gaussian
from handeye.networks.units import Units


def compiled_output(response, units, x):
    n = units.widths.size
    z, o, out = np.empty(n), np.empty(n), np.empty(len(units.weights))
    nearest = kernels.evaluate(response, units, n, x, z, o, out)
    return out, o, nearest


def bound(units, o, d):
    """2^-53 sum_j |w_j| (n o_j + d + 12), (m,)."""
    return 2.0**-53 * (np.abs(units.weights) * (o.size * o + d + 12)).sum(axis=1)


def exact_gaussian_output(units, x):
    """Eq 3.45 and 3.58 with 40 digits; what the stored numbers say, without any rounding."""
    with localcontext() as context:
        context.prec = 40
        outputs = [Decimal(0)] * len(units.weights)
        for j, R in enumerate(units.widths.tolist()):
            z = sum(
                ((Decimal(c) - Decimal(x_i)) ** 2)
                for c, x_i in zip(units.centers[:, j].tolist(), x.tolist(), strict=True)
            )
            o = (-z / Decimal(R)).exp()
            for k, w in enumerate(units.weights[:, j].tolist()):
                outputs[k] += Decimal(w) * o
        return outputs


def plain_output(response, units, x):
    """The same in doubles, one neuron after the other."""
    z = ((units.centers.T - x) ** 2).sum(axis=1)
    d, R = np.sqrt(z), units.widths
    with np.errstate(under="ignore"):
        o = {
            "Gaussian": lambda: np.exp(-z / R),
            "Cosine": lambda: np.where(d < R, (1 + np.cos(np.pi * np.minimum(d / R, 1))) / 2, 0),
            "Parabolic": lambda: np.select(
                [d <= R / 2, d <= R], [1 - 2 * (d / R) ** 2, 2 * (1 - d / R) ** 2], 0
            ),
        }[type(response).__name__]()
    return np.array([math.fsum(w * o) for w in units.weights])


def random_units(rng, n, d, m=2, spread=6.0):
    return Units(
        rng.normal(size=(d, n)), 10.0 ** rng.uniform(-spread, 2, n), rng.normal(size=(m, n))
    )


@given(st.integers(0, 2**32 - 1), st.integers(1, 60), st.integers(1, 7))
def test_gaussian_output_is_within_the_bound_of_the_exact_one(seed, n, d):
    rng = np.random.default_rng(seed)
    units, x = random_units(rng, n, d, spread=rng.uniform(-1, 6)), rng.normal(size=d)
    out, o, _ = compiled_output(Gaussian(), units, x)
    exact = exact_gaussian_output(units, x)
    for value, reference, most in zip(out.tolist(), exact, bound(units, o, d), strict=True):
        assert abs(Decimal(value) - reference) <= Decimal(most)


@pytest.mark.parametrize("n", [kernels.BLOCK - 1, kernels.BLOCK, 2 * kernels.BLOCK + 3])
def test_blocks_do_not_show(n):
    rng = np.random.default_rng(n)
    units, x = random_units(rng, n, 5, spread=0.0), rng.normal(size=5)
    out, o, nearest = compiled_output(Gaussian(), units, x)
    exact = exact_gaussian_output(units, x)
    for value, reference, most in zip(out.tolist(), exact, bound(units, o, 5), strict=True):
        assert abs(Decimal(value) - reference) <= Decimal(most)
    np.testing.assert_allclose(nearest, ((units.centers.T - x) ** 2).sum(axis=1).min(), rtol=1e-14)


@given(st.integers(0, 2**32 - 1), st.integers(1, 200), st.integers(1, 7))
def test_output_is_within_twice_the_bound_of_the_plain_formula(response, seed, n, d):
    rng = np.random.default_rng(seed)
    units, x = random_units(rng, n, d, spread=rng.uniform(-1, 3)), rng.normal(size=d)
    out, o, _ = compiled_output(response, units, x)
    assert (np.abs(out - plain_output(response, units, x)) <= 2 * bound(units, o, d)).all()


@given(st.floats(0.0, 1e100), st.floats(1e-150, 1e100))
def test_one_neuron_at_any_distance_over_any_width(response, distance, width):
    if distance / width * distance > 1e300 or distance / width > 1e150:
        width = max(distance, 1e-150)
    units = Units(np.array([[distance]]), np.array([width]), np.array([[-3.0]]))
    out, o, nearest = compiled_output(response, units, np.zeros(1))
    assert 0.0 <= o[0] <= 1.0
    assert nearest == distance * distance
    assert abs(out - plain_output(response, units, np.zeros(1))) <= 2 * bound(units, o, 1)
    if isinstance(response, Gaussian) and distance * distance / width > 708.0:
        assert o[0] == 0.0


def test_no_neuron_answers_zero_and_is_infinitely_far():
    out, _, nearest = compiled_output(
        Gaussian(), random_units(np.random.default_rng(0), 0, 2), np.zeros(2)
    )
    assert not out.any()
    assert nearest == math.inf


def test_the_nearest_is_found_among_equal_and_zero_distances():
    centers = np.array([[3.0, 1.0, 1.0, 0.5, 7.0]])
    units = Units(centers, np.ones(5), np.ones((1, 5)))
    for x, expected in ((0.0, 0.25), (0.5, 0.0), (1.0, 0.0), (100.0, 93.0**2)):
        assert compiled_output(Gaussian(), units, np.array([x]))[2] == expected
