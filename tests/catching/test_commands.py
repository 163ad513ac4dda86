"""When a goal becomes commands: motor nets that say and know what they are told to."""

from dataclasses import replace
from typing import Any, cast

import numpy as np
import pytest

from handeye.catching.commands import StepwiseCommands, TriggeredProfiles
from handeye.catching.memory import ShortTermMemory
from handeye.catching.settings import IMPROVED, SMOOTH
from handeye.catching.signals import MOTOR_COMMAND, PROFILE

ARM, YES, NO = np.array([0]), np.array([True]), np.array([False])


class Motor:
    """Stands in for a skill: its answer and how novel everything is to it can be set."""

    def __init__(self, table, *answer):
        self.table, self.answered, self.novel = table, answer, 0.0

    def answer(self, inputs):
        return np.tile(self.answered, (len(inputs), 1))

    def novelty(self, inputs):
        return np.full(len(inputs), self.novel)


def now(arm_x=1.0, arm_v=0.0, stop_x=1.5, left=0.5):
    """A memory of one tick, half a second before an arrival half a metre farther."""
    moment = {"time": 0.2, "arm_x": arm_x, "arm_v": arm_v, "stop_x": stop_x}
    moment["stop_time"] = 0.2 + left
    memory = ShortTermMemory(moment, 1, 1)
    memory.tick()
    for name, value in moment.items():
        memory.record(name, [value])
    return memory


def stepwise(limits=None):
    motor = Motor(MOTOR_COMMAND, 0.3)
    settings = replace(IMPROVED, novelty_limits=limits)
    return motor, StepwiseCommands(cast("Any", [motor]), settings, 1, repeated=True)


def test_the_net_commands_while_there_is_something_to_pursue():
    _, commands = stepwise()
    assert commands.command(now(), ARM, NO)[0] == 0.0
    assert commands.command(now(), ARM, YES)[0] == 0.3
    assert commands.pursuing[0]
    assert commands.command(now(), np.array([-1]), YES)[0] == 0.0
    assert commands.command(now(stop_x=np.nan), ARM, YES)[0] == 0.0


def test_what_was_never_practised_is_not_begun_and_not_gone_on_with():
    motor, commands = stepwise(limits=(0.2, 0.4))
    for novelty, acts in ((0.3, False), (0.2, True), (0.4, True), (0.41, False)):
        motor.novel = novelty
        assert bool(commands.command(now(), ARM, YES)[0]) is acts
    motor, commands = stepwise()
    motor.novel = 9.0
    assert commands.command(now(), ARM, YES)[0] == 0.3


def test_who_waits_begins_when_it_is_about_to_become_less_familiar():
    motor, commands = stepwise(limits=(0.2, 0.4))
    for novelty, acts in ((0.32, False), (0.3, False), (0.34, False), (0.36, True)):
        motor.novel = novelty
        assert bool(commands.command(now(), ARM, YES)[0]) is acts


def triggered(distance=0.5, amplitude=0.2, *, repeated=False):
    motor = Motor(PROFILE, distance, amplitude)
    return TriggeredProfiles(cast("Any", [motor]), SMOOTH, 1, repeated=repeated)


def driven_to_the_goal(commands):
    """One whole profile: driven, braked, at rest short of the goal."""
    assert commands.command(now(), ARM, YES)[0] == 0.2
    assert commands.command(now(arm_x=1.3, arm_v=1.0), ARM, YES)[0] < 0.0
    return commands.command(now(arm_x=1.4), ARM, YES)[0]


def test_a_profile_drives_then_brakes_then_leaves_the_arm_alone():
    commands = triggered()
    assert driven_to_the_goal(commands) == 0.0
    assert commands.command(now(arm_x=1.4), ARM, YES)[0] == 0.0


def test_another_profile_follows_only_where_that_is_allowed_and_the_goal_is_far():
    commands = triggered(repeated=True)
    driven_to_the_goal(commands)
    assert commands.command(now(arm_x=1.4), ARM, YES)[0] == 0.2
    commands = triggered(repeated=True)
    driven_to_the_goal(commands)
    near = 1.5 - 0.9 * SMOOTH.reach
    assert commands.command(now(arm_x=near), ARM, YES)[0] == 0.0


def test_a_profile_is_broken_off_when_the_ball_is_no_longer_comprehended():
    commands = triggered()
    commands.command(now(), ARM, YES)
    assert commands.command(now(arm_x=1.1, arm_v=1.0), ARM, NO)[0] == 0.0
    assert not commands.pursuing[0]


@pytest.mark.parametrize(
    ("answer", "moment"),
    [
        ((0.5, 0.9 * SMOOTH.least_amplitude), {}),  # slower than ever practised
        ((-0.5, 0.2), {}),  # away from the goal
        ((0.5, 0.2), {"arm_v": 1.1 * SMOOTH.rest_speed}),
        ((0.5, 0.2), {"left": 0.0}),
    ],
)
def test_a_profile_is_not_begun_where_it_makes_no_sense(answer, moment):
    assert triggered(*answer).command(now(**moment), ARM, YES)[0] == 0.0


def test_no_amplitude_is_larger_than_full_voltage():
    assert triggered(0.5, 7.0).command(now(), ARM, YES)[0] == 1.0
