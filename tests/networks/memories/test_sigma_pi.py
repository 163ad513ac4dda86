"""Sigma-pi units: the polynomial they stand for, its gradient, and their rule."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.polynomial import polynomial

from handeye.errors import InvalidInput
from handeye.networks.memories import AlbusCMAC, SigmaPi, monomials
from handeye.networks.outcomes import LearningDiverged

values = st.floats(-3.0, 3.0)


@given(x=st.tuples(values, values), seed=st.integers(0, 1000))
def test_the_output_is_the_polynomial(x, seed):
    # 1, x, y, x^2, xy, y^2, x^3, ...
    units = SigmaPi(2, 1, monomials(2, 3))
    w = np.random.default_rng(seed).normal(size=(4, 4)) * (np.add.outer(range(4), range(4)) <= 3)
    units.weights = [[w[p.count(0), p.count(1)] for p in units.products]]
    np.testing.assert_allclose(units.predict(x)[0], polynomial.polyval2d(x[0], x[1], w), atol=1e-11)
    ders = [polynomial.polyder(w, axis=axis) for axis in (0, 1)]
    slopes = [polynomial.polyval2d(x[0], x[1], np.asarray(der)) for der in ders]
    np.testing.assert_allclose(units.gradient(x)[0], slopes, atol=1e-11)


@given(x=st.tuples(*[values] * 4), seed=st.integers(0, 1000))
def test_the_gradient_is_that_of_the_output(x, seed):
    units = SigmaPi(4, 3, [(), (0, 1, 2, 3), (2,), (3, 3), (1, 3, 1)])
    units.weights = np.random.default_rng(seed).normal(size=(3, 5))
    step = 1e-6 * np.eye(4)
    ends = [units.predict_many(x + side * step) for side in (1.0, -1.0)]
    np.testing.assert_allclose(units.gradient(x), (ends[0] - ends[1]).T / 2e-6, atol=1e-6)


def test_at_zero_the_gradient_is_that_of_the_linear_part():
    units = SigmaPi(2, 1, [(0,), (0, 1), (1, 1)])
    units.weights = [[2.0, 3.0, 4.0]]
    np.testing.assert_array_equal(units.gradient([0.0, 0.0]), [[2.0, 0.0]])


def test_one_input_gates_another():
    units = SigmaPi(2, 1, [(0, 1)])
    units.weights = [[1.0]]
    np.testing.assert_array_equal(units.predict_many([[0.7, 1.0], [0.7, 0.0]]), [[0.7], [0.0]])


def test_learning_equals_its_formula():
    units = SigmaPi(2, 2, [(), (0,), (0, 1)], rate=0.3)
    units.weights = [[1.0, -2.0, 0.5], [0.0, 0.0, 3.0]]
    before, x, target = units.weights, np.array([0.4, -1.5]), np.array([2.0, -1.0])
    a = np.array([1.0, 0.4, -0.6])
    error = target - before @ a
    np.testing.assert_allclose(units.learn(x, target).error, error, rtol=1e-14)
    np.testing.assert_allclose(
        units.weights, before + 0.3 * np.outer(error, a) / (a @ a), rtol=1e-13
    )
    np.testing.assert_allclose(target - units.predict(x), 0.7 * error, rtol=1e-12)


def test_with_products_of_0_and_1_the_rule_is_that_of_cmac():
    # Four cells of a CMAC without hashing, as inputs that are 1 in the active ones.
    units = SigmaPi(4, 1, [(i,) for i in range(4)], rate=0.5)
    cmac = AlbusCMAC(1, 1, field=1.0, layers=2, slots=2 * 1009, rate=0.5)
    active = {0.25: [1, 0, 1, 0], 0.75: [1, 0, 0, 1], 1.25: [0, 1, 0, 1]}
    for x, target in [(0.25, 1.0), (0.75, -2.0), (1.25, 3.0), (0.25, 0.5)]:
        mine, theirs = units.learn(active[x], [target]), cmac.learn([x], [target])
        np.testing.assert_allclose(mine.error, theirs.error, rtol=1e-13)


def test_a_polynomial_is_found_from_samples():
    units = SigmaPi(2, 1, monomials(2, 2), rate=1.0)
    x = np.random.default_rng(0).uniform(-1.0, 1.0, (3000, 2))
    error = units.learn_many(x, 1.0 - 2.0 * x[:, [0]] * x[:, [1]]).error
    assert np.abs(error[-100:]).max() < 1e-6
    np.testing.assert_allclose(units.weights, [[1.0, 0.0, 0.0, 0.0, -2.0, 0.0]], atol=1e-5)


@given(d=st.integers(1, 4), degree=st.integers(0, 4))
def test_monomials_are_all_there_are_once(d, degree):
    products = monomials(d, degree)
    assert len(products) == len(set(products)) == math.comb(d + degree, degree)
    assert products[0] == ()
    assert all(len(one) <= len(two) for one, two in pairwise(products))


def test_where_every_product_is_nothing_nothing_is_learned():
    units = SigmaPi(2, 1, [(0, 1)])
    assert units.learn([0.0, 1.0], [3.0]).error == 3.0
    assert units.weights == 0.0


def test_inputs_whose_products_would_overflow_are_refused():
    units = SigmaPi(2, 1, monomials(2, 4))
    assert np.isfinite(units.predict([1e25, -1e25])).all()
    for call in (units.predict, units.gradient, lambda x: units.learn(x, [1.0])):
        with pytest.raises(InvalidInput, match="must not exceed 1e\\+25"):
            call([1.1e25, 0.0])


def test_what_diverges_stops_and_keeps_what_was_learned():
    units = SigmaPi(1, 1, [(0,)], rate=1.0)
    with pytest.raises(LearningDiverged, match="at sample 1 "):
        units.learn_many([[1e-90], [1e80], [1.0]], [[1e50], [0.0], [0.0]])
    assert units.trials == 1
    np.testing.assert_allclose(units.weights, [[1e140]])


@pytest.mark.parametrize(
    ("products", "settings", "says"),
    [
        ([], {}, "at least one product"),
        ([(0, 2)], {}, r"inputs \[2\] of only 2"),
        ([(-1,)], {}, "the input of a product"),
        ([(0,)], {"rate": 0.0}, "rate"),
        ([(0,)], {"rate": 1.5}, "at most 1"),
    ],
)
def test_settings_out_of_range_are_refused(products, settings, says):
    with pytest.raises(InvalidInput, match=says):
        SigmaPi(2, 1, products, **settings)


def test_weights_of_another_shape_are_refused_and_change_nothing():
    units = SigmaPi(2, 1, [(0,)])
    with pytest.raises(InvalidInput, match="weights"):
        units.weights = [[1.0, 2.0]]
    assert units.weights == 0.0
