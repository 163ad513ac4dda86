"""Playing N throws against a controller, and what is recorded."""

import numpy as np
import pytest

from handeye.catching.play import Controller, play
from handeye.catching.state import CAUGHT, MISSED
from handeye.catching.throws import draw_throws, launch
from handeye.catching.world import World
from handeye.errors import InvalidInput

THROWS = draw_throws(30, np.random.default_rng(31))


class Reacher:
    """Drives to fixed places; remembers what it was shown."""

    def __init__(self, places, *, gain=4.0, damping=0.6):
        self.places, self.gain, self.damping = places, gain, damping
        self.begun, self.seen, self.said = [], [], []

    def begin(self, n):
        self.begun.append(n)

    def act(self, sensed):
        self.seen.append(sensed)
        self.said.append(self.gain * (self.places - sensed.arm_x) - self.damping * sensed.arm_v)
        return self.said[-1]

    def traces(self):
        return {"distance": self.places - self.seen[-1].arm_x}


def aware(throws=THROWS):
    """One that was told where the balls come down."""
    return Reacher(throws.crossing_x)


def test_who_knows_the_crossing_catches_every_ball():
    recording = play(World(), THROWS, aware())
    assert recording.caught.all()
    assert np.all(recording.outcome == CAUGHT)
    np.testing.assert_allclose(recording.final.time, THROWS.crossing_time, rtol=1e-12)
    np.testing.assert_array_equal(recording.contact_time, recording.final.time)
    error = recording.final.arm_x - THROWS.crossing_x
    np.testing.assert_allclose(recording.position_error, error, atol=1e-9)
    assert np.abs(recording.position_error).max() < 0.07


def test_who_stays_away_catches_none():
    recording = play(World(), THROWS, Reacher(np.full(30, 0.5)))
    far = THROWS.crossing_x > 0.8
    assert np.all(recording.outcome[far] == MISSED)
    assert not recording.caught[far].any()


def test_each_tick_is_sensed_before_the_command_that_follows():
    controller: Controller = aware()
    world = World()
    recording = play(world, THROWS, controller)
    assert controller.begun == [30]  # pyright: ignore[reportAttributeAccessIssue]
    ticks, n = recording.sensed.time.shape
    assert n == 30
    assert ticks == int(np.ceil(THROWS.crossing_time.max() * 40))
    state = world.start(THROWS)
    for k in range(ticks):
        running = state.time < state.end_time
        now = world.sense(state)
        for field, expected in zip(recording.sensed, now, strict=True):
            np.testing.assert_array_equal(field[k][running], expected[running])
        np.testing.assert_allclose(now.time[running], 0.025 * k, rtol=1e-14)
        state = world.step(state, np.where(running, recording.voltage[k], 0.0))


def test_after_the_end_there_is_nothing_and_no_voltage():
    throws = launch([0, 1], 0, 1.5, 1.5, [0.3, 0.9], 0.0, 0.0)
    recording = play(World(), throws, Reacher(np.full(2, 2.0)), after=0.2)
    for i in range(2):
        end = throws.crossing_time[i]
        times = 0.025 * np.arange(len(recording.voltage))
        over, stopped = times >= end, times >= end + 0.2
        assert np.all(recording.voltage[over & ~stopped, i] == 0.0)
        assert np.isnan(recording.voltage[stopped, i]).all()
        assert np.isnan(recording.sensed.ball_x[stopped, i]).all()
        assert np.isfinite(recording.sensed.ball_x[~stopped, i]).all()
        np.testing.assert_array_equal(recording.sensed.active[:, i], ~over)


def test_after_changes_nothing_before_the_end():
    short, long = (play(World(), THROWS, aware(), after=after) for after in (0.0, 0.3))
    np.testing.assert_allclose(short.position_error, long.position_error, atol=1e-14)
    ticks = len(short.voltage)
    before = short.sensed.active
    np.testing.assert_array_equal(short.sensed.arm_x[before], long.sensed.arm_x[:ticks][before])


def test_traces_are_recorded_at_every_tick():
    recording = play(World(), THROWS, aware())
    running = recording.sensed.active
    np.testing.assert_array_equal(
        recording.traces["distance"][running],
        (THROWS.crossing_x - recording.sensed.arm_x)[running],
    )


def test_position_error_is_taken_when_the_undisturbed_ball_would_cross():
    """A ball that bounces off the rim crosses later; the error is of its first way."""
    throws = launch(1, 1, 1.5, 1.625, 0.5, 0.0, 0.0)
    recording = play(World(), throws, Reacher(np.array([1.52]), gain=0.05, damping=0.0))
    assert recording.final.time[0] > throws.crossing_time[0] + 0.04
    tick = int(throws.crossing_time[0] / 0.025)
    errors = recording.sensed.arm_x[tick : tick + 2, 0] - throws.crossing_x[0]
    assert errors[0] < recording.position_error[0] < errors[1]


def test_some_trials_can_be_picked():
    recording = play(World(), THROWS, aware())
    alone = recording[4:6]
    assert len(alone) == 2
    np.testing.assert_array_equal(alone.sensed.ball_x, recording.sensed.ball_x[:, 4:6])
    np.testing.assert_array_equal(alone.traces["distance"], recording.traces["distance"][:, 4:6])
    np.testing.assert_array_equal(alone.final.arm_x, recording.final.arm_x[4:6])


def test_no_throws_make_an_empty_recording():
    nobody = draw_throws(0, np.random.default_rng(1))
    recording = play(World(), nobody, Reacher(np.empty(0)))
    assert len(recording) == 0
    assert recording.sensed.time.shape == (0, 0)


@pytest.mark.parametrize("bad", [np.zeros(3), np.full(30, np.nan), np.full(30, np.inf)])
def test_refuses_commands_that_are_none(bad):
    class Broken(Reacher):
        def act(self, sensed):
            super().act(sensed)
            return bad

    with pytest.raises(InvalidInput, match="Broken must command one finite voltage"):
        play(World(), THROWS, Broken(THROWS.crossing_x))


def test_what_is_commanded_for_trials_that_are_over_does_not_matter():
    class Silent(Reacher):
        def act(self, sensed):
            return np.where(sensed.active, super().act(sensed), np.nan)

    one = play(World(), THROWS, aware(), after=0.1)
    other = play(World(), THROWS, Silent(THROWS.crossing_x), after=0.1)
    np.testing.assert_array_equal(one.voltage, other.voltage)


def test_refuses_to_go_back_in_time():
    with pytest.raises(InvalidInput, match="after"):
        play(World(), THROWS, aware(), after=-0.1)
