"""Balls: eq 4.4 and damped flight."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from handeye.catching.ball import (
    BALLS,
    HEAVY_BALL,
    LIGHT_BALL,
    Ball,
    apex_of,
    flight,
    speed_to_reach,
    time_down_to,
)
from handeye.catching.motion import position_after, velocity_after
from handeye.errors import InvalidInput

balls = st.sampled_from(BALLS)


def flown(ball, x, z, vx, vz, t):
    out = np.empty((1, 4))
    one = np.array([x, z, vx, vz, ball.decay, t]).reshape(6, 1)
    flight(one[0], one[1], one[2], one[3], one[4], one[5], out)
    return out[0]


def test_numbers_of_the_thesis():
    volume = 4.0 / 3.0 * np.pi * 0.03**3
    for ball, density in ((LIGHT_BALL, 0.03), (HEAVY_BALL, 500.0)):
        np.testing.assert_allclose(ball.mass, density * volume, rtol=1e-14)
        drag = 6.0 * np.pi * 1.81e-5 * 0.03
        np.testing.assert_allclose(ball.decay, drag / (density * volume), rtol=1e-14)
    np.testing.assert_allclose((LIGHT_BALL.decay, HEAVY_BALL.decay), (3.01667, 1.81e-4), rtol=1e-5)


@pytest.mark.parametrize("ball", BALLS)
def test_flight_obeys_gravity_and_eq_4_4(ball):
    m, f = ball.mass, 6.0 * np.pi * ball.viscosity * ball.radius

    def law(_, s):
        return s[2], s[3], -f * s[2] / m, -f * s[3] / m - 9.81

    found = solve_ivp(law, (0.0, 1.1), (0.1, 0.2, 4.0, 6.0), rtol=1e-11, atol=1e-12)
    np.testing.assert_allclose(flown(ball, 0.1, 0.2, 4.0, 6.0, 1.1), found.y[:, -1], atol=1e-8)


@given(balls, st.floats(-8.0, 8.0), st.floats(-8.0, 8.0), st.floats(0.0, 1.5))
def test_horizontal_momentum_decays_and_energy_is_lost_to_drag_alone(ball, vx, vz, t):
    x, z, wx, wz = flown(ball, 0.0, 0.5, vx, vz, t)
    np.testing.assert_allclose(wx, vx * np.exp(-ball.decay * t), rtol=1e-13, atol=1e-15)
    # Momentum lost sideways is k times the way made, in all.
    np.testing.assert_allclose(vx - wx, ball.decay * x, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(vz - wz, 9.81 * t + ball.decay * (z - 0.5), rtol=1e-11, atol=1e-11)
    before = 0.5 * (vx**2 + vz**2) + 9.81 * 0.5
    after = 0.5 * (wx**2 + wz**2) + 9.81 * z
    assert after <= before + 1e-12 * (1.0 + abs(before))


def test_terminal_velocity():
    vz = flown(LIGHT_BALL, 0.0, 0.0, 1.0, 3.0, 20.0)[3]
    np.testing.assert_allclose(vz, -9.81 / LIGHT_BALL.decay, rtol=1e-12)


@given(balls, st.floats(0.05, 0.15), st.floats(1.25, 1.5))
def test_rises_to_the_apex_that_was_asked_for(ball, z, apex):
    vz = speed_to_reach(apex - z, ball.decay)
    np.testing.assert_allclose(apex_of(z, vz, ball.decay), apex, rtol=1e-14)


@given(balls, st.floats(0.03, 1.0), st.floats(-6.0, 9.0), st.floats(0.0, 0.03))
def test_comes_down_exactly_when_it_says(ball, z, vz, height):
    k = ball.decay
    t = time_down_to(z, vz, k, height)
    np.testing.assert_allclose(position_after(z, vz, -9.81, k, t), height, atol=2e-15)
    assert velocity_after(vz, -9.81, k, t) <= 1e-7
    # And not before: the height is concave or falls all the time.
    before = [position_after(z, vz, -9.81, k, s) for s in np.linspace(0.0, t, 50)[:-1]]
    assert min(before) >= height - 1e-12


def test_never_comes_down_through_a_height_above_its_apex():
    assert time_down_to(0.5, 1.0, 0.1, 2.0) == np.inf


@pytest.mark.parametrize(
    "changes", [{"density": 0.0}, {"radius": -1.0}, {"viscosity": -1e-5}, {"radius": np.nan}]
)
def test_refuses_balls_that_cannot_be(changes):
    with pytest.raises(InvalidInput, match=next(iter(changes))):
        Ball(**{"density": 1.0, **changes})
