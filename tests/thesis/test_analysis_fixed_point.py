import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from handeye.errors import InvalidInput
from handeye.thesis.analysis.fixed_point import expected_output, outputs

rates = st.floats(0.01, 0.99)
START, TARGET = np.array([0.3, -1.0]), np.array([1.0, 2.0])


@given(rate=rates)
def test_recursion_equals_the_sum_of_eq_3_81(rate: float):
    nu = np.random.default_rng(0).standard_normal((12, 2))
    rows = outputs(START, TARGET, nu, rate)
    for j in range(13):
        left = (1.0 - rate) ** j
        powers = (1.0 - rate) ** np.arange(j - 1, -1, -1)
        by_sum = left * START + (1.0 - left) * TARGET - rate * powers @ nu[:j]
        np.testing.assert_allclose(rows[j], by_sum, atol=1e-12)


@given(rate=rates)
def test_one_step_is_eq_3_80(rate: float):
    (_, after) = outputs(START, TARGET, [[0.5, 0.1]], rate)
    np.testing.assert_allclose(after, (1 - rate) * START + rate * (TARGET - [0.5, 0.1]))


@given(rate=rates, noise=st.floats(-1.0, 1.0))
def test_constant_noise_gives_the_expected_output_and_in_the_end_target_less_noise(
    rate: float, noise: float
):
    nu = np.full((2000, 2), noise)
    rows = outputs(START, TARGET, nu, rate)
    expected = expected_output(np.arange(2001), START[0], TARGET[0], noise, rate)
    np.testing.assert_allclose(rows[:, 0], expected, atol=1e-12)
    np.testing.assert_allclose(rows[-1], TARGET - noise, atol=1e-7)


def test_the_mean_over_many_runs_is_the_expected_output():
    rng = np.random.default_rng(1)
    nu = 0.2 + 0.5 * rng.standard_normal((60, 4000))
    mean = outputs(np.zeros(4000), np.ones(4000), nu, 0.06).mean(axis=1)
    expected = expected_output(np.arange(61), 0.0, 1.0, 0.2, 0.06)
    np.testing.assert_allclose(mean, expected, atol=0.01)


@pytest.mark.parametrize("rate", [0.0, 1.0, -0.1, 1.5])
def test_a_rate_lies_between_0_and_1(rate: float):
    with pytest.raises(InvalidInput, match="rate must lie between"):
        outputs(START, TARGET, [[0.0, 0.0]], rate)
    with pytest.raises(InvalidInput, match="rate must lie between"):
        expected_output(1, 0.0, 1.0, 0.0, rate)


def test_shapes_must_fit():
    with pytest.raises(InvalidInput, match="target must have shape"):
        outputs(START, [1.0], [[0.0, 0.0]], 0.1)
    with pytest.raises(InvalidInput, match="noise must have shape"):
        outputs(START, TARGET, [[0.0]], 0.1)
