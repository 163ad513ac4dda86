from dataclasses import replace
from typing import Any, cast

import numpy as np
import pytest
from tests.catching.trained import record

from handeye.catching.learner import Learner, last_known
from handeye.catching.memory import ShortTermMemory
from handeye.catching.movements import Movements
from handeye.catching.recognition import UNKNOWN
from handeye.catching.settings import THESIS, CatcherSettings, Tuning
from handeye.catching.signals import ARM_RECOGNITION
from handeye.errors import InvalidInput

STOPPED = np.concatenate([np.linspace(1.0, 1.5, 26), np.full(15, 1.5)])
# It is within reach (5 cm) of its last place from the 23rd tick on, 0.575 s.


def movement():
    """One pursuit by hand: right for two ticks, braked in the third, at rest within it."""
    column = lambda *v: np.array(v)[:, np.newaxis]  # noqa: E731
    return Movements(
        time=column(0.0, 0.025, 0.05), arm_x=column(1.0, 1.02, 1.06), arm_v=column(0.0, 1.6, 1.5),
        arm_force=column(0.0, 3.0, 2.0), voltage=column(0.5, 0.5, -0.5), n_ticks=np.array([3]),
        stop_x=np.array([1.08]), stop_time=np.array([0.065]), hit_stop=np.array([False]),
    )  # fmt: skip


class Spy:
    """Stands in for a skill and keeps what it is to learn."""

    def __init__(self, skill):
        self.table, self.network = skill.table, skill.network

    def practise(self, inputs, outputs):
        self.inputs, self.outputs = inputs, outputs


def test_an_arm_is_learned_by_table_4_1():
    learner = Learner()
    own = learner.repertoire
    motor, state = (cast("Any", Spy(skills[1])) for skills in (own.motors, own.arm_states))
    own.motors[1], own.arm_states[1] = motor, state
    learner.learn_arm(1, movement())
    # Velocity, way to the stop, time to the stop -> the voltage then issued.
    expected = [[0.0, 0.08, 0.065], [1.6, 0.06, 0.04], [1.5, 0.02, 0.015]]
    np.testing.assert_allclose(motor.inputs, expected, rtol=1e-9)
    np.testing.assert_array_equal(motor.outputs, [[0.5], [0.5], [-0.5]])
    # Voltage, velocity -> the way to the next tick, velocity and force there; before it began, rest
    # stayed rest.
    resting = np.zeros((ARM_RECOGNITION.reach, 2))
    np.testing.assert_allclose(state.inputs, np.vstack([resting, [[0.5, 0.0], [0.5, 1.6]]]))
    np.testing.assert_allclose(
        state.outputs,
        np.vstack([np.zeros((len(resting), 3)), [[0.02, 1.6, 3.0], [0.04, 1.5, 2.0]]]),
        atol=1e-12,
    )
    assert learner.pursuits == [0, 1]


def test_a_movement_into_the_end_of_the_travel_teaches_nothing():
    learner = Learner()
    blocked = movement()
    blocked.hit_stop[:] = True
    learner.learn_arm(0, blocked)
    assert sum(learner.neurons.values()) == 0


def coached(**kwargs):
    learner = Learner()
    spy = cast("Any", Spy(learner.repertoire.corrections[1]))
    learner.repertoire.corrections[1] = spy
    learner.learn_catch(record(STOPPED, **kwargs))
    return spy


def test_the_mentor_adds_eq_4_5_and_4_6_to_what_was_generated():
    spy = coached(crossing=(1.53, 0.75), generated=(0.01, -0.02))
    expected = [0.01 + (1.53 - 1.5), -0.02 + (0.75 - 0.575 - 0.1)]
    np.testing.assert_allclose(spy.outputs, np.tile(expected, (41, 1)))
    time = 0.025 * np.arange(41)
    np.testing.assert_allclose(spy.inputs[:, 1], 1.53 - STOPPED)
    np.testing.assert_allclose(spy.inputs[:, 2], 0.75 - time)


def test_a_late_arm_is_sent_earlier_and_a_far_one_back():
    spy = coached(crossing=(1.46, 0.6))
    np.testing.assert_allclose(spy.outputs[:, 0], -0.04)
    np.testing.assert_allclose(spy.outputs[:, 1], 0.6 - 0.575 - 0.1)


def test_a_deflected_ball_counts_as_predicted_just_before():
    spy = coached(crossing=(1.5, 0.9), contact_time=0.88)
    # The hand-made record predicts half a metre and 0.2 s more than was observed.
    np.testing.assert_allclose(spy.inputs[:, 1], 2.0 - STOPPED)
    np.testing.assert_allclose(spy.outputs[:, 0], THESIS.largest_correction[0])


def test_what_was_predicted_after_the_touch_does_not_count():
    learner = Learner()
    spy = cast("Any", Spy(learner.repertoire.corrections[1]))
    learner.repertoire.corrections[1] = spy
    deflected = record(STOPPED, crossing=(1.5, 0.9), contact_time=0.88)
    deflected.traces["crossing_x"][deflected.sensed.time > 0.88] = -7.0
    learner.learn_catch(deflected)
    np.testing.assert_allclose(spy.inputs[:, 1], 2.0 - STOPPED)


def test_how_early_is_a_setting():
    learner = Learner(replace(THESIS, arrive_early=0.15))
    spy = cast("Any", Spy(learner.repertoire.corrections[1]))
    learner.repertoire.corrections[1] = spy
    learner.learn_catch(record(STOPPED, crossing=(1.5, 0.75)))
    np.testing.assert_allclose(spy.outputs[:, 1], 0.75 - 0.575 - 0.15)


def test_a_throw_with_an_unknown_arm_teaches_nothing():
    learner = Learner()
    learner.learn_catch(record(STOPPED, crossing=(1.5, 0.9), arm=-1.0))
    assert sum(learner.neurons.values()) == 0


def test_the_last_known_identity_counts():
    traces = np.array([[0.0, -1.0, -1.0], [1.0, 0.0, -1.0], [-1.0, np.nan, np.nan]])
    np.testing.assert_array_equal(last_known(traces), [1, 0, -1])


def test_wrong_identities_are_refused_and_teach_nothing():
    learner = Learner()
    for bad in (2, -1):
        with pytest.raises(InvalidInput):
            learner.learn_arm(bad, movement())
    assert sum(learner.neurons.values()) == 0
    for bad in (2, -2, 0.5, np.array([0, 3])):
        with pytest.raises(InvalidInput, match="ball must be identities"):
            learner.catcher(ball=cast("Any", bad))


@pytest.mark.parametrize(
    "bad",
    [
        {"ball_state": Tuning((1.0,), (1.0,), 0.1)},
        {"reach": 0.0},
        {"least_amplitude": 1.5},
        {"largest_correction": (0.1,)},
        {"novelty_limits": (0.3, 0.1)},
        {"perceptual_delay": -1},
        {"profiles": True},
    ],
)
def test_impossible_settings_are_refused(bad):
    with pytest.raises(InvalidInput):
        CatcherSettings(**bad)


@pytest.mark.parametrize("bad", [{"input_scales": (0.0,)}, {"threshold": -1.0}, {"replays": -1}])
def test_impossible_tunings_are_refused(bad):
    with pytest.raises(InvalidInput):
        Tuning(**({"input_scales": (1.0,), "output_scales": (1.0,), "threshold": 0.1} | bad))


def test_the_arm_recogniser_remembers_the_rest_before_a_movement():
    learner = Learner()
    spy = cast("Any", Spy(learner.repertoire.arm_recogniser.skill))
    learner.repertoire.arm_recogniser.skill = spy
    learner.learn_arm(1, movement())
    # From the second tick on there is something to recognise; six ticks before it was at rest.
    way = [0.02, 0.04]
    np.testing.assert_allclose(spy.inputs[:, 0], [0.5, 0.5])
    np.testing.assert_allclose(spy.inputs[:, [1, 3, 7]], 0.0)
    np.testing.assert_allclose(spy.inputs[:, 4], way)
    np.testing.assert_allclose(spy.inputs[:, 5], np.cumsum(way))
    np.testing.assert_array_equal(spy.outputs, [[0.0, 1.0], [0.0, 1.0]])


def test_an_arm_that_was_left_alone_is_not_recognised():
    learner = Learner()
    learner.learn_arm(1, movement())
    recogniser = learner.repertoire.arm_recogniser
    recogniser.threshold = -9.0  # names whatever it hears of
    streams = ("voltage", "arm_x", "arm_v", "arm_force")
    memory = ShortTermMemory(streams, 8, 1)
    for moved in (0.0, 0.1):
        for _ in range(8):
            memory.tick()
            for name in streams:
                memory.record(name, [moved])
        named = recogniser.choose(memory, np.array([0]))
        assert (named == [UNKNOWN]) == (moved == 0.0)
