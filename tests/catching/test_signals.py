"""Each row of tables 4.1 and 4.2, written out by hand."""

import numpy as np
import pytest

from handeye.catching import signals
from handeye.catching.memory import ShortTermMemory
from handeye.catching.skills import samples

TICKS = 12
NAMES = (*signals.SENSES, "voltage", "command", *signals.GOALS)
RNG = np.random.default_rng(3)
TRACES = {name: RNG.normal(size=(TICKS, 2)) for name in NAMES}
CONSTANT = ("crossing_x", "crossing_time", "crossing_vx", "stop_x", "stop_time")
STREAMS = TRACES | {name: TRACES[name][0] for name in CONSTANT}


def at(name, k):
    return TRACES[name][0 if name in CONSTANT else k]


def rows(name, k):  # noqa: PLR0911 (one return for each table)
    """Inputs and outputs of a table at tick k, as the thesis prints it."""
    match name:
        case "ARM_RECOGNITION":
            return [
                at("voltage", k - 1), at("voltage", k - 6), at("arm_v", k), at("arm_v", k - 5),
                at("arm_x", k) - at("arm_x", k - 1), at("arm_x", k) - at("arm_x", k - 6),
                at("arm_force", k), at("arm_force", k - 6),
            ], []  # fmt: skip
        case "ARM_STATE":
            return [at("voltage", k), at("arm_v", k)], [
                at("arm_x", k + 1) - at("arm_x", k), at("arm_v", k + 1), at("arm_force", k + 1),
            ]  # fmt: skip
        case "MOTOR_COMMAND":
            return [
                at("arm_v", k), at("stop_x", k) - at("arm_x", k), at("stop_time", k) - at("time", k)
            ], [at("command", k)]  # fmt: skip
        case "CATCH_CORRECTION":
            return [
                at("arm_v", k), at("crossing_x", k) - at("arm_x", k),
                at("crossing_time", k) - at("time", k),
            ], [at("correction_x", k), at("correction_time", k)]  # fmt: skip
        case "BALL_RECOGNITION":
            pasts = [
                at(axis, k) - at(axis, k - ago)
                for ago in (1, 3, 5)
                for axis in ("ball_x", "ball_z")
            ]
            return [at("ball_vx", k), at("ball_vz", k), *pasts], []
        case "BALL_STATE":
            return [
                at("ball_vx", k), at("ball_vz", k), at("ball_x", k) - at("ball_x", k - 2),
                at("ball_z", k) - at("ball_z", k - 2),
            ], [
                at("ball_x", k + 1) - at("ball_x", k), at("ball_z", k + 1) - at("ball_z", k),
                at("ball_vx", k + 1), at("ball_vz", k + 1),
            ]  # fmt: skip
        case "BALL_CROSSING":
            return [
                at("ball_vx", k), at("ball_vz", k), at("ball_x", k) - at("ball_x", k - 2),
                at("ball_z", k) - at("ball_z", k - 2), at("ball_z", k),
            ], [
                at("crossing_vx", k), at("crossing_time", k) - at("time", k),
                at("crossing_x", k) - at("ball_x", k),
            ]  # fmt: skip
    raise AssertionError(name)


SPAN = {
    "ARM_RECOGNITION": (6, TICKS), "ARM_STATE": (0, TICKS - 1), "MOTOR_COMMAND": (0, TICKS),
    "CATCH_CORRECTION": (0, TICKS), "BALL_RECOGNITION": (5, TICKS), "BALL_STATE": (2, TICKS - 1),
    "BALL_CROSSING": (2, TICKS),
}  # fmt: skip
"""From the first tick that looks back far enough to the last whose outputs are observed."""


@pytest.mark.parametrize("name", SPAN)
def test_samples_are_those_of_the_tables_trial_after_trial(name):
    learned = samples(getattr(signals, name), STREAMS, {})
    expected = [rows(name, k) for k in range(*SPAN[name])]
    inputs = np.concatenate([[[v[i] for v in x] for x, _ in expected] for i in (0, 1)])
    outputs = np.concatenate([[[v[i] for v in y] for _, y in expected] for i in (0, 1)])
    np.testing.assert_allclose(learned.inputs, inputs, rtol=1e-12)
    np.testing.assert_allclose(learned.outputs, outputs.reshape(len(inputs), -1), rtol=1e-12)


def test_ticks_after_the_end_of_a_trial_teach_nothing():
    ended = {name: trace.copy() for name, trace in STREAMS.items()}
    for name in signals.SENSES:
        ended[name][7:, 1] = np.nan
    learned = samples(signals.BALL_CROSSING, ended, {})
    assert len(learned.inputs) == (TICKS - 2) + (7 - 2)


def test_late_senses_meet_the_command_issued_when_they_arrive():
    late = dict.fromkeys((*signals.SENSES, "voltage"), 2)
    learned = samples(signals.MOTOR_COMMAND, STREAMS, late)
    np.testing.assert_array_equal(learned.outputs[:10, 0], TRACES["command"][2:, 0])
    np.testing.assert_array_equal(learned.inputs[:10, 0], TRACES["arm_v"][:-2, 0])


def test_equally_late_streams_keep_their_phase():
    late = dict.fromkeys((*signals.SENSES, "voltage"), 3)
    prompt, delayed = (samples(signals.ARM_STATE, STREAMS, lags) for lags in ({}, late))
    np.testing.assert_array_equal(delayed.inputs, prompt.inputs)
    np.testing.assert_array_equal(delayed.outputs, prompt.outputs)


def test_reading_needs_enough_history():
    memory = ShortTermMemory(NAMES, 8, 1)
    for _ in range(6):
        memory.tick()
        for name in NAMES:
            memory.record(name, [1.0])
    assert np.isnan(signals.read(signals.ARM_RECOGNITION.inputs, memory)).any()
    assert not np.isnan(signals.read(signals.BALL_RECOGNITION.inputs, memory)).any()
