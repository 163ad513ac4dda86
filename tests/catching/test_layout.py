"""The layout: one place for the geometry, checked when it is made."""

import dataclasses

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from handeye.catching.arm import ARMS
from handeye.catching.ball import BALLS
from handeye.catching.layout import Cup, Layout
from handeye.errors import InvalidInput


def test_the_cup_is_that_of_the_thesis():
    assert (Cup().width, Cup().height) == (0.20, 0.08)


def test_the_clock_runs_at_40_hz():
    assert Layout().tick == 0.025


@pytest.mark.parametrize("zeta", [0.0, 0.07, 0.5, 0.9])
def test_restitution_is_that_of_a_mass_leaving_a_damped_spring(zeta):
    """Integrate x'' + 2 zeta x' + x = 0 from x = 0 at unit speed until x is 0 again."""

    def leaves(_, state):
        return state[0]

    leaves.terminal, leaves.direction = True, 1.0  # pyright: ignore[reportFunctionMemberAccess]
    contact = solve_ivp(
        lambda _, s: (s[1], -s[0] - 2.0 * zeta * s[1]),
        (0.0, 100.0),
        (0.0, -1.0),
        events=leaves,
        rtol=1e-11,
        atol=1e-13,
    )
    parting = contact.y[1, -1]
    np.testing.assert_allclose(Cup(damping_ratio=zeta).restitution, parting, rtol=1e-8)


def test_the_default_rebound_is_that_of_a_rubber_ball():
    assert 0.75 < Cup().restitution < 0.85


def test_the_slowest_arm_has_time_to_look():
    """The reason for the dimensions: a quarter of a second to see, and a tenth to spare."""
    layout = Layout()
    farthest = layout.crossing_x[1] - layout.arm_start[0]
    slowest = max(float(arm.minimum_rest_time(np.array(farthest))) for arm in ARMS)
    shortest_flight = 0.97
    assert 0.25 + slowest + 0.1 < shortest_flight


def test_no_arm_can_be_where_balls_are_launched():
    layout = Layout()
    nearest = layout.arm_travel[0] - 0.5 * layout.cup.width
    assert layout.launch_x[1] + max(ball.radius for ball in BALLS) < nearest


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"arm_travel": (2.5, 0.5)}, "arm_travel"),
        ({"arm_start": (0.4, 2.0)}, "arm_start"),
        ({"bounds_x": (0.0, 1.0)}, "bounds_x"),
        ({"launch_z": (0.0, 0.1)}, "launch_z"),
        ({"launch_z": (0.1, 1.3)}, "launch_z"),
        ({"crossing_x": (0.8, 9.0)}, "crossing_x"),
        ({"ceiling": 1.4}, "ceiling"),
        ({"tick": 0.0}, "tick"),
        ({"apex": (1.25, np.inf)}, "apex"),
        ({"apex": (1.25, 1.3, 1.5)}, "apex"),
    ],
)
def test_refuses_a_layout_that_cannot_be(changes, says):
    with pytest.raises(InvalidInput, match=says):
        dataclasses.replace(Layout(), **changes)


@pytest.mark.parametrize(
    "changes", [{"width": 0.0}, {"height": -0.1}, {"damping_ratio": 1.0}, {"damping_ratio": -0.1}]
)
def test_refuses_a_cup_that_cannot_be(changes):
    with pytest.raises(InvalidInput, match=next(iter(changes))):
        Cup(**changes)
