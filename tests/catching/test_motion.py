"""Damped motion under a constant pull: closed form against integration, and its laws."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from handeye.catching.motion import (
    arrival_time,
    mean_decay,
    mean_pull,
    position_after,
    standstill_time,
    state_after,
    velocity_after,
)

speeds = st.floats(-10.0, 10.0)
pulls = st.sampled_from([0.0, 1e-3, -1e-3, -9.81, 3.5, 94.0, -94.0])
decays = st.floats(0.0, 10.0)
times = st.floats(0.0, 2.0)


@pytest.mark.parametrize("k", [0.0, 1.81e-4, 0.3, 3.02, 8.4])
@pytest.mark.parametrize(("v", "a"), [(5.0, -9.81), (-2.0, 0.0), (0.0, 94.0)])
def test_obeys_the_law_of_motion(k, v, a):
    found = solve_ivp(
        lambda _, s: (s[1], a - k * s[1]), (0.0, 1.3), (0.7, v), rtol=1e-11, atol=1e-12
    )
    np.testing.assert_allclose(position_after(0.7, v, a, k, 1.3), found.y[0, -1], atol=1e-8)
    np.testing.assert_allclose(velocity_after(v, a, k, 1.3), found.y[1, -1], atol=1e-8)


@given(speeds, pulls, decays, times, times)
def test_one_step_equals_two(v, a, k, first, second):
    x1, v1 = state_after(0.3, v, a, k, first)
    x2, v2 = state_after(x1, v1, a, k, second)
    x, w = state_after(0.3, v, a, k, first + second)
    np.testing.assert_allclose((x2, v2), (x, w), rtol=1e-11, atol=1e-11)


@given(speeds, pulls, decays, times)
def test_state_is_position_and_velocity(v, a, k, t):
    expected = position_after(0.3, v, a, k, t), velocity_after(v, a, k, t)
    np.testing.assert_allclose(state_after(0.3, v, a, k, t), expected, rtol=1e-12, atol=1e-12)


@given(st.floats(1e-9, 0.2))
def test_means_keep_their_digits(u):
    # Taylor sums to the last term that counts, the slow and obvious way.
    factorial = np.cumprod(np.arange(1.0, 25.0))
    powers = (-u) ** np.arange(23)
    np.testing.assert_allclose(mean_decay(u), np.sum(powers / factorial[:23]), rtol=1e-15)
    np.testing.assert_allclose(mean_pull(u), np.sum(powers / factorial[1:24]), rtol=4e-15)


def test_means_without_decay():
    assert (mean_decay(0.0), mean_pull(0.0)) == (1.0, 0.5)


@given(speeds, pulls, decays)
def test_stands_still_when_it_says(v, a, k):
    t = standstill_time(v, a, k)
    if np.isinf(t):
        assert v * a >= 0.0
    else:
        np.testing.assert_allclose(velocity_after(v, a, k, t), 0.0, atol=1e-9 * (1.0 + abs(v)))


def test_moves_on_for_ever_without_a_pull_against_it():
    assert standstill_time(2.0, 0.0, 3.0) == np.inf
    assert standstill_time(2.0, 1.0, 0.0) == np.inf
    assert standstill_time(0.0, 1.0, 0.0) == 0.0


@given(st.floats(0.0, 10.0), st.floats(0.0, 100.0), decays, st.floats(0.001, 2.0))
def test_arrives_where_it_says(v, a, k, t):
    goal = position_after(0.0, v, a, k, t)
    if goal > 1e-6:
        found = arrival_time(0.0, v, a, k, goal, 0.0, 2.5)
        np.testing.assert_allclose(position_after(0.0, v, a, k, found), goal, rtol=1e-14)


def test_arrives_on_the_way_down_too():
    up = standstill_time(5.0, -9.81, 0.1)
    t = arrival_time(0.0, 5.0, -9.81, 0.1, 0.4, up, 3.0)
    assert t > up
    np.testing.assert_allclose(position_after(0.0, 5.0, -9.81, 0.1, t), 0.4, rtol=1e-14)
