import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from handeye.errors import InvalidInput
from handeye.thesis.analysis.first_order import (
    amplitude_ratio,
    corner_period,
    fit_corner,
    network_error,
    output,
    phase_lead,
)
from handeye.thesis.analysis.harmonic import fit_rectified_sine, fit_sine

taus = st.floats(5.0, 2000.0)
PERIODS = np.array([100.0, 200.0, 500.0, 1000.0, 2500.0, 5000.0])


@given(tau=taus)
def test_at_the_corner_half_the_power_is_left_and_leads_by_45_degrees(tau: float):
    corner = corner_period(tau)
    assert amplitude_ratio(corner, tau) == pytest.approx(np.sqrt(0.5))
    assert phase_lead(corner, tau) == pytest.approx(np.pi / 4.0)


@given(tau=taus)
def test_asymptotes(tau: float):
    corner = corner_period(tau)
    assert amplitude_ratio(1e-3 * corner, tau) == pytest.approx(1.0, abs=1e-6)
    assert phase_lead(1e-3 * corner, tau) == pytest.approx(1e-3, rel=1e-3)
    slow = amplitude_ratio(np.array([1e3, 1e4]) * corner, tau)
    assert 20.0 * np.log10(slow[1] / slow[0]) == pytest.approx(-20.0, abs=1e-4)
    assert phase_lead(1e4 * corner, tau) == pytest.approx(np.pi / 2.0, abs=1e-3)


def test_output_solves_the_equation():
    period, tau, amplitude, floor, start = 500.0, 120.0, 0.05, 0.01, 0.02

    def slope(t: float, o: np.ndarray) -> np.ndarray:
        return (amplitude * np.sin(2.0 * np.pi * t / period) - o - floor) / tau

    t = np.linspace(0.0, 2000.0, 101)
    solved = solve_ivp(slope, (0.0, 2000.0), [start], t_eval=t, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(
        output(t, period, tau, amplitude, floor, start), solved.y[0], atol=1e-9
    )


@pytest.mark.parametrize("period", PERIODS)
def test_the_error_of_that_output_has_the_amplitude_and_lead_of_the_model(period: float):
    tau, amplitude = 120.0, 0.05
    t = np.arange(20.0 * tau, 20.0 * tau + 2.0 * period, 10.0)
    error = amplitude * np.sin(2.0 * np.pi * t / period) - output(
        t, period, tau, amplitude, 0.01, -0.01
    )
    fit = fit_sine(t, error, period)
    assert fit.level == pytest.approx(0.01)
    assert fit.amplitude == pytest.approx(amplitude * amplitude_ratio(period, tau))
    assert fit.phase == pytest.approx(phase_lead(period, tau))
    rectified = network_error(t, period, tau, amplitude, 0.01)
    np.testing.assert_allclose(rectified, np.abs(error - 0.01) + 0.01, atol=1e-9)
    again = fit_rectified_sine(t, rectified, period)
    assert again.amplitude == pytest.approx(fit.amplitude, rel=1e-4)
    assert again.phase == pytest.approx(fit.phase, abs=1e-4)


@given(tau=taus)
def test_the_corner_of_exact_points_is_found_by_all_three_fits(tau: float):
    fit = fit_corner(PERIODS, amplitude_ratio(PERIODS, tau), phase_lead(PERIODS, tau))
    np.testing.assert_allclose(fit, corner_period(tau), rtol=1e-3)


def test_each_fit_uses_its_own_points():
    ratio, lead = amplitude_ratio(PERIODS, 100.0), phase_lead(PERIODS, 200.0)
    fit = fit_corner(PERIODS, ratio, lead)
    assert fit.ratio == pytest.approx(corner_period(100.0), rel=1e-3)
    assert fit.lead == pytest.approx(corner_period(200.0), rel=1e-3)
    assert fit.ratio < fit.both < fit.lead


def test_the_corner_of_noisy_points_is_unbiased():
    rng = np.random.default_rng(0)
    exact = amplitude_ratio(PERIODS, 120.0) * np.exp(1j * phase_lead(PERIODS, 120.0))
    fits = [
        fit_corner(PERIODS, np.abs(noisy), np.angle(noisy)).both
        for noisy in exact + 0.02 * (rng.standard_normal((60, 6, 2)) @ [1.0, 1j])
    ]
    assert np.mean(fits) == pytest.approx(corner_period(120.0), rel=0.01)


def test_what_makes_no_sense_is_refused():
    with pytest.raises(InvalidInput, match="tau must be greater"):
        amplitude_ratio(100.0, 0.0)
    with pytest.raises(InvalidInput, match="period must be positive"):
        phase_lead([100.0, 0.0], 1.0)
    for periods in ([], [100.0, -1.0]):
        with pytest.raises(InvalidInput, match="periods must be positive"):
            fit_corner(periods, periods, periods)
