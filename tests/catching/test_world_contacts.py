"""Contacts in the world: nothing penetrates, nothing gains; an independent integration."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.catching.scenes import HALF_WIDTH, HEIGHT, RADIUS, gaps, scene

from handeye.catching.arm import ARMS
from handeye.catching.ball import BALLS
from handeye.catching.layout import Layout
from handeye.catching.state import CAUGHT
from handeye.catching.throws import launch
from handeye.catching.world import World

FINE = World(Layout(tick=0.001))


def test_the_ball_is_never_inside_anything():
    rng = np.random.default_rng(11)
    _, state = scene(80, rng)
    command = np.zeros(80)
    touched = 0
    for tick in range(400):
        if tick % 25 == 0:
            command = rng.normal(0.0, 0.3, 80)
        state = FINE.step(state, command, after=9.0)
        assert gaps(state.x, state.z, state.arm_x).min() > -1e-9
        assert state.z.min() >= RADIUS - 1e-15
        touched = max(touched, int(np.isfinite(state.contact_time).sum()))
    assert touched > 25


def energy(state):
    return 0.5 * (state.vx**2 + state.vz**2) + 9.81 * state.z


def test_a_cup_at_rest_gives_no_energy():
    """Nor do hops on its rims: they stay, but do not grow."""
    _, state = scene(150, np.random.default_rng(12), world=FINE, arm_speed=0.0)
    lost = np.zeros(150)
    for _ in range(500):
        new = FINE.step(state, np.zeros(150), after=9.0)
        gained = energy(new) - energy(state)
        # A hop is started with 0.5 ms of gravity at most.
        assert gained.max() < 0.5 * (0.5e-3 * 9.81) ** 2 * 1.01
        lost -= gained
        state = new
    assert lost.min() > -2e-5
    assert np.sum(state.lying) > 25


def test_balls_come_to_rest_on_the_ground_and_in_the_cup():
    """Hops become ever shorter and end, as they should, in finite time (no Zeno)."""
    x = np.array([1.5, 1.56, 1.9])
    state = FINE.start(launch(1, 0, 1.5, x, 0.2, 0.0, 0.0))
    for _ in range(3000):
        state = FINE.step(state, np.zeros(3), after=9.0)
    np.testing.assert_array_equal(state.lying, True)
    np.testing.assert_array_equal(state.z, RADIUS)
    np.testing.assert_array_equal(state.vz, 0.0)


def test_bounces_off_the_ground_have_the_restitution_of_the_cup():
    world = World()
    e = world.layout.cup.restitution
    height = 0.5
    throws = launch(1, 0, 0.6, 2.0, RADIUS + height, 0.0, 0.0)
    state, tops, last_vz = world.start(throws), [], -1.0
    fine = World(Layout(tick=1e-3))
    for _ in range(2000):
        state = fine.step(state, [0.0], after=9.0)
        if state.vz[0] <= 0.0 < last_vz:
            tops.append(state.z[0] - RADIUS)
        last_vz = state.vz[0]
    np.testing.assert_allclose(tops[:4], height * e ** (2.0 * np.arange(1, 5)), rtol=2e-3)


def test_a_caught_ball_slides_along_the_floor_with_the_walls():
    """Pushed by the wall behind it while the arm speeds up, on its own while it slows down."""
    world = World()
    state = world.start(launch(1, 1, 1.0, 1.0, 0.3, 0.0, 0.0))
    for _ in range(12):
        state = world.step(state, [0.0], after=9.0)
    assert state.outcome[0] == CAUGHT
    for _ in range(8):
        state = world.step(state, [0.3], after=9.0)
    assert state.pushed[0] == 1.0
    np.testing.assert_allclose(state.x - state.arm_x, RADIUS - HALF_WIDTH, atol=1e-12)
    np.testing.assert_array_equal(state.vx, state.arm_v)
    fast = state.vx[0]
    state = world.step(state, [-0.3], after=9.0)
    assert state.pushed[0] == 0.0
    np.testing.assert_allclose(state.vx[0], fast, rtol=1e-4)
    for _ in range(4):
        state = world.step(state, [-0.3], after=9.0)
    # Now it leans on the wall in front, which slows it down.
    assert state.pushed[0] == -1.0
    np.testing.assert_allclose(state.x - state.arm_x, HALF_WIDTH - RADIUS, atol=1e-12)


def test_an_arm_at_its_stop_lets_the_ball_go_on():
    world = World()
    state = world.start(launch(1, 1, 1.9, 1.9, 0.3, 0.0, 0.0))
    while not state.lying[0]:
        state = world.step(state, [0.0], after=9.0)
    speed = 0.0
    while state.arm_x[0] < 2.5:
        speed = state.arm_v[0]
        state = world.step(state, [0.5], after=9.0)
    assert state.arm_v[0] == 0.0
    assert state.vx[0] >= speed > 1.0
    for _ in range(4):
        state = world.step(state, [0.0], after=9.0)
    # It meets the wall in front, which takes all of its speed.
    assert state.vx[0] == 0.0
    np.testing.assert_allclose(state.x[0], 2.5 + HALF_WIDTH - RADIUS, atol=1e-12)


def integrated(state, i, voltage, span):
    """Ball i by Runge-Kutta with event location, and rebounds written out; no closed forms."""
    arm, ball = ARMS[state.arm[i]], BALLS[state.ball[i]]
    e, k = Layout().cup.restitution, ball.decay

    def law(_, s):
        vx, vz, v = s[2], s[3], s[5]
        drive = arm.force_per_volt * (voltage - arm.back_emf * v) - arm.damping * v
        return vx, vz, -k * vx, -k * vz - 9.81, v, drive / arm.mass

    def wall(side):
        def gap(_, s):
            return np.hypot(s[0] - s[4] - side, max(s[1] - HEIGHT, 0.0)) - RADIUS

        return gap

    def ground(_, s):
        return s[1] - RADIUS

    events = [wall(-HALF_WIDTH), wall(HALF_WIDTH), ground]
    for event in events:
        event.terminal, event.direction = True, -1.0
    s = np.array([f[i] for f in (state.x, state.z, state.vx, state.vz, state.arm_x, state.arm_v)])
    t, hits = 0.0, 0
    while True:
        leg = solve_ivp(law, (t, span), s, events=events, rtol=1e-10, atol=1e-12, max_step=5e-3)
        s, t = leg.y[:, -1].copy(), leg.t[-1]
        if leg.status != 1 or leg.t_events is None:
            return s, hits
        hits += 1
        which = next(j for j in range(3) if len(leg.t_events[j]))
        if which == 2:
            if abs(s[0] - s[4]) < HALF_WIDTH:
                return None, hits  # lies on the floor from now on: not integrated here
            s[3] *= -e
            continue
        side = (-HALF_WIDTH, HALF_WIDTH)[which]
        n = np.array([s[0] - s[4] - side, max(s[1] - HEIGHT, 0.0)])
        n /= np.hypot(*n)
        if n[1] == 0.0 and n[0] * side < 0.0:
            return None, hits  # inside: may be pushed from now on
        speed = -(n @ (s[2] - s[5], s[3]))
        s[2:4] += (1.0 + e) * speed * n


@pytest.mark.parametrize("voltage", [-4.0, 0.0, 4.0])
def test_agrees_with_an_independent_integration(voltage):
    # A travel so wide that no stop is met.
    world = World(Layout(arm_travel=(-0.9, 3.9)))
    world, state = scene(24, np.random.default_rng(13), world=world)
    span = 8 * world.layout.tick
    command = np.arctanh(voltage / 20.0) / 4.0
    end = state
    for _ in range(8):
        end = world.step(end, np.full(24, command), after=9.0)
    bounced = 0
    for i in range(24):
        expected, hits = integrated(state, i, voltage, span)
        if expected is None or hits > 3:
            continue
        found = [f[i] for f in (end.x, end.z, end.vx, end.vz, end.arm_x, end.arm_v)]
        np.testing.assert_allclose(found, expected, atol=1e-5)
        bounced += hits > 0
    assert bounced >= 4


def test_work_per_tick_is_bounded_where_a_rim_carries_the_ball():
    """Balanced on a rim that is shaken: hops, thousands of them would not end."""
    fine = World(Layout(tick=0.05))
    x = 1.6 + np.linspace(-1e-3, 1e-3, 5)
    state = fine.start(launch(1, 0, 1.5, x, HEIGHT + RADIUS + 1e-6, 0.0, 0.0))
    for tick in range(10):
        state = fine.step(state, np.full(5, 0.5 * (-1.0) ** tick), after=9.0)
        assert np.all(np.isfinite(state.x + state.z))
        assert gaps(state.x, state.z, state.arm_x).min() > -1e-9
