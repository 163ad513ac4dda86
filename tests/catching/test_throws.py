"""Throws: what is drawn obeys the constraints exactly, and every toss is catchable."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import kstest

from handeye.catching.arm import ARMS
from handeye.catching.ball import BALLS, apex_of
from handeye.catching.layout import Layout
from handeye.catching.motion import position_after, velocity_after
from handeye.catching.throws import Throws, can_be_caught, draw_throws, launch
from handeye.catching.world import World
from handeye.errors import InvalidInput

MANY = draw_throws(400, np.random.default_rng(21))


def rows(throws):
    return np.column_stack([getattr(throws, f.name) for f in dataclasses.fields(Throws)])


def test_heights_and_crossings_are_met_exactly():
    layout = Layout()
    for throw in (MANY[i : i + 1] for i in range(len(MANY))):
        k = BALLS[throw.ball[0]].decay
        (x,), (z,), (vx,), (vz,) = throw.x, throw.z, throw.vx, throw.vz
        t = throw.crossing_time[0]
        apex = apex_of(z, vz, k)
        assert layout.apex[0] - 1e-12 <= apex <= layout.apex[1] + 1e-12
        np.testing.assert_allclose(position_after(z, vz, -9.81, k, t), 0.03, atol=1e-14)
        assert velocity_after(vz, -9.81, k, t) < 0.0
        reached = position_after(x, vx, 0.0, k, t)
        np.testing.assert_allclose(reached, throw.crossing_x[0], rtol=1e-13)
        np.testing.assert_allclose(velocity_after(vx, 0.0, k, t), throw.crossing_vx[0], rtol=1e-13)


@given(st.integers(0, 10_000))
def test_every_toss_is_catchable(seed):
    """Footnote 8, checked by the arm's own motion at full effort all the way."""
    throws = draw_throws(5, np.random.default_rng(seed))
    assert can_be_caught(throws).all()
    for i in range(5):
        arm = ARMS[throws.arm[i]]
        k = 1.0 / arm.time_constant
        pull = arm.force_per_volt * arm.supply / arm.mass
        within_reach = position_after(0.0, 0.0, pull, k, throws.crossing_time[i])
        assert abs(throws.crossing_x[i] - throws.arm_x[i]) <= within_reach
    low, high = Layout().arm_travel
    assert np.all((low <= throws.crossing_x) & (throws.crossing_x <= high))


def test_every_toss_leaves_time_to_look_and_to_rest():
    """The layout's own promise: 0.25 s to see, at rest 0.1 s before the ball."""
    for i, arm in enumerate(ARMS):
        mine = MANY[MANY.arm == i]
        needed = arm.minimum_rest_time(mine.crossing_x - mine.arm_x)
        assert np.all(0.25 + needed + 0.1 < mine.crossing_time)


def test_flights_last_about_as_long_as_in_figures_4_7_and_4_8():
    light, heavy = (MANY.crossing_time[MANY.ball == i] for i in (0, 1))
    assert 1.03 < light.min() < light.max() < 1.2
    assert 0.96 < heavy.min() < heavy.max() < 1.1


def test_nothing_is_in_the_way_of_a_launch():
    """With arms anywhere, no ball touches anything before it comes down."""
    layout = Layout()
    for arm_x in np.linspace(*layout.arm_travel, 5):
        world = World()
        state = world.start(dataclasses.replace(MANY, arm_x=np.full(len(MANY), arm_x)))
        for _ in range(36):
            state = world.step(state, np.zeros(len(MANY)))
            rising = state.vz > 0.0
            assert np.isinf(state.contact_time[rising]).all()
            assert np.all(state.z[rising] > 0.0)


@pytest.mark.parametrize("name", ["arm_x:arm_start", "x:launch_x", "z:launch_z",
                                  "crossing_x:crossing_x"])  # fmt: skip
def test_places_are_uniform(name):
    field, region = name.split(":")
    low, high = getattr(Layout(), region)
    assert kstest((getattr(MANY, field) - low) / (high - low), "uniform").pvalue > 0.01


def test_balls_and_arms_are_drawn_alike():
    counts = np.bincount(2 * MANY.ball + MANY.arm, minlength=4)
    assert counts.min() > 70
    only = draw_throws(30, np.random.default_rng(1), balls=[1], arms=[0])
    assert set(only.ball) == {1}
    assert set(only.arm) == {0}


def test_throws_drawn_in_parts_are_the_same():
    rng = np.random.default_rng(22)
    parts = np.concatenate([rows(draw_throws(n, rng)) for n in (3, 0, 7)])
    np.testing.assert_array_equal(parts, rows(draw_throws(10, np.random.default_rng(22))))


def test_what_cannot_be_caught_is_drawn_anew():
    far = Layout(arm_travel=(0.5, 12.0), arm_start=(0.5, 12.0), bounds_x=(-1.0, 13.0))
    every = draw_throws(200, np.random.default_rng(23), layout=far, catchable=False)
    assert 0.05 < can_be_caught(every, layout=far).mean() < 0.8
    drawn = draw_throws(200, np.random.default_rng(23), layout=far)
    assert len(drawn) == 200
    assert can_be_caught(drawn, layout=far).all()


def test_a_spare_second_or_a_narrow_travel_makes_throws_uncatchable():
    assert not can_be_caught(MANY, spare=2.0).any()
    narrow = Layout(arm_travel=(1.0, 1.2), arm_start=(1.0, 1.2))
    inside = (MANY.crossing_x >= 1.0) & (MANY.crossing_x <= 1.2)
    np.testing.assert_array_equal(can_be_caught(MANY, layout=narrow), inside)


def test_a_layout_without_catchable_throws_is_refused():
    hopeless = Layout(arm_travel=(3.0, 3.5), arm_start=(3.0, 3.5))
    with pytest.raises(InvalidInput, match="can be caught"):
        draw_throws(3, np.random.default_rng(1), layout=hopeless)


def test_launch_knows_where_the_ball_will_come_down():
    again = launch(MANY.ball, MANY.arm, MANY.arm_x, MANY.x, MANY.z, MANY.vx, MANY.vz)
    np.testing.assert_allclose(rows(again), rows(MANY), rtol=1e-12)
    assert len(launch(0, 0, 1.5, 0.0, 0.1, [1.0, 2.0, 3.0], 5.0)) == 3


def test_some_throws_can_be_picked():
    np.testing.assert_array_equal(rows(MANY[3:5]), rows(MANY)[3:5])
    np.testing.assert_array_equal(rows(MANY[MANY.ball == 1]), rows(MANY)[MANY.ball == 1])


def test_refuses_throws_that_cannot_be():
    rng = np.random.default_rng(1)
    with pytest.raises(InvalidInput, match="balls"):
        draw_throws(3, rng, balls=[2])
    with pytest.raises(InvalidInput, match="arms"):
        draw_throws(3, rng, arms=[])
    with pytest.raises(InvalidInput, match="n must"):
        draw_throws(-1, rng)
    with pytest.raises(InvalidInput, match="above the ground"):
        launch(0, 0, 1.5, 0.0, 0.02, 1.0, 5.0)
    with pytest.raises(InvalidInput, match="one value for each"):
        dataclasses.replace(MANY, vx=MANY.vx[:3])
    with pytest.raises(InvalidInput, match="finite"):
        dataclasses.replace(MANY, vx=np.full(len(MANY), np.nan))
