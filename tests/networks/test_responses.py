"""Responses, their widths and slopes against the formulas of sections 3.5.1, 3.5.3 and 3.5.9."""

import math
from decimal import Decimal, localcontext
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from handeye._compiled import compiled
from handeye.networks.responses import Gaussian, respond, slopes, width

R_VALUES = np.array([1e-12, 1e-3, 0.37, 1.0, 2.5, 1e6])


@compiled
def compiled_respond(response, z, widths, out):
    respond(response, z, widths, out)


@compiled
def compiled_slopes(response, z, widths, by_z, by_width):
    slopes(response, z, widths, by_z, by_width)


@compiled
def compiled_width(response, half_distance):
    return width(response, half_distance)


def gaussian(z, R):
    """Eq 3.45."""
    return math.exp(-z / R)


def cosine(z, R):
    """Eq 3.107."""
    d = math.sqrt(z)
    return 0.5 * (1.0 + math.cos(math.pi * d / R)) if d < R else 0.0


def parabolic(z, R):
    """Eq 3.108."""
    d = math.sqrt(z)
    if d <= R / 2:
        return 1.0 - 2.0 * (d / R) ** 2
    return 2.0 * (1.0 - d / R) ** 2 if d <= R else 0.0


def gaussian_slopes(z, R):
    """Eq 3.62 and 3.63."""
    return -math.exp(-z / R) / R, z / R**2 * math.exp(-z / R)


def cosine_slopes(z, R):
    """Eq 3.109 and 3.110, z > 0."""
    d = math.sqrt(z)
    if d >= R:
        return 0.0, 0.0
    s = math.sin(math.pi * d / R)
    return -math.pi * s / (4 * R * d), math.pi * d * s / (2 * R**2)


def parabolic_slopes(z, R):
    """Eq 3.111 and 3.112."""
    d = math.sqrt(z)
    if d < R / 2:
        return -2 / R**2, 4 * d**2 / R**3
    if d <= R:
        return -2 * (R - d) / (d * R**2), 4 * (R - d) * d / R**3
    return 0.0, 0.0


FORMULA = {"Gaussian": gaussian, "Cosine": cosine, "Parabolic": parabolic}
SLOPES = {"Gaussian": gaussian_slopes, "Cosine": cosine_slopes, "Parabolic": parabolic_slopes}
WIDTH = {
    "Gaussian": lambda half: half**2 / math.log(2),
    "Cosine": lambda half: 2 * half,
    "Parabolic": lambda half: 2 * half,
}


def name(response):
    return type(response).__name__


def distances(response, R):
    """Squared distances on every branch of the formula, away from the joints."""
    fractions = np.array([0.013, 0.2, 0.45, 0.499, 0.501, 0.7, 0.95, 0.999, 1.001, 1.3, 4.0, 20.0])
    scale = math.sqrt(R) if isinstance(response, Gaussian) else R
    return (fractions * scale) ** 2


@pytest.mark.parametrize("R", R_VALUES)
def test_response_equals_its_formula(response, R):
    z = np.append(distances(response, R), 0.0)
    out = np.full_like(z, np.nan)
    compiled_respond(response, z, np.full_like(z, R), out)
    expected = [FORMULA[name(response)](z_j, R) for z_j in z]
    np.testing.assert_allclose(out, expected, rtol=1e-12, atol=1e-15)
    assert out[-1] == 1.0


@pytest.mark.parametrize("R", R_VALUES)
def test_slopes_equal_their_formulas(response, R):
    z = distances(response, R)
    by_z, by_width = np.full_like(z, np.nan), np.full_like(z, np.nan)
    compiled_slopes(response, z, np.full_like(z, R), by_z, by_width)
    expected = np.array([SLOPES[name(response)](z_j, R) for z_j in z]).T
    for slope, formula in zip((by_z, by_width), expected, strict=True):
        np.testing.assert_allclose(slope, formula, rtol=1e-12, atol=1e-12 * np.abs(formula).max())


@pytest.mark.parametrize("R", [0.01, 1.0, 50.0])
def test_slopes_equal_central_differences(response, R):
    formula = FORMULA[name(response)]
    z = distances(response, R)
    by_z, by_width = np.empty_like(z), np.empty_like(z)
    compiled_slopes(response, z, np.full_like(z, R), by_z, by_width)
    for j, z_j in enumerate(z):
        step_z, step_width = 1e-5 * z_j, 1e-5 * R
        difference = (formula(z_j + step_z, R) - formula(z_j - step_z, R)) / (2 * step_z)
        assert by_z[j] == pytest.approx(difference, rel=1e-5, abs=1e-5 / z_j)
        difference = (formula(z_j, R + step_width) - formula(z_j, R - step_width)) / (
            2 * step_width
        )
        assert by_width[j] == pytest.approx(difference, rel=1e-5, abs=1e-5 / R)


@pytest.mark.parametrize("R", [0.01, 1.0, 50.0])
def test_slopes_at_the_center_are_the_limit(response, R):
    z = np.array([0.0, 1e-12 * min(R, R * R)])
    by_z, by_width = np.empty(2), np.empty(2)
    compiled_slopes(response, z, np.full(2, R), by_z, by_width)
    assert by_z[0] < 0.0
    assert by_z[0] == pytest.approx(by_z[1], rel=1e-6)
    assert by_width[0] == 0.0


@pytest.mark.parametrize("half_distance", [1e-6, 0.03, 1.0, 40.0])
def test_width_puts_one_half_at_the_half_distance(response, half_distance):
    R = compiled_width(response, half_distance)
    assert pytest.approx(WIDTH[name(response)](half_distance), rel=1e-14) == R
    assert FORMULA[name(response)](half_distance**2, R) == pytest.approx(0.5, rel=1e-12)


def exact_exp(x):
    with localcontext() as context:
        context.prec = 40
        return Decimal(x).exp()


def worst_units_in_the_last_place(x):
    """Of the compiled exp(x), x <= 0, from the exact one."""
    out = np.empty_like(x)
    compiled_respond(Gaussian(), -x, np.ones_like(x), out)
    exact = [exact_exp(x_j) for x_j in x]
    return max(
        abs(Fraction(o) - Fraction(e)) / Fraction(math.ulp(float(e)))
        for o, e in zip(out.tolist(), exact, strict=True)
    )


# Midway between two powers of two, where the exponent may be rounded up or down.
MIDWAY = -(np.arange(0, 1020, 7) + 0.5) * math.log(2)


@given(st.lists(st.floats(-707.999, 0.0), min_size=1, max_size=40))
def test_gaussian_is_within_two_units_of_the_exact_exponential(x):
    assert worst_units_in_the_last_place(np.array(x)) <= 2


@pytest.mark.parametrize("nudge", [0.0, np.inf, -np.inf])
def test_gaussian_is_as_good_between_powers_of_two(nudge):
    x = np.nextafter(MIDWAY, nudge) if nudge else MIDWAY
    assert worst_units_in_the_last_place(x) <= 2


@given(st.lists(st.floats(708.0, 1e300), min_size=1, max_size=40))
def test_gaussian_is_zero_from_the_smallest_normal_double_down(z):
    out = np.full(len(z), np.nan)
    compiled_respond(Gaussian(), np.array(z), np.ones(len(z)), out)
    assert not out.any()
    edge = np.empty(1)
    compiled_respond(Gaussian(), np.array([np.nextafter(708.0, 0.0)]), np.ones(1), edge)
    assert edge[0] > 0.0


def test_a_distance_that_is_no_number_is_not_hidden():
    out = np.zeros(3)
    compiled_respond(Gaussian(), np.array([0.1, np.nan, 0.2]), np.ones(3), out)
    assert np.isnan(out[1])
    assert np.isfinite(out[[0, 2]]).all()
