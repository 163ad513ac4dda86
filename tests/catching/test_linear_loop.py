"""The loop of section 4.8 against its closed forms, and what Euler's method makes of it."""

import numpy as np
import pytest

from handeye.catching.arm import HEAVY_ARM, LIGHT_ARM
from handeye.catching.layout import Layout
from handeye.catching.linear_loop import track
from handeye.catching.pid import PIDController, linear_amplifier
from handeye.catching.play import play
from handeye.catching.throws import Throws, draw_throws
from handeye.catching.world import World

ARM = linear_amplifier(HEAVY_ARM)
LIGHT, HEAVY = 0, 1
DECAY = {LIGHT: 3.0166666666666666, HEAVY: 1.81e-4}  # 6 pi eta r / m


def throws_of(ball: int, speed: float, duration: np.ndarray | float, start: float = 0.0) -> Throws:
    """Balls that leave from above the arm, which stands `start` behind them, for so long."""
    t = np.atleast_1d(np.asarray(duration, float))
    k, one = DECAY[ball], np.ones_like(t)
    return Throws(
        ball=np.full(len(t), ball),
        arm=np.full(len(t), 1),
        arm_x=-start * one,
        x=0.0 * one,
        z=one,
        vx=speed * one,
        vz=one,
        crossing_time=t,
        crossing_x=speed / k * -np.expm1(-k * t),
        crossing_vx=speed * np.exp(-k * t),
    )


def lag(speed: float, k: float, slow: float, t: np.ndarray) -> np.ndarray:
    """Eq 4.13 for b(t) = (v / k)(1 - exp(-k t)): ball minus arm.

    e = v s / ((s + p)^2 (s + k)), p = 1 / lambda, in partial fractions.
    """
    p = 1.0 / slow
    return speed * (
        -k / (p - k) ** 2 * (np.exp(-k * t) - np.exp(-p * t)) + p / (p - k) * t * np.exp(-p * t)
    )


@pytest.mark.parametrize("slow", [0.6, 0.1, 0.018])
@pytest.mark.parametrize("motion", ["euler", "exact"])
def test_a_fast_clock_gives_the_error_of_eq_4_13(slow, motion) -> None:
    times = np.array([0.05, 0.2, 0.7, 1.1])
    for ball in (LIGHT, HEAVY):
        throws = throws_of(ball, 2.0, times)
        tracked = track(
            PIDController(ARM, slow, tick=5e-4), throws, ARM,
            motion=motion, layout=Layout(tick=5e-4),
        )  # fmt: skip
        expected = -lag(2.0, DECAY[ball], slow, times)
        np.testing.assert_allclose(tracked.position_error, expected, atol=1e-3)


def test_the_arm_is_never_ahead_of_a_ball_that_keeps_its_speed() -> None:
    """Section 4.8.3 says otherwise: "overshoot" of a ramp is not in eq 4.13 (note E13)."""
    t = np.linspace(0.0, 3.0, 301)
    for slow in (0.6, 0.1, 0.018):
        np.testing.assert_allclose(lag(1.0, 1e-9, slow, t), t * np.exp(-t / slow), atol=1e-6)
    # Nor does it lag a light ball at the end: with lambda 0.6 s it is ahead.
    assert lag(1.0, DECAY[LIGHT], 0.6, np.array([1.1]))[0] < 0.0


@pytest.mark.parametrize("motion", ["euler", "exact"])
@pytest.mark.parametrize("reference", ["ball", "crossing"])
@pytest.mark.parametrize("ball", [LIGHT, HEAVY])
def test_ramps_damped_motion_and_steps_are_tracked_without_error(motion, reference, ball) -> None:
    throws = throws_of(ball, 1.5, 12.0, start=0.4)
    controller = PIDController(ARM, 0.3, reference=reference, throws=throws)
    tracked = track(controller, throws, ARM, motion=motion)
    # Of the heavy ball: its speed changes by 2e-4 a second, lagged by lambda^2 times that.
    assert abs(tracked.position_error[0]) < 5e-5
    assert abs(tracked.arm_x[0, 0] - tracked.ball_x[0, 0]) == pytest.approx(0.4)


def test_without_the_integral_a_ramp_is_lagged_by_a_constant() -> None:
    """e = v / (kappa_p x speed per volt) = v lambda^2 / (2 lambda + tau)."""
    throws, tau, slow = throws_of(HEAVY, 1.5, 12.0), ARM.time_constant, 0.3
    tracked = track(PIDController(ARM, slow, integral=False), throws, ARM)
    speed = throws.crossing_vx[0]
    assert tracked.position_error[0] == pytest.approx(-speed * slow**2 / (2 * slow + tau), rel=1e-3)


@pytest.mark.parametrize(
    ("slow", "motion", "derivative", "stable"),
    [
        (0.018, "euler", "sensed", True),  # poles at 1 - 25 / 18
        (0.0126, "euler", "sensed", True),
        (0.0124, "euler", "sensed", False),  # beyond dt / 2
        (0.018, "euler", "differences", False),
        (0.018, "exact", "sensed", False),
        (0.1, "exact", "sensed", True),
    ],
)
def test_what_is_stable_at_40_hz(slow, motion, derivative, stable) -> None:
    throws = throws_of(LIGHT, 0.0, 25.0, start=0.3)
    tracked = track(PIDController(ARM, slow, derivative=derivative), throws, ARM, motion=motion)
    error = abs(tracked.position_error[0])
    assert error < 0.05 if stable else error > 10.0


def test_ten_steps_to_a_tick_would_be_stable() -> None:
    throws = throws_of(LIGHT, 0.0, 5.0, start=0.3)
    for motion in ("euler", "exact"):
        tracked = track(
            PIDController(ARM, 0.018, tick=0.0025), throws, ARM, motion=motion,
            layout=Layout(tick=0.0025),
        )  # fmt: skip
        assert abs(tracked.position_error[0]) < 1e-5


def test_exact_motion_with_stops_is_that_of_the_world() -> None:
    arms = (linear_amplifier(LIGHT_ARM), ARM)
    throws = draw_throws(60, np.random.default_rng(1), arms=(1,))
    recording = play(World(arms=arms, collisions=False), throws, PIDController(ARM, 0.2))
    tracked = track(PIDController(ARM, 0.2), throws, ARM, motion="exact", stops=True)
    # In the world the arm stops at the very moment, here at the next tick.
    free = (np.nan_to_num(tracked.arm_x, nan=1.0) > 0.5).all(axis=0)
    assert 10 < free.sum() < 60
    np.testing.assert_allclose(
        tracked.position_error[free], recording.position_error[free], atol=1e-9
    )
    np.testing.assert_allclose(tracked.position_error, recording.position_error, atol=0.06)
    n = min(len(tracked.time), len(recording.sensed.time))
    np.testing.assert_allclose(
        tracked.ball_x[:n, free], recording.sensed.ball_x[:n, free], atol=1e-9
    )


def test_the_arm_stops_dead_at_the_ends_of_its_travel() -> None:
    throws = throws_of(HEAVY, 0.0, 1.0, start=-1.0)
    felt: list[tuple[float, float]] = []

    class Pusher:
        """Pushes left for half a second, then right."""

        def begin(self, n):
            assert n == 1

        def act(self, sensed):
            felt.append((sensed.arm_x[0], sensed.arm_v[0]))
            return np.where(sensed.time < 0.5, -0.2, 0.2)

        def traces(self):
            return {}

    tracked = track(Pusher(), throws, HEAVY_ARM, stops=True)
    low = Layout().arm_travel[0]
    at_stop = [v for x, v in felt if x == low]
    assert len(at_stop) > 3
    # Euler's method moves the arm one tick after its velocity.
    assert at_stop[:-1] == [0.0] * (len(at_stop) - 1)
    assert at_stop[-1] > 0.0
    assert np.nanmin(tracked.arm_x) == low
    assert tracked.arm_x[-1, 0] > low + 0.2


def test_caught_is_a_whole_ball_between_the_walls() -> None:
    throws = throws_of(HEAVY, 0.0, np.full(4, 0.5))
    inside = throws_of(HEAVY, 0.0, np.full(4, 0.5)).arm_x + np.array([0.0, 0.0699, -0.0699, 0.0701])
    placed = Throws(**{**vars(throws), "arm_x": inside})

    class Still:
        def begin(self, n):
            assert n == 4

        def act(self, sensed):
            return 0.0 * sensed.time

        def traces(self):
            return {}

    assert track(Still(), placed, ARM).caught().tolist() == [True, True, True, False]


def test_no_throws_are_no_trouble() -> None:
    tracked = track(PIDController(ARM, 0.2), throws_of(HEAVY, 1.0, np.empty(0)), ARM)
    assert tracked.position_error.shape == (0,)
    assert tracked.time.shape[1] == 0
