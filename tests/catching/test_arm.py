"""Arms: eq 4.1 to 4.3, note E6, hard stops, least times."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from handeye.catching.arm import ARMS, HEAVY_ARM, LIGHT_ARM, Arm, pushes_stop, stop_contact
from handeye.catching.motion import position_after, velocity_after
from handeye.errors import InvalidInput

arms = st.sampled_from(ARMS)
KM, ALPHA, R = 0.125, 0.08, 3.3


def law(arm, voltage):
    """M a'' = k_m / alpha i - b a', i = (V - k_m a' / alpha) / R."""
    b = 0.1 * 9.81 * arm.mass + 0.1 * 0.2 * 0.08

    def rates(_, s):
        current = (voltage - KM * s[1] / ALPHA) / R
        return s[1], (KM / ALPHA * current - b * s[1]) / arm.mass

    return rates


@pytest.mark.parametrize(("arm", "mass"), [(LIGHT_ARM, 0.1), (HEAVY_ARM, 0.5)])
def test_time_constant_equals_eq_4_2(arm, mass):
    b = 0.1 * 9.81 * mass + 0.1 * 0.2 * 0.08
    assert arm.mass == mass
    np.testing.assert_allclose(arm.damping, b, rtol=1e-14)
    tau = 1.0 / (b / mass + KM**2 / (ALPHA**2 * R * mass))
    np.testing.assert_allclose(arm.time_constant, tau, rtol=1e-14)
    gain = arm.force_per_volt / arm.mass * tau  # eq 4.1 at s = 0, per volt
    np.testing.assert_allclose(gain, KM * tau / (ALPHA * R * mass), rtol=1e-14)


def test_terminal_velocities_of_note_e6():
    np.testing.assert_allclose(LIGHT_ARM.terminal_velocity, 11.28, atol=0.005)
    np.testing.assert_allclose(HEAVY_ARM.terminal_velocity, 7.687, atol=0.005)


@pytest.mark.parametrize("arm", ARMS)
@pytest.mark.parametrize("voltage", [20.0, -3.0, 0.0])
def test_closed_form_obeys_the_motor_law(arm, voltage):
    found = solve_ivp(law(arm, voltage), (0.0, 0.4), (1.0, 2.0), rtol=1e-11, atol=1e-12)
    k, pull = 1.0 / arm.time_constant, arm.force_per_volt * voltage / arm.mass
    x, v = position_after(1.0, 2.0, pull, k, 0.4), velocity_after(2.0, pull, k, 0.4)
    np.testing.assert_allclose((x, v), found.y[:, -1], atol=1e-9)


@given(arms, st.floats(-3.0, 3.0))
def test_amplifier_equals_eq_4_3(arm, command):
    expected = 20.0 * np.tanh(4.0 * command)
    np.testing.assert_allclose(arm.motor_voltage(np.array(command)), expected, rtol=1e-14)


@given(arms, st.floats(-20.0, 20.0), st.floats(-10.0, 10.0))
def test_force_is_what_accelerates_the_whole_arm_and_its_damping(arm, voltage, v):
    acceleration = law(arm, voltage)(0.0, (0.0, v))[1]
    expected = arm.mass * acceleration + arm.damping * v
    found = arm.force(np.array(voltage), np.array(v))
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-13)


@given(arms, st.floats(1e-6, 3.0))
def test_least_time_with_full_effort(arm, distance):
    t = float(arm.minimum_time(np.array(distance)))
    k, pull = 1.0 / arm.time_constant, arm.force_per_volt * 20.0 / arm.mass
    np.testing.assert_allclose(position_after(0.0, 0.0, pull, k, t), distance, rtol=1e-12)


@given(arms, st.floats(1e-6, 3.0))
def test_least_time_to_rest_is_full_effort_and_full_brake(arm, distance):
    total = float(arm.minimum_rest_time(np.array(distance)))
    tau, v = arm.time_constant, arm.terminal_velocity
    y_squared = np.exp(total / tau + distance / (v * tau))
    switch = 0.5 * tau * np.log(y_squared)
    k, pull = 1.0 / tau, v / tau
    x1, v1 = position_after(0.0, 0.0, pull, k, switch), velocity_after(0.0, pull, k, switch)
    x2 = position_after(x1, v1, -pull, k, total - switch)
    v2 = velocity_after(v1, -pull, k, total - switch)
    np.testing.assert_allclose(x2, distance, rtol=1e-8)
    np.testing.assert_allclose(v2, 0.0, atol=1e-8)
    assert total > arm.minimum_time(np.array(distance))


def test_least_times_of_no_way_and_of_signs_and_shapes():
    for time in (HEAVY_ARM.minimum_time, HEAVY_ARM.minimum_rest_time):
        assert time(np.array(0.0)) == 0.0
        both = time(np.array([[0.4, -0.4]]))
        assert both.shape == (1, 2)
        assert both[0, 0] == both[0, 1]


@given(st.floats(0.5, 2.5), st.floats(-9.0, 9.0), st.floats(-95.0, 95.0), arms)
def test_runs_into_a_stop_exactly(x, v, pull, arm):
    k, span = 1.0 / arm.time_constant, 0.025
    t = stop_contact(x, v, pull, k, 0.5, 2.5, span)
    last = min(t, span)
    way = [position_after(x, v, pull, k, s) for s in np.linspace(0.0, last, 60)]
    assert min(way) >= 0.5 - 1e-12
    assert max(way) <= 2.5 + 1e-12
    if t < np.inf:
        reached = position_after(x, v, pull, k, t)
        assert min(abs(reached - 0.5), abs(reached - 2.5)) < 1e-14


def test_notices_a_stop_touched_for_a_moment_only():
    """Pulled back within the tick, 0.3 mm behind the stop."""
    t = stop_contact(2.4998, 0.2, -40.0, 1e-9, 0.5, 2.5, 0.025)
    np.testing.assert_allclose(0.2 * t - 20.0 * t**2, 0.0002, atol=1e-12)
    assert t < 0.005
    assert stop_contact(2.4994, 0.2, -40.0, 1e-9, 0.5, 2.5, 0.009) == np.inf


def test_turns_round_before_one_stop_and_reaches_it_no_more():
    # Fast towards the stop, but pulled back in time.
    assert stop_contact(2.45, 2.0, -95.0, 1.0, 0.5, 2.5, 0.1) == np.inf


def test_a_motor_that_pushes_against_a_stop_moves_nothing():
    assert pushes_stop(2.5, 0.0, 3.0, 0.5, 2.5)
    assert pushes_stop(0.5, 0.0, -3.0, 0.5, 2.5)
    assert not pushes_stop(2.5, 0.0, -3.0, 0.5, 2.5)
    assert not pushes_stop(0.5, 0.0, 3.0, 0.5, 2.5)
    assert not pushes_stop(1.0, 0.0, 3.0, 0.5, 2.5)


@pytest.mark.parametrize(
    "changes", [{"mass": 0.0}, {"wheel": -0.1}, {"resistance": 0.0}, {"friction": -0.1}]
)
def test_refuses_arms_that_cannot_be(changes):
    with pytest.raises(InvalidInput, match=next(iter(changes))):
        Arm(**{"mass": 0.1, **changes})
