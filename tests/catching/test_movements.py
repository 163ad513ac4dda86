"""Pursuits: antisymmetric pulses, and what the arm makes of them (figures 4.9, 4.10)."""

import numpy as np
import pytest

from handeye.catching.arm import ARMS, HEAVY_ARM, LIGHT_ARM
from handeye.catching.layout import Layout
from handeye.catching.motion import position_after, velocity_after
from handeye.catching.movements import EPSILON, Pulses, draw_pursuits, execute
from handeye.catching.profile import AntisymmetricProfile
from handeye.errors import InvalidInput


def drawn(arm, n=60, seed=41):
    pulses = draw_pursuits(n, np.random.default_rng(seed), arm)
    return pulses, execute(arm, pulses)


@pytest.mark.parametrize("arm", ARMS)
def test_the_voltage_is_a_square_pulse_and_its_mirror_image(arm):
    pulses, movements = drawn(arm)
    for i in range(len(pulses)):
        n = movements.n_ticks[i]
        sign = np.sign(pulses.target[i] - pulses.start[i])
        v, x = sign * movements.voltage[:n, i], sign * movements.arm_x[:n, i]
        middle = sign * 0.5 * (pulses.start[i] + pulses.target[i])
        # It turns over at the first tick past the midpoint, once.
        np.testing.assert_array_equal(v, np.where(x >= middle, -1.0, 1.0) * pulses.amplitude[i])
        assert v[0] > 0.0 > v[-1]
        assert np.all(np.diff(np.sign(v)) <= 0.0)
        np.testing.assert_array_equal(movements.voltage[n:, i], 0.0)


@pytest.mark.parametrize("arm", ARMS)
def test_the_movement_obeys_the_motor_and_stops_exactly(arm):
    pulses, movements = drawn(arm, 12)
    k = 1.0 / arm.time_constant
    for i in range(len(pulses)):
        x, v, force = pulses.start[i], 0.0, 0.0
        for j in range(movements.n_ticks[i]):
            row = (movements.arm_x[j, i], movements.arm_v[j, i], movements.arm_force[j, i])
            np.testing.assert_allclose(row, (x, v, force), atol=1e-12)
            np.testing.assert_allclose(movements.time[j, i], 0.025 * j, rtol=1e-14)
            volts = arm.motor_voltage(movements.voltage[j : j + 1, i])[0]
            pull = arm.force_per_volt * volts / arm.mass
            rest = movements.stop_time[i] - 0.025 * j
            span = min(0.025, rest)
            x, v = position_after(x, v, pull, k, span), velocity_after(v, pull, k, span)
            force = arm.force_per_volt * (volts - arm.back_emf * v)
        np.testing.assert_allclose(v, 0.0, atol=1e-12)
        np.testing.assert_allclose(movements.stop_x[i], x, atol=1e-12)
        assert 0.0 < rest <= 0.025
        assert np.isnan(movements.arm_x[movements.n_ticks[i] :, i]).all()


def test_starts_targets_and_amplitudes_are_from_their_ranges():
    pulses, movements = drawn(LIGHT_ARM, 300)
    low, high = Layout().arm_travel
    for place in (pulses.start, pulses.target):
        assert low <= place.min() < low + 0.1
        assert high - 0.1 < place.max() <= high
    assert EPSILON <= pulses.amplitude.min() < EPSILON + 0.05
    assert 0.95 < pulses.amplitude.max() <= 1.0
    assert not movements.hit_stop.any()


def test_no_pursuit_is_glacial():
    """The reason for epsilon: across all the travel in about the time of a flight."""
    low, high = Layout().arm_travel
    slowest = execute(HEAVY_ARM, Pulses(np.array([low]), np.array([high]), np.array([EPSILON])))
    assert 0.8 < slowest.stop_time[0] < 1.1


def test_pursuits_that_would_hit_a_stop_are_not_drawn_but_flagged():
    pulses = Pulses(np.array([2.48, 1.0]), np.array([2.5, 1.5]), np.array([1.0, 1.0]))
    movements = execute(LIGHT_ARM, pulses)
    np.testing.assert_array_equal(movements.hit_stop, [True, False])
    assert movements.stop_x[0] == 2.5
    assert movements.n_ticks[0] >= 1


def test_the_stop_is_where_the_arm_meets_it():
    movements = execute(LIGHT_ARM, Pulses(np.array([2.48]), np.array([2.5]), np.array([1.0])))
    k = 1.0 / LIGHT_ARM.time_constant
    pull = LIGHT_ARM.force_per_volt * 20.0 * np.tanh(4.0) / LIGHT_ARM.mass
    tick = 0.025 * (movements.n_ticks[0] - 1)
    j = movements.n_ticks[0] - 1
    x, v = movements.arm_x[j, 0], movements.arm_v[j, 0]
    pull *= np.sign(movements.voltage[j, 0])
    reached = position_after(x, v, pull, k, movements.stop_time[0] - tick)
    np.testing.assert_allclose(reached, 2.5, atol=1e-12)


def test_a_pursuit_to_where_the_arm_is_takes_no_time():
    here = Pulses(np.array([1.5, 1.0]), np.array([1.5, 1.4]), np.array([0.5, 0.5]))
    movements = execute(HEAVY_ARM, here)
    assert movements.stop_time[0] == 0.0
    assert movements.n_ticks[0] == 0
    assert movements.stop_x[0] == 1.5


def test_movements_of_a_batch_are_those_of_single_pursuits():
    pulses, movements = drawn(HEAVY_ARM, 8)
    for i in range(8):
        alone = execute(HEAVY_ARM, pulses[i : i + 1])
        n = movements.n_ticks[i]
        np.testing.assert_array_equal(alone.arm_x[:, 0], movements[i : i + 1].arm_x[:n, 0])
        assert alone.stop_x[0] == movements.stop_x[i]
        assert alone.stop_time[0] == movements.stop_time[i]


def test_a_profile_can_be_triggered_cancelled_and_triggered_again():
    profile = AntisymmetricProfile(3)
    assert not profile.active.any()
    rest, still = np.ones(3), np.zeros(3)
    which = np.array([True, False, True])
    profile.trigger(which, rest, rest + np.array([0.5, 0.5, -0.5]), np.full(3, 0.7))
    np.testing.assert_array_equal(profile.command(rest, still), [0.7, 0.0, -0.7])
    profile.cancel(np.array([True, False, False]))
    np.testing.assert_array_equal(profile.active, [False, False, True])
    np.testing.assert_array_equal(profile.command(rest - 0.3, still - 1.0), [0.0, 0.0, 0.7])
    profile.trigger(np.array([False, True, False]), rest, rest + 1.0, np.full(3, 0.2))
    np.testing.assert_array_equal(profile.command(rest - 0.5, still), [0.0, 0.2, 0.0])


def test_the_last_pulse_is_made_weaker_by_the_ratio_of_speeds():
    profile = AntisymmetricProfile(1, input_gain=4.0)
    on = np.array([True])
    profile.trigger(on, np.array([0.0]), np.array([1.0]), np.array([0.3]))
    profile.command(np.array([0.6]), np.array([3.0]))
    np.testing.assert_allclose(profile.command(np.array([0.7]), np.array([2.0])), -0.3)
    # It has lost 2 - 0.5 m/s over a tick; a third of that is left to lose.
    weak = profile.command(np.array([0.75]), np.array([0.5]))
    np.testing.assert_allclose(np.tanh(4.0 * weak), -np.tanh(1.2) * 0.5 / 1.5, rtol=1e-12)


def test_refuses_pursuits_that_cannot_be():
    rng = np.random.default_rng(1)
    for epsilon in (0.0, 1.5, np.nan):
        with pytest.raises(InvalidInput, match="epsilon"):
            draw_pursuits(3, rng, LIGHT_ARM, epsilon=epsilon)
    with pytest.raises(InvalidInput, match="amplitude"):
        Pulses(np.ones(1), np.ones(1), np.zeros(1))
    with pytest.raises(InvalidInput, match="target"):
        Pulses(np.ones(2), np.ones(3), np.ones(2))
    with pytest.raises(InvalidInput, match="travel"):
        execute(LIGHT_ARM, Pulses(np.zeros(1), np.ones(1), np.ones(1)))
    with pytest.raises(InvalidInput, match="20 s"):
        execute(HEAVY_ARM, Pulses(np.array([0.5]), np.array([2.5]), np.array([1e-5])))
