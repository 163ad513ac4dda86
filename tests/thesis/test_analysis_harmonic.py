from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from handeye.errors import InvalidInput
from handeye.thesis.analysis.harmonic import Harmonic, fit_rectified_sine, fit_sine

PERIOD = 250.0
TIMES = np.arange(3, 1100, 7)  # no whole number of periods
ANGLES = 2.0 * np.pi * TIMES / PERIOD

levels = st.floats(-5.0, 5.0)
amplitudes = st.floats(0.01, 10.0)


def turn(one: float, other: float, full: float) -> float:
    """The distance of two phases on a circle of so much."""
    return abs((one - other + full / 2.0) % full - full / 2.0)


@given(level=levels, amplitude=amplitudes, phase=st.floats(-np.pi, np.pi))
def test_an_exact_sine_is_recovered(level: float, amplitude: float, phase: float):
    fit = fit_sine(TIMES, level + amplitude * np.sin(ANGLES + phase), PERIOD)
    assert fit.level == pytest.approx(level, abs=1e-9)
    assert fit.amplitude == pytest.approx(amplitude, abs=1e-9)
    assert turn(fit.phase, phase, 2.0 * np.pi) < 1e-9 / amplitude + 1e-9
    assert fit.amplitude_std < 1e-9


@given(level=levels, amplitude=amplitudes, phase=st.floats(0.0, np.pi, exclude_max=True))
def test_an_exact_rectified_sine_is_recovered(level: float, amplitude: float, phase: float):
    fit = fit_rectified_sine(TIMES, level + amplitude * np.abs(np.sin(ANGLES + phase)), PERIOD)
    assert fit.level == pytest.approx(level, abs=1e-4 * amplitude)
    assert fit.amplitude == pytest.approx(amplitude, rel=1e-4)
    assert turn(fit.phase, phase, np.pi) < 1e-4
    assert 0.0 <= fit.phase < np.pi


@pytest.mark.parametrize(
    ("fit", "wave"), [(fit_sine, np.sin), (fit_rectified_sine, lambda a: np.abs(np.sin(a)))]
)
def test_deviations_are_those_of_the_estimates(
    fit: Callable[..., Harmonic], wave: Callable[[np.ndarray], np.ndarray]
):
    rng, truth = np.random.default_rng(2), 0.4 + 1.5 * wave(ANGLES + 1.1)
    fits = [fit(TIMES, truth + 0.3 * rng.standard_normal(len(TIMES)), PERIOD) for _ in range(300)]
    for name, value in (("amplitude", 1.5), ("phase", 1.1)):
        found = np.array([getattr(f, name) for f in fits])
        stds = np.array([getattr(f, f"{name}_std") for f in fits])
        assert found.std() == pytest.approx(stds.mean(), rel=0.12)
        assert found.mean() == pytest.approx(value, abs=0.02)
        inside = np.mean(np.abs(found - value) < 1.96 * stds)
        assert 0.91 <= inside <= 0.98


def test_weights_say_how_much_a_point_counts():
    rng = np.random.default_rng(3)
    std = rng.uniform(0.1, 3.0, len(TIMES))
    waves = [0.4 + 1.5 * np.sin(ANGLES + 1.1) + std * rng.standard_normal(std.size)
             for _ in range(300)]  # fmt: skip
    plain = [fit_sine(TIMES, wave, PERIOD) for wave in waves]
    weighted = [fit_sine(TIMES, wave, PERIOD, std**-2.0) for wave in waves]
    spread = np.std([fit.amplitude for fit in weighted])
    assert spread < 0.5 * np.std([fit.amplitude for fit in plain])
    assert spread == pytest.approx(np.mean([fit.amplitude_std for fit in weighted]), rel=0.12)


@given(st.lists(st.integers(1, 4), min_size=10, max_size=10))
def test_a_weight_is_a_repetition(times: list[int]):
    t = np.array([0.0, 3.0, 10.0, 40.0, 60.0, 90.0, 120.0, 170.0, 200.0, 240.0])
    y = np.random.default_rng(4).standard_normal(len(t))
    for fit in (fit_sine, fit_rectified_sine):
        weighted = fit(t, y, PERIOD, np.array(times))
        repeated = fit(np.repeat(t, times), np.repeat(y, times), PERIOD)
        np.testing.assert_allclose(weighted[:2], repeated[:2], atol=1e-6)


def test_without_a_wave_the_phase_is_unknown():
    none = fit_sine(TIMES, np.zeros(len(TIMES)), PERIOD)
    assert (none.amplitude, none.phase_std) == (0.0, np.pi)
    noise = np.random.default_rng(5).standard_normal(len(TIMES))
    for fit in (fit_sine, fit_rectified_sine):
        found = fit(TIMES, 1e-9 * noise + 1.0, PERIOD)
        assert found.amplitude < 4.0 * found.amplitude_std
        assert found.phase_std > 0.2


@pytest.mark.parametrize("fit", [fit_sine, fit_rectified_sine])
def test_what_cannot_be_fitted_is_refused(fit: Callable[..., Harmonic]):
    with pytest.raises(InvalidInput, match="at least 4 points, got 3"):
        fit([0.0, 1.0, 2.0], [0.0, 1.0, 2.0], 10.0)
    with pytest.raises(InvalidInput, match="weights must be positive"):
        fit(TIMES, ANGLES, PERIOD, np.zeros(len(TIMES)))
    with pytest.raises(InvalidInput, match="period must be greater"):
        fit(TIMES, ANGLES, 0.0)
    with pytest.raises(InvalidInput, match="response must have shape"):
        fit(TIMES, ANGLES[1:], PERIOD)
