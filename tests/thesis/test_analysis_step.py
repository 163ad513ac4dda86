import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from handeye.errors import InvalidInput
from handeye.thesis.analysis.step import fit_step

TIMES = np.concatenate([np.arange(0.0, 200.0, 10.0), np.arange(200.0, 2001.0, 50.0)])


def step(t: np.ndarray, start: float, floor: float, tau: float) -> np.ndarray:
    return floor + (start - floor) * np.exp(-t / tau)


@given(
    start=st.floats(-10.0, 10.0),
    fall=st.floats(0.01, 10.0) | st.floats(-10.0, -0.01),
    tau=st.floats(8.0, 1500.0),
    from_=st.floats(0.0, 50.0),
)
def test_an_exact_response_is_recovered_whenever_the_first_point_is(
    start: float, fall: float, tau: float, from_: float
):
    t = TIMES + from_
    fit = fit_step(t, step(t, start, start - fall, tau))
    assert fit.tau == pytest.approx(tau, rel=1e-5)
    assert fit.floor == pytest.approx(start - fall, abs=1e-4 * abs(fall))
    expected = abs(fall) * np.exp(from_ / tau) * 1e-3
    assert fit.start == pytest.approx(start, abs=expected)
    assert fit.low <= fit.tau <= fit.high
    assert fit.high - fit.low < 1e-3 * tau
    np.testing.assert_allclose(fit.at(t), step(t, start, start - fall, tau), atol=1e-4 * abs(fall))


@given(scale=st.floats(1e-6, 1e6), shift=st.floats(-100.0, 100.0), slower=st.floats(0.1, 10.0))
def test_units_of_response_and_time_carry_through(scale: float, shift: float, slower: float):
    y = step(TIMES, 1.0, 0.2, 120.0) + 0.02 * np.random.default_rng(0).standard_normal(len(TIMES))
    one = fit_step(TIMES, y)
    other = fit_step(slower * TIMES, scale * (y + shift))
    for name in ("tau", "low", "high"):
        assert getattr(other, name) == pytest.approx(slower * getattr(one, name), rel=1e-4)
    assert other.start == pytest.approx(scale * (one.start + shift), abs=1e-4 * scale)


def test_the_interval_holds_the_truth_19_times_in_20():
    rng, std = np.random.default_rng(1), 0.05 * (0.3 + np.exp(-TIMES / 100.0))
    truth = step(TIMES, 1.0, 0.3, 120.0)
    fits = [fit_step(TIMES, truth + std * rng.standard_normal(len(TIMES)), std) for _ in range(400)]
    inside = np.mean([fit.low <= 120.0 <= fit.high for fit in fits])
    assert 0.92 <= inside <= 0.98
    assert np.mean([fit.tau for fit in fits]) == pytest.approx(120.0, rel=0.02)


def test_points_with_large_deviations_count_little():
    y = step(TIMES, 1.0, 0.2, 120.0)
    bad = np.zeros(len(TIMES))
    bad[::5] = 0.5
    std = np.where(bad > 0.0, 1e4, 1.0)
    assert fit_step(TIMES, y + bad, std).tau == pytest.approx(120.0, rel=1e-3)
    assert fit_step(TIMES, y + bad).tau != pytest.approx(120.0, rel=1e-2)


def test_deviations_count_only_up_to_a_common_factor():
    y = step(TIMES, 1.0, 0.2, 120.0) + 0.02 * np.random.default_rng(0).standard_normal(len(TIMES))
    np.testing.assert_allclose(fit_step(TIMES, y), fit_step(TIMES, y, np.full(len(y), 7.0)))


@pytest.mark.parametrize("seed", range(5))
def test_where_nothing_happened_the_interval_says_that_tau_is_unknown(seed: int):
    fit = fit_step(TIMES, 1.0 + 0.05 * np.random.default_rng(seed).standard_normal(len(TIMES)))
    assert fit.high / fit.low > 20.0


def test_a_response_that_is_constant_is_no_error():
    fit = fit_step(TIMES, np.full(len(TIMES), 0.3))
    assert np.all(np.isfinite(fit))
    np.testing.assert_allclose(fit.at(TIMES), 0.3)


@pytest.mark.parametrize(
    ("t", "y", "std", "said"),
    [
        ([0.0, 1.0, 2.0], [1.0, 2.0, 3.0], None, "at least 4"),
        ([0.0, 1.0, 1.0, 2.0], [1.0] * 4, None, "increasing"),
        ([0.0, 1.0, 2.0, 3.0], [1.0] * 3, None, "response must have shape"),
        ([0.0, 1.0, 2.0, 3.0], [1.0] * 4, [1.0, 1.0, 0.0, 1.0], "std must be positive"),
        ([0.0, 1.0, 2.0, 3.0], [1.0, np.nan, 1.0, 1.0], None, "finite"),
    ],
)
def test_what_cannot_be_fitted_is_refused(
    t: list[float], y: list[float], std: list[float] | None, said: str
):
    with pytest.raises(InvalidInput, match=said):
        fit_step(t, y, std)
