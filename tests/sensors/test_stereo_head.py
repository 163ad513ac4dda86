"""The stereo head: eq 3.4, 3.5, 3.18 to 3.28, 3.39 to 3.42."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from handeye.errors import InvalidInput
from handeye.sensors.stereo import StereoHead

RHO, F, H = 0.0275e-3, 8.0e-3, 0.25

ranges = st.floats(0.1, 4.0)
eccentricities = st.floats(-np.pi / 6, np.pi / 6)
NONE = np.zeros(2)


def slopes(r, eccentricity):
    """Eq 3.18, 3.19: what the two cameras measure."""
    x, y = r * np.cos(eccentricity), r * np.sin(eccentricity)
    return (y - H) / x, (y + H) / x


def located(m1, m2):
    """Eq 3.20 and 3.25: range and eccentricity from the two slopes."""
    return H / (m2 - m1) * np.sqrt(4.0 + (m1 + m2) ** 2), np.arctan((m1 + m2) / 2.0)


@given(ranges, eccentricities)
def test_range_noise_equals_eq_3_24(r, eccentricity):
    cos, sin = np.cos(eccentricity), np.sin(eccentricity)
    expected = np.sqrt((r**2 * cos / (2.0 * H)) ** 2 + r**2 * cos**2 * sin**2)
    expected *= RHO / (np.sqrt(6.0) * F)
    found = StereoHead().range_std(np.array(r), np.array(eccentricity))
    np.testing.assert_allclose(found, expected, rtol=1e-12)


@given(eccentricities)
def test_eccentricity_noise_equals_eq_3_28(eccentricity):
    expected = np.cos(eccentricity) ** 2 / (2.0 * np.sqrt(6.0)) * RHO / F
    found = StereoHead().eccentricity_std(np.array(eccentricity))
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_noise_at_two_metres_straight_ahead():
    # Note E3: what the equations give, where eq 3.96 quotes 8.957e-3 and 1.112e-3.
    np.testing.assert_allclose(
        StereoHead().range_std(np.array(2.0), np.array(0.0)), 11.227e-3, 1e-3
    )
    np.testing.assert_allclose(StereoHead().eccentricity_std(np.array(0.0)), 0.7017e-3, 1e-3)


@pytest.mark.parametrize("r", [0.5, 1.0, 2.0, 3.0])
@pytest.mark.parametrize("eccentricity", [0.0, 0.3, -0.5])
def test_noise_describes_the_spread_of_pixels(r, eccentricity):
    # Slopes are uniform over a pixel (eq 3.22). Eq 3.21 doubles the term of sin(eps): the exact
    # derivative has r cos(eps) sin(eps) / 2, so eq 3.24 overstates the spread, at most by `excess`.
    rng = np.random.default_rng(1)
    n = 40_000
    dm1, dm2 = rng.uniform(-0.5, 0.5, (2, n)) * RHO / F
    m1, m2 = slopes(r, eccentricity)
    measured_r, measured_eccentricity = located(m1 + dm1, m2 + dm2)
    head, at = StereoHead(), (np.array(r), np.array(eccentricity))
    sampling = 5.0 / np.sqrt(2.0 * n)
    np.testing.assert_allclose(
        measured_eccentricity.std(), head.eccentricity_std(at[1]), rtol=sampling
    )
    along, across = r / (2.0 * H), abs(np.sin(eccentricity))
    excess = np.hypot(along, across) / np.hypot(along, across / 2.0)
    np.testing.assert_allclose(measured_r.std() * excess, head.range_std(*at), rtol=sampling)
    assert excess < 1.08


@given(ranges, eccentricities)
def test_perturbations_equal_eq_3_39_and_3_40(r, eccentricity):
    eta, zeta = 0.015, 0.005
    head = StereoHead(eccentricity_warp=eta, range_warp=zeta)
    delta_eccentricity = eta * np.sin(eccentricity) ** 2 * (r + 2.0) / (r + 1.0)
    delta_r = zeta * (delta_eccentricity + (r - 1.0) ** 2)
    measured = head.measure(np.array(r), np.array(eccentricity), NONE)
    np.testing.assert_allclose(measured[0], r + delta_r, rtol=1e-13)
    np.testing.assert_allclose(measured[1], eccentricity + delta_eccentricity, rtol=1e-13)


def test_distortion_is_of_the_size_the_thesis_states():
    # Note E1: one centimetre at two metres and the edge of the field; 2 cm at three metres.
    head = StereoHead(eccentricity_warp=0.015, range_warp=0.005)
    edge = np.array([-np.pi / 6, np.pi / 6])
    moved = 2.0 * head.eccentricity_error(np.array(2.0), edge)
    np.testing.assert_allclose(moved, 0.01, rtol=0.02)
    np.testing.assert_allclose(head.range_error(np.array(3.0), np.array(0.0)), 0.02, rtol=1e-12)


@given(ranges, eccentricities, st.integers(0, 2**32 - 1))
def test_noise_adds_its_standard_deviations(r, eccentricity, seed):
    head = StereoHead(eccentricity_warp=0.02, range_warp=0.01, range_scale=1.1)
    unit = np.random.default_rng(seed).standard_normal(2)
    at = np.array(r), np.array(eccentricity)
    noisy, clean = head.measure(*at, unit), head.measure(*at, NONE)
    np.testing.assert_allclose(noisy[0] - clean[0], head.range_std(*at) * unit[0], atol=1e-15)
    np.testing.assert_allclose(
        noisy[1] - clean[1], head.eccentricity_std(at[1]) * unit[1], atol=1e-15
    )


def test_the_scale_is_that_of_the_range_alone():
    at = np.array([0.5, 2.0]), np.array([0.1, -0.3])
    r, eccentricity = StereoHead(range_scale=0.9).measure(*at, np.zeros((2, 2)))
    np.testing.assert_array_equal(r, 0.9 * at[0])
    np.testing.assert_array_equal(eccentricity, at[1])


def test_no_pixels_no_noise():
    at = np.array([0.5, 2.0]), np.array([0.1, -0.3])
    measured = StereoHead(pixel_pitch=0.0).measure(*at, np.full((2, 2), 9.0))
    np.testing.assert_array_equal(measured, at)


@pytest.mark.parametrize(
    "wrong",
    [
        {"pixel_pitch": -1e-6}, {"pixel_pitch": np.nan}, {"focal_length": 0.0}, {"baseline": -0.5},
        {"field_of_view": 0.0}, {"eccentricity_warp": np.inf}, {"range_warp": "1"},
        {"range_scale": 0.0}, {"range_scale": np.array([1.0, -1.0])}, {"range_scale": np.nan},
    ],
)  # fmt: skip
def test_a_head_that_cannot_be_is_refused(wrong):
    with pytest.raises(InvalidInput, match=next(iter(wrong))):
        StereoHead(**wrong)
