"""The world: ticks, batches, ends of trials."""

import numpy as np
import pytest
from tests.catching.scenes import scene

from handeye.catching.arm import ARMS, Arm
from handeye.catching.ball import BALLS, HEAVY_BALL, Ball
from handeye.catching.layout import Cup, Layout
from handeye.catching.state import CAUGHT, FLYING, KNOCKED_OUT, MISSED
from handeye.catching.throws import draw_throws, launch
from handeye.catching.world import World
from handeye.errors import InvalidInput
from handeye.sensors.retina import Retina


def same(one, other):
    for field, expected in zip(one, other, strict=True):
        np.testing.assert_array_equal(field, expected)


def run(world, state, commands, *, after=0.0):
    for command in commands:
        state = world.step(state, command, after=after)
    return state


def test_a_step_leaves_the_old_state_alone():
    world, state = scene(20, np.random.default_rng(1))
    before = [field.copy() for field in state]
    world.step(state, np.ones(20))
    same(state, before)


def test_a_batch_equals_single_trials():
    rng = np.random.default_rng(2)
    world, state = scene(12, rng)
    commands = rng.normal(0.0, 0.3, (15, 12))
    together = run(world, state, commands, after=1.0)
    for i in range(12):
        alone = run(world, type(state)._make(f[i : i + 1] for f in state), commands[:, i : i + 1],
                    after=1.0)  # fmt: skip
        same(alone, [field[i : i + 1] for field in together])


def test_restart_renews_some_trials_only():
    rng = np.random.default_rng(3)
    world, state = scene(6, rng)
    state = run(world, state, np.zeros((8, 6)))
    fresh = draw_throws(2, rng)
    which = np.array([False, True, False, False, True, False])
    renewed = world.restart(state, which, fresh)
    same([field[which] for field in renewed], world.start(fresh))
    same([field[~which] for field in renewed], [field[~which] for field in state])
    same(world.restart(state, [1, 4], fresh), renewed)
    assert state.time[1] > 0.0


def test_ticks_split_without_a_trace():
    """The same voltages held over one tick or over fifty that are fifty times shorter."""
    rng = np.random.default_rng(4)
    world, state = scene(60, rng)
    fine = World(Layout(tick=world.layout.tick / 25))
    coarse = split = state
    for _ in range(16):
        command = rng.normal(0.0, 0.2, 60) * rng.integers(0, 2, 60)
        coarse = world.step(coarse, command, after=9.0)
        split = run(fine, split, [command] * 25, after=9.0)
        for name in ("x", "z", "arm_x", "arm_v", "time", "end_time", "contact_time"):
            one, many = getattr(coarse, name), getattr(split, name)
            np.testing.assert_allclose(one, many, rtol=1e-9, atol=1e-9)
        np.testing.assert_array_equal(coarse.outcome, split.outcome)
    assert {CAUGHT, MISSED} <= set(coarse.outcome)


def test_nobody_in_the_way_the_ball_crosses_where_and_when_it_was_aimed():
    throws = draw_throws(100, np.random.default_rng(5))
    world = World(collisions=False)
    state = run(world, world.start(throws), np.zeros((60, 100)))
    seen = world.final(state)
    np.testing.assert_allclose(seen.time, throws.crossing_time, rtol=1e-14)
    np.testing.assert_allclose(seen.ball_x, throws.crossing_x, rtol=1e-13)
    np.testing.assert_allclose(seen.ball_vx, throws.crossing_vx, rtol=1e-12)
    np.testing.assert_allclose(seen.ball_z, 0.03, atol=1e-15)
    assert np.all(seen.ball_vz < 0.0)
    assert np.all(state.outcome == MISSED)
    assert np.all(np.isinf(state.contact_time))
    assert not seen.active.any()


@pytest.mark.parametrize("ball", [0, 1])
@pytest.mark.parametrize(("offset", "outcome"), [(0.0, CAUGHT), (0.069, CAUGHT), (0.131, MISSED)])
def test_caught_is_what_meets_the_floor_between_the_walls(ball, offset, outcome):
    throws = launch(ball, 0, 1.5, 1.5 + offset, 0.5, 0.0, 0.0)
    world = World()
    state = run(world, world.start(throws), np.zeros((30, 1)))
    assert state.outcome[0] == outcome
    np.testing.assert_allclose(state.end_time, throws.crossing_time, rtol=1e-14)
    assert (state.contact_time[0] == state.end_time[0]) == (outcome == CAUGHT)
    assert state.time[0] == state.end_time[0]


def test_the_trial_goes_on_after_a_bounce_off_the_rim():
    throws = launch(1, 0, 1.5, 1.63 - 0.005, 0.5, 0.0, 0.0)
    world = World()
    state = run(world, world.start(throws), np.zeros((80, 1)))
    assert state.contact_time[0] < throws.crossing_time[0] < state.end_time[0]
    assert state.outcome[0] == MISSED
    assert state.arm_at_crossing[0] == 1.5


@pytest.mark.parametrize(
    ("vx", "vz", "place"), [(9.0, 9.0, 4.0), (-9.0, 9.0, -1.0), (0.0, 9.5, 4.0)]
)
def test_a_ball_out_of_bounds_ends_the_trial_at_the_bound(vx, vz, place):
    throws = launch(1, 0, 0.8, 1.5, 0.5, vx, vz)
    world = World()
    state = run(world, world.start(throws), np.zeros((60, 1)))
    assert state.outcome[0] == KNOCKED_OUT
    reached = state.x[0] if vx else state.z[0]
    np.testing.assert_allclose(reached, place, atol=1e-12)
    assert state.end_time[0] < throws.crossing_time[0]
    assert np.isfinite(world.final(state).ball_x[0])


@pytest.mark.parametrize("command", [3.0, -3.0])
def test_the_arm_stops_dead_at_the_end_of_its_travel_and_can_leave_again(command):
    throws = draw_throws(8, np.random.default_rng(6))
    world = World()
    state = run(world, world.start(throws), [np.full(8, command)] * 35)
    low, high = world.layout.arm_travel
    np.testing.assert_array_equal(state.arm_x, high if command > 0.0 else low)
    np.testing.assert_array_equal(state.arm_v, 0.0)
    # It still pushes: the sensor feels all of the drive.
    volts = 20.0 * np.tanh(4.0 * command)
    pushing = [ARMS[i].force_per_volt * volts for i in state.arm]
    np.testing.assert_allclose(world.sense(state).arm_force, pushing, rtol=1e-14)
    back = world.step(state, np.full(8, -command))
    assert np.all(np.sign(command) * (state.arm_x - back.arm_x) > 0.0)


def test_force_belongs_to_the_voltage_just_before_the_tick():
    throws = launch(1, [0, 1], 1.5, 0.1, 0.1, 1.0, 5.0)
    world = World()
    state = world.start(throws)
    np.testing.assert_array_equal(world.sense(state).arm_force, 0.0)
    state = world.step(state, [0.2, 0.2])
    sensed = world.sense(state)
    command = np.full(2, 0.2)
    expected = [ARMS[i].force(ARMS[i].motor_voltage(command), sensed.arm_v)[i] for i in (0, 1)]
    np.testing.assert_allclose(sensed.arm_force, expected, rtol=1e-13)


def test_trials_stop_at_their_end_or_when_the_time_after_is_over():
    throws = launch(1, 0, 1.5, 1.5, [0.3, 0.6], 0.0, 0.0)
    world = World()
    start = world.start(throws)
    at_once = run(world, start, np.zeros((60, 2)))
    later = run(world, start, np.zeros((60, 2)), after=0.3)
    np.testing.assert_array_equal(at_once.time, throws.crossing_time)
    np.testing.assert_allclose(later.time, throws.crossing_time + 0.3, rtol=1e-14)
    same(world.final(at_once), world.final(later))


def test_what_the_eye_does_not_see_is_nan():
    world = World(retina=Retina(center_x=1.5, center_z=0.5, width=1.0))
    sensed = world.sense(world.start(launch(1, 0, 1.5, [1.5, 0.1], 0.6, 1.0, 1.0)))
    assert sensed.ball_x[0] == 1.5
    for field in (sensed.ball_x, sensed.ball_z, sensed.ball_vx, sensed.ball_vz):
        assert np.isnan(field[1])
    assert np.all(np.isfinite(sensed.arm_x))


def test_by_default_the_eye_sees_all_that_is_in_bounds():
    layout = Layout()
    world = World(layout)
    x, z = np.meshgrid(layout.bounds_x, [0.03, layout.ceiling])
    seen = world.retina.sight(x.ravel(), z.ravel(), x.ravel(), z.ravel())
    assert np.isfinite(seen).all()


def test_a_new_trial_is_flying():
    world = World()
    assert world.start(draw_throws(3, np.random.default_rng(7))).outcome.tolist() == [FLYING] * 3


def test_refuses_what_it_cannot_simulate():
    world = World()
    throws = draw_throws(3, np.random.default_rng(8))
    state = world.start(throws)
    for voltage, says in (([1.0, np.nan, 0.0], "finite"), ([1.0, 2.0], "shape")):
        with pytest.raises(InvalidInput, match=says):
            world.step(state, voltage)
    with pytest.raises(InvalidInput, match="identities"):
        World(balls=(HEAVY_BALL,)).start(launch(1, 0, 1.5, 0.1, 0.1, 1.0, 5.0))
    with pytest.raises(InvalidInput, match="travel"):
        world.start(launch(1, 0, 0.4, 0.1, 0.1, 1.0, 5.0))
    with pytest.raises(InvalidInput, match="wall"):
        world.start(launch(1, 0, 1.5, 1.41, 0.05, 1.0, 5.0))
    with pytest.raises(InvalidInput, match="cup"):
        World(arms=(Arm(0.1, cup=Cup(width=0.3)),))
    with pytest.raises(InvalidInput, match="fit"):
        World(balls=(*BALLS, Ball(1.0, radius=0.09)))
