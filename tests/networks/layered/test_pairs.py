"""Paired sigmoids (section A.6.6) against closed forms."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import ArrayLike

from handeye.errors import InvalidInput
from handeye.networks.layered import Pairs, fourier_network, gaussian_network, pair, paired_network
from handeye.networks.layered.pairs import HALF_WIDTH

GRID = np.linspace(-1.0, 1.0, 801)
PI = np.pi


def outputs(network, x: ArrayLike = GRID):
    return network.predict_many(np.asarray(x)[:, np.newaxis])[:, 0]


@given(st.floats(-20.0, 20.0), st.floats(0.1, 5.0), st.floats(0.1, 8.0))
def test_a_pair_in_closed_form(x, gain, apart):
    expected = 2.0 * np.sinh(gain * apart) / (np.cosh(2.0 * gain * x) + np.cosh(gain * apart))
    assert pair(x, gain, apart) == pytest.approx(expected, rel=1e-9, abs=1e-12)


def test_a_pair_is_one_period_of_a_sinusoid_and_vanishes_outside():
    inside, outside = np.linspace(-PI, PI, 4001), np.linspace(PI, 4 * PI, 4001)
    off = np.abs(pair(inside) - (1.0 + np.cos(inside)))
    assert off.max() == pytest.approx(2.0 - 2.0 * np.tanh(0.5 * PI), rel=1e-12)
    assert off.argmax() == 2000
    assert pair(outside).max() == pair(PI) == pytest.approx(np.tanh(1.5 * PI) - np.tanh(0.5 * PI))
    np.testing.assert_array_less(pair(outside), 4.001 * np.sinh(PI) * np.exp(-2.0 * outside))


def test_a_steep_pair_is_a_pulse_of_height_two():
    x = np.array([-2.0, -1.01, -0.99, 0.0, 0.99, 1.01, 2.0])
    np.testing.assert_allclose(pair(x, 1e3, 2.0), [0, 0, 2, 2, 2, 0, 0], atol=1e-8)


def test_thresholds_pi_apart_give_the_fourth_cumulant_of_a_gaussian():
    def excess(apart):
        x = np.linspace(-40.0, 40.0, 200_001)
        weight = pair(x, apart=apart) / pair(x, apart=apart).sum()
        second, fourth = (weight * x**2).sum(), (weight * x**4).sum()
        return second, fourth / second**2 - 3.0

    variance, at_pi = excess(PI)
    assert variance == pytest.approx(PI**2 / 6.0, rel=1e-9)
    assert abs(at_pi) < 1e-9
    assert excess(0.9 * PI)[1] > 0.05
    assert excess(1.1 * PI)[1] < -0.05


def test_the_half_width_is_where_a_pair_has_fallen_to_half():
    assert pair(HALF_WIDTH) == pytest.approx(0.5 * pair(0.0), rel=1e-12)


def test_a_network_of_pairs_is_their_sum():
    pairs = Pairs(np.array([2.0, 5.0]), np.array([-0.3, 0.6]), np.array([1.5, -0.4]))
    network = paired_network(3.0, 7.0, pairs, 0.25, output_scale=2.0)
    u = 0.5 * (np.linspace(3.0, 7.0, 101) - 5.0)
    expected = 0.25 + sum(
        height * pair(gain * (u - center)) for gain, center, height in zip(*pairs, strict=True)
    )
    np.testing.assert_allclose(outputs(network, 5.0 + 2.0 * u), expected, rtol=1e-12, atol=1e-12)
    assert network.hidden == (4,)


@pytest.mark.parametrize("n", [1, 2, 3, 4, 7])
@pytest.mark.parametrize("part", [0, 1])
def test_a_harmonic_is_as_close_to_its_sinusoid_as_a_pair(n, part):
    coefficients = np.zeros((n, 2))
    coefficients[-1, part] = 1.0
    network = fourier_network(-1.0, 1.0, n, coefficients)
    wanted = (np.cos, np.sin)[part](n * PI * GRID)
    off = np.abs(outputs(network) - wanted).max()
    assert off == pytest.approx(2.0 - 2.0 * np.tanh(0.5 * PI), rel=0.02)


def test_side_by_side_pairs_have_known_fourier_coefficients():
    """2 sin(n pi / 2) / sinh(n pi / 2): 0.87 of the sinusoid, no even harmonics, few odd ones."""
    x = np.linspace(-PI, PI, 4001)[:-1]
    row = sum((pair(x - 2.0 * PI * k) for k in range(-8, 9)), np.zeros_like(x))
    assert row.mean() == pytest.approx(1.0, rel=1e-12)
    for n in range(1, 8):
        expected = 2.0 * np.sin(0.5 * n * PI) / np.sinh(0.5 * n * PI)
        assert 2.0 * np.mean(row * np.cos(n * x)) == pytest.approx(expected, abs=1e-12)
    coefficients = np.zeros((5, 2))
    coefficients[-1, 0] = 1.0
    wave = outputs(fourier_network(-PI, PI, 5, coefficients), x)
    np.testing.assert_allclose(wave, np.interp(5.0 * x, x, row - 1.0, period=2 * PI), atol=0.083)


def test_a_series_adds_its_harmonics_and_its_constant():
    coefficients = np.array([[0.5, -1.0], [0.3, 0.2], [0.0, 0.4]])
    network = fourier_network(2.0, 6.0, 3, coefficients, constant=0.7)
    xi = PI * GRID
    series = 0.7 + sum(
        a * np.cos(n * xi) + b * np.sin(n * xi) for n, (a, b) in enumerate(coefficients, start=1)
    )
    apart = 0.17 * np.abs(coefficients).sum()
    assert np.abs(outputs(network, 4.0 + 2.0 * GRID) - series).max() < apart
    assert np.corrcoef(outputs(network, 4.0 + 2.0 * GRID), series)[0, 1] > 0.99


def test_coefficients_begin_at_one_over_the_order():
    given = fourier_network(-1.0, 1.0, 3, [[1.0, 1.0], [0.5, 0.5], [1 / 3, 1 / 3]])
    np.testing.assert_allclose(outputs(fourier_network(-1.0, 1.0, 3)), outputs(given), rtol=1e-12)


def test_gaussian_modules_are_spread_evenly_and_begin_with_no_weight():
    network = gaussian_network(0.0, 4.0, 5, half_max_fraction=1.0)
    np.testing.assert_array_equal(outputs(network, [0.0, 1.7]), 0.0)
    steep, shifts = network.weights[0].T
    np.testing.assert_allclose(-shifts[::2] / steep[::2] + 0.5 * PI / steep[::2],
                               np.linspace(-1, 1, 5), atol=1e-12)  # fmt: skip
    first, second = network.weights
    second[0, 4:6] = 1.0
    network.weights = [first, second]
    at = outputs(network, [1.0, 2.0, 3.0])
    np.testing.assert_allclose(at / at[1], [0.5, 1.0, 0.5], rtol=1e-12)


@pytest.mark.parametrize("make", [
    lambda: fourier_network(-1.0, 1.0, 4, rate=0.01),
    lambda: gaussian_network(-1.0, 1.0, 26, rate=0.01),
], ids=["fourier", "gaussian"])  # fmt: skip
def test_every_weight_and_threshold_learns(make):
    network, rng = make(), np.random.default_rng(0)
    before = network.weights
    x = rng.uniform(-1, 1, (4000, 1))
    triangle = 1.0 - np.abs(x)
    error = np.abs(network.learn_many(x, triangle).error)
    assert error[-500:].mean() < 0.1 * max(error[:50].mean(), 0.5)
    for new, old in zip(network.weights, before, strict=True):
        assert (new != old).all()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: fourier_network(1.0, -1.0, 3), "high > low"),
        (lambda: fourier_network(-1.0, 1.0, 0), "order"),
        (lambda: fourier_network(-1.0, 1.0, 2, [[1.0, 1.0]]), "coefficients must have shape"),
        (lambda: fourier_network(-1.0, 1.0, 2, constant=np.nan), "constant"),
        (lambda: gaussian_network(-1.0, 1.0, 1), "n_modules"),
        (lambda: gaussian_network(-1.0, 1.0, 5, 0.0), "half_max_fraction"),
        (lambda: paired_network(0.0, 1.0, Pairs(-np.ones(1), np.ones(1), np.ones(1))), "gains"),
        (lambda: paired_network(0.0, 1.0, Pairs(np.ones(2), np.ones(1), np.ones(2))), "centers"),
        (lambda: pair([0.0, np.nan]), "x must be finite"),
        (lambda: pair(0.0, gain=0.0), "gain"),
        (lambda: pair(0.0, apart=-1.0), "apart"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_what_cannot_be_built_is_refused(call, message):
    with pytest.raises(InvalidInput, match=message):
        call()
