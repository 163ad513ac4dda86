"""The thesis's tests of catching, against slow and obvious counts."""

from dataclasses import replace

import numpy as np
import pytest

from handeye.catching.layout import Layout
from handeye.catching.play import Recording, play
from handeye.catching.throws import draw_throws
from handeye.catching.world import Sensed, World
from handeye.randomness import stream
from handeye.thesis.catching import HEAVY, LIGHT, NEAR, School, arrived, over, summary, throws_for
from handeye.thesis.experiment import FULL, Curve, Effort
from handeye.thesis.experiments.catch_pid import LOST, Tracked, tracking
from handeye.thesis.watching import FRACTIONS, TICKS, Still, foresight, noticed, over_the_flight

TICK = Layout().tick


class Nudge:
    """Commands `volts` for the first `ticks` ticks, then none."""

    def __init__(self, volts: float, ticks: int) -> None:
        self.volts, self.ticks = volts, ticks

    def begin(self, n: int) -> None:
        self.tick, self.n = 0, n

    def act(self, sensed: Sensed) -> np.ndarray:  # noqa: ARG002
        self.tick += 1
        return np.full(self.n, self.volts if self.tick <= self.ticks else 0.0)

    def traces(self) -> dict[str, np.ndarray]:
        return {}


@pytest.fixture(scope="module")
def recording() -> Recording:
    throws = draw_throws(30, stream("test: catching"), arms=(LIGHT,))
    near = np.where(np.arange(30) % 2 == 0, throws.crossing_x - 0.02, throws.arm_x)
    return play(World(), replace(throws, arm_x=near), Nudge(0.02, 3))


def test_a_summary_counts_the_sequence_and_the_fresh_throws_apart(recording: Recording):
    found = summary(recording, 10)
    for suffix, part in (("_20", range(10)), ("", range(10, 30))):
        errors = [recording.position_error[i] for i in part]
        assert found[f"caught{suffix}"] == sum(recording.caught[i] for i in part) / len(part)
        assert found[f"mean{suffix}"] == pytest.approx(sum(errors) / len(part))
        squares = sum(error**2 for error in errors) / len(part)
        assert found[f"rms{suffix}"] == pytest.approx(squares**0.5)
    assert 0.0 < found["caught"] < 1.0


def test_roughness_is_the_mean_change_of_voltage_while_a_throw_lasts(recording: Recording):
    one = recording[:1]
    ticks = int(np.isfinite(one.voltage[:, 0]).sum())
    found = summary(one[[0, 0]], 1)
    assert found["roughness"] == pytest.approx(0.02 / (ticks - 1))


def test_an_arm_arrives_when_it_stays_near_from_then_on(recording: Recording):
    away = np.abs(recording.sensed.arm_x - recording.final.arm_x) > NEAR
    for throw, time in enumerate(arrived(recording)):
        after = recording.sensed.time[:, throw] >= time
        assert not np.any(away[after, throw])
        before = recording.sensed.time[:, throw] < time
        assert not before.any() or away[before, throw][-1]


def test_throws_differ_in_nothing_but_ball_and_arm():
    light, heavy = (throws_for(ball, HEAVY, 3, Effort(0.1)) for ball in (LIGHT, HEAVY))
    assert light.sequence == 2
    assert len(light.throws) == 22
    np.testing.assert_array_equal(light.throws.crossing_x, heavy.throws.crossing_x)
    np.testing.assert_array_equal(light.throws.arm_x, heavy.throws.arm_x)
    assert not np.array_equal(light.throws.vx, heavy.throws.vx)
    other = throws_for(LIGHT, HEAVY, 4, Effort(0.1)).throws
    assert not np.array_equal(other.crossing_x, light.throws.crossing_x)


def test_stages_grow_in_any_run():
    assert School().stages(FULL) == {10: 10, 100: 100, 500: 500, 1000: 1000}
    for effort in (1e-4, 0.01, 0.02, 0.3):
        made = list(School().stages(Effort(effort)).values())
        assert made == sorted(set(made))


def test_means_over_named_quantities():
    assert over({"a": 1.0, "b": 3.0, "c": 9.0}, ("a", "b")) == 2.0


def test_events_are_noticed_by_counting_ticks():
    time = np.tile(TICK * np.arange(40.0)[:, np.newaxis], (1, 4))
    event = np.array([0.1001, 0.1001, 0.1001, 0.1001])
    alarm = np.zeros((40, 4), np.bool_)
    alarm[5, 0] = alarm[12, 0] = True  # the first tick after the event, and again
    alarm[14, 1] = True  # the tenth
    alarm[2, 2] = True  # before it
    shares = noticed(time, event, alarm)
    expected = [0.25 if ticks < 10 else 0.5 for ticks in TICKS]
    np.testing.assert_array_equal(shares, expected)
    np.testing.assert_array_equal(noticed(time[:, :0], event[:0], alarm[:, :0]), 0.0)


def test_errors_over_the_flight_are_read_at_the_tick_before(recording: Recording):
    time, crossing = recording.sensed.time, recording.throws.crossing_time
    errors = np.where(np.isnan(time), np.nan, np.arange(len(time))[:, np.newaxis])
    found = over_the_flight(recording, errors)
    for fraction, value in zip(FRACTIONS, found, strict=True):
        ticks = [max(k for k in range(len(time)) if time[k, i] < fraction * crossing[i])
                 for i in range(len(crossing))]  # fmt: skip
        assert value == pytest.approx(np.sqrt(np.mean(np.square(ticks))))


def test_who_predicts_nothing_says_here_and_now(recording: Recording):
    silent = np.full(recording.sensed.time.shape, np.nan)
    told = np.tile(recording.throws.crossing_x + 0.25, (len(silent), 1))
    told[:3] = np.nan
    traces = {"crossing_x": told, "crossing_time": np.where(np.isnan(told), np.nan, 1.5)}
    place, time = foresight(recording, traces)
    np.testing.assert_allclose(place[3:], 0.25)
    np.testing.assert_allclose(time[3], 1.5 - recording.throws.crossing_time)
    np.testing.assert_allclose(place[0], recording.throws.x - recording.throws.crossing_x)
    np.testing.assert_allclose(time[2], 2 * TICK - recording.throws.crossing_time)


def test_still_arms_stay():
    throws = draw_throws(3, stream("test: still"))
    played = play(World(), throws, Still())
    np.testing.assert_array_equal(played.final.arm_x, throws.arm_x)


def test_a_controller_under_euler_steps_goes_where_the_ball_comes_down():
    found = tracking(Tracked("crossing", 0.1, exact=False), 100, Effort(0.2))
    assert found["caught"] == pytest.approx(over(found, ("light_caught", "heavy_caught")))
    assert float(str(found["light_rms"])) < 0.1
    wild = tracking(Tracked("crossing", 0.01, exact=False), 100, Effort(0.2))
    assert float(str(wild["light_rms"])) <= LOST


def test_curves_of_the_smoke_run_have_a_point_for_every_stage(smoke_run):
    at, values = smoke_run.records.curve("catching/thesis/pursuits_caught_20")
    assert list(at) == list(School().stages(Effort(0.02)).values())
    assert values.shape == (2, 4)
    assert isinstance(Curve(at, values[0]), Curve)
