"""Ball against a wall of the cup: when, and how it leaves."""

import numpy as np
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st
from tests.catching.scenes import HALF_WIDTH, HEIGHT, RADIUS

from handeye.catching.contact import Meeting, first_touch, push_end, rebound
from handeye.catching.motion import position_after, velocity_after

E = 0.8
sides = st.sampled_from([-HALF_WIDTH, HALF_WIDTH])
speeds = st.floats(-12.0, 12.0)


def meeting(x=0.0, z=0.05, vx=0.0, vz=0.0, *, arm_v=0.0, arm_pull=0.0, arm_decay=2.5, k=0.0):
    return Meeting(x, vx, 0.0, k, z, vz, -9.81, k, 0.0, arm_v, arm_pull, arm_decay)


meetings = st.builds(
    meeting,
    x=st.floats(-0.3, 0.3),
    z=st.floats(0.03, 0.3),
    vx=speeds,
    vz=speeds,
    arm_v=speeds,
    arm_pull=st.floats(-95.0, 95.0),
    arm_decay=st.floats(0.5, 9.0),
    k=st.sampled_from([0.0, 1.81e-4, 3.0]),
)


def gap(m, side, t):
    """The slow and obvious distance from surface to wall."""
    x = position_after(m.x, m.vx, m.pull_x, m.decay_x, t)
    z = position_after(m.z, m.vz, m.pull_z, m.decay_z, t)
    arm = position_after(m.arm, m.arm_v, m.arm_pull, m.arm_decay, t)
    return float(np.hypot(x - arm - side, max(z - HEIGHT, 0.0))) - RADIUS


@given(meetings, sides)
def test_never_steps_past_a_contact(m, side):
    assume(gap(m, side, 0.0) > 0.0)
    span = 0.025
    t = first_touch(m, side, HEIGHT, RADIUS, span)
    if t < np.inf:
        assert 0.0 <= t < span
        assert abs(gap(m, side, t)) < 2e-12
        assert gap(m, side, t + 1e-7) < gap(m, side, t)
    before = [gap(m, side, s) for s in np.linspace(0.0, min(t, span), 100)]
    assert min(before) > -2e-12


@given(st.floats(1.0, 8.0), st.floats(0.02, 0.2), sides, st.floats(1e-10, 1e-5), st.booleans())
@example(3.0, 0.1, HALF_WIDTH, 1e-11, True)
@example(3.0, 0.1, HALF_WIDTH, 1e-11, False)
def test_tells_a_graze_from_a_near_miss(vx, vz, side, depth, grazes):
    """A parabola whose top passes over a rim, a hair nearer or farther than the radius.

    It is flatter there than the ball is round, so nowhere else is the ball nearer.
    """
    top = vz / 9.81
    height = 0.3 + vz**2 / (2.0 * 9.81) - RADIUS + (depth if grazes else -depth)
    m = meeting(x=side - vx * top, z=0.3, vx=vx, vz=vz)
    t = first_touch(m, side, height, RADIUS, 2.0 * top)
    if grazes:
        assert t <= top
        distance = np.hypot(vx * (t - top), 0.3 + vz * t - 0.5 * 9.81 * t**2 - height)
        np.testing.assert_allclose(distance, RADIUS, atol=3e-12)
    else:
        assert t == np.inf


@given(meetings, sides)
def test_finds_first_what_lasts_a_nanosecond_only(m, side):
    """An arm so fast that a wall passes through all of the ball within a fraction of a tick."""
    fast = m._replace(x=side + 1.0, arm_v=4000.0, z=0.05, vz=0.0, vx=0.0, arm_pull=0.0)
    t = first_touch(fast, side, HEIGHT, RADIUS, 0.025)
    np.testing.assert_allclose(gap(fast, side, t), 0.0, atol=2e-12)
    assert t < 0.001


@pytest.mark.parametrize("way", [-1.0, 1.0])
def test_a_wall_at_rest_touches_when_it_starts_to_move(way):
    """Nothing moves, the ball leans on the wall: no gap and no speed to tell it by."""
    side = -way * HALF_WIDTH
    m = meeting(x=side + way * RADIUS, arm_pull=way * 5.0)
    assert first_touch(m, side, HEIGHT, RADIUS, 0.025) <= 2e-6
    away = m._replace(arm_pull=-way * 5.0)
    assert first_touch(away, side, HEIGHT, RADIUS, 0.025) == np.inf


def approaching(m, side):
    """Contact of a ball with the wall at `side`: the meeting moved there, normal and speed."""
    across = m.x - side
    if m.z > HEIGHT:
        # A rim: somewhere on a quarter circle above it.
        angle = np.clip(m.x / 0.3, -0.99, 0.99) * np.pi / 2
        n = np.array([np.sin(angle), np.cos(angle)])
        m = m._replace(x=side + RADIUS * n[0], z=HEIGHT + RADIUS * n[1])
    else:
        n = np.array([np.sign(across) or 1.0, 0.0])
        m = m._replace(x=side + RADIUS * n[0])
    relative = np.array([m.vx - m.arm_v, m.vz])
    return m, n, float(-n @ relative)


@given(meetings, sides)
def test_rebound_law(m, side):
    m, n, speed = approaching(m, side)
    assume(speed > 1e-6)
    vx, vz, pushed = rebound(m, side, HEIGHT, E)
    before, after = np.array([m.vx - m.arm_v, m.vz]), np.array([vx - m.arm_v, vz])
    tangent = np.array([-n[1], n[0]])
    np.testing.assert_allclose(after @ tangent, before @ tangent, rtol=1e-12, atol=1e-11)
    inner = n[1] == 0.0 and n[0] * side < 0.0
    parting = after @ n
    if inner:
        np.testing.assert_allclose(parting, 0.0, atol=1e-12)
    elif pushed:
        # What would part by less than half a millisecond of the push does not part.
        push = m.arm_pull - (m.arm_decay - m.decay_x) * m.arm_v
        assert abs(parting) < 1e-12
        assert E * speed < 0.5e-3 * pushed * push
    else:
        assert parting >= E * speed - 1e-11
        if parting > E * speed + 1e-9:
            assert n[1] > 0.0  # a rim, on which hops do not die out
            assert parting < 0.5e-3 * 250.0
    assert np.linalg.norm(after) <= np.linalg.norm(before) + 0.5e-3 * 250.0


@pytest.mark.parametrize(
    ("arm_pull", "expected"), [(5.0, (0.3, 1.0)), (-5.0, (0.3, 0.0)), (0.0, (0.3, 0.0))]
)
def test_the_inside_keeps_pushing_only_if_it_speeds_up(arm_pull, expected):
    # The left wall moves right at 0.3 m/s and meets a slower ball; no damping anywhere.
    m = meeting(
        x=-HALF_WIDTH + RADIUS, vx=0.1, vz=-1.0, arm_v=0.3, arm_pull=arm_pull, arm_decay=0.0
    )
    vx, vz, pushed = rebound(m, -HALF_WIDTH, HEIGHT, E)
    assert (vx, pushed) == expected
    assert vz == -1.0


def test_the_outside_throws_the_ball_off():
    m = meeting(x=HALF_WIDTH + RADIUS, vx=-1.0, vz=-2.0, arm_v=0.5)
    vx, vz, pushed = rebound(m, HALF_WIDTH, HEIGHT, E)
    np.testing.assert_allclose(vx, 0.5 + E * 1.5, rtol=1e-14)
    assert (vz, pushed) == (-2.0, 0.0)


@given(
    st.sampled_from([-1.0, 1.0]),
    speeds,
    st.floats(-95.0, 95.0),
    st.floats(0.5, 9.0),
    st.sampled_from([0.0, 1.81e-4, 3.0]),
)
def test_a_push_ends_when_arm_and_ball_would_slow_down_alike(way, v, pull, decay, k):
    def push(t):
        w = velocity_after(v, pull, decay, t)
        return way * ((pull - decay * w) + k * w)

    t = push_end(way, v, pull, decay, k)
    if t == 0.0:
        assert push(0.0) <= 0.0
        return
    moments = np.linspace(0.0, min(t, 20.0), 50)[:-1]
    assert min(push(s) for s in moments) >= -1e-9
    if t < np.inf:
        np.testing.assert_allclose(push(t), 0.0, atol=1e-10)
