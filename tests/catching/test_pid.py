from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from handeye.catching.arm import HEAVY_ARM, LIGHT_ARM, Arm
from handeye.catching.pid import Gains, PIDController, linear_amplifier
from handeye.catching.play import play
from handeye.catching.throws import draw_throws
from handeye.catching.world import Sensed, World
from handeye.errors import InvalidInput

ARMS = pytest.mark.parametrize("arm", [LIGHT_ARM, HEAVY_ARM], ids=["light", "heavy"])
TICK = 1.0 / 40.0
LINEAR_WORLD = World(arms=(linear_amplifier(LIGHT_ARM), linear_amplifier(HEAVY_ARM)))


def sensed(n: int, *, active: bool = True, **fields: float) -> Sensed:
    known = {name: np.full(n, fields.get(name, 0.0)) for name in Sensed._fields if name != "active"}
    return Sensed(**known, active=np.full(n, active))


class Observer:
    """Believes what it is told to believe."""

    def __init__(self, ball: list[float], crossing_x: list[float]) -> None:
        self.says = {"ball": np.array(ball), "crossing_x": np.array(crossing_x)}
        self.begun, self.shown = 0, 0

    def begin(self, n: int) -> None:
        self.begun = n

    def act(self, sensed: Sensed) -> np.ndarray:
        self.shown += 1
        return np.full(len(sensed.arm_x), 99.0)

    def traces(self) -> dict[str, np.ndarray]:
        return self.says


@ARMS
@given(slow=st.floats(1e-3, 10.0))
def test_gains_equal_equations_4_8_to_4_10(arm: Arm, slow: float) -> None:
    tau = 1.0 / (
        arm.damping / arm.mass
        + arm.torque_constant**2 / (arm.wheel**2 * arm.resistance * arm.mass)
    )  # fmt: skip
    gains = Gains.imc(arm, slow)
    kappa = (2 * slow + tau) / slow**2 * (
        arm.wheel * arm.resistance * arm.mass / (arm.torque_constant * tau)
    )  # fmt: skip
    assert gains.proportional == pytest.approx(kappa, rel=1e-12)
    assert gains.integral_time == pytest.approx(2 * slow + tau, rel=1e-12)
    assert gains.derivative_time == pytest.approx(2 * slow * tau / (2 * slow + tau), rel=1e-12)


@ARMS
@given(slow=st.floats(0.01, 2.0), frequency=st.floats(0.1, 100.0))
def test_the_loop_is_that_of_equations_4_11_and_4_12(
    arm: Arm, slow: float, frequency: float
) -> None:
    s, tau = 1j * frequency, arm.time_constant
    gains = Gains.imc(arm, slow)
    controller = gains.proportional * (
        1.0 + gains.derivative_time * s + 1.0 / (gains.integral_time * s)
    )
    plant = arm.force_per_volt * tau / arm.mass / (s * (tau * s + 1.0))
    loop = controller * plant
    inner = 2 * slow + tau + 2 * slow * tau * s + 1 / s
    closed = inner / (slow**2 * (s * (tau * s + 1)) + inner)
    assert loop / (1.0 + loop) == pytest.approx(closed, rel=1e-9)
    # The controller's zero at -1 / tau cancels the arm's pole: what is left knows lambda only.
    assert closed == pytest.approx((2 * slow * s + 1) / (slow * s + 1) ** 2, rel=1e-9)


@pytest.mark.parametrize("arm", [HEAVY_ARM, linear_amplifier(HEAVY_ARM)], ids=["tanh", "linear"])
def test_commands_are_eulers_pid_over_the_amplifiers_gain(arm: Arm) -> None:
    controller = PIDController(arm, 0.2)
    gains = Gains.imc(arm, 0.2)
    controller.begin(1)
    first = controller.act(sensed(1, ball_x=0.3, ball_vx=2.0, arm_x=0.1, arm_v=0.5))
    second = controller.act(sensed(1, ball_x=0.35, ball_vx=1.0, arm_x=0.12, arm_v=0.7))
    volts = gains.proportional * (0.2 + gains.derivative_time * 1.5)
    assert first == pytest.approx(volts / 80.0, rel=1e-9)
    summed = 0.2 * TICK
    volts = gains.proportional * (
        0.23 + gains.derivative_time * 0.3 + summed / gains.integral_time
    )  # fmt: skip
    assert second == pytest.approx(volts / 80.0, rel=1e-9)
    assert controller.traces()["reference"] == pytest.approx(0.35)


def test_begin_empties_the_integral() -> None:
    controller = PIDController(HEAVY_ARM, 0.2)
    controller.begin(1)
    now = sensed(1, ball_x=0.3)
    first = controller.act(now)
    assert controller.act(now) > first
    controller.begin(1)
    assert controller.act(now) == first


def test_terms_can_be_left_out_or_taken_from_differences() -> None:
    gains = Gains.imc(HEAVY_ARM, 0.2)
    seen = [
        sensed(1, ball_x=0.3, ball_vx=2.0, arm_v=0.5),
        sensed(1, ball_x=0.4, ball_vx=2.0, arm_v=0.5),
    ]

    def commands(**options) -> list[float]:
        controller = PIDController(HEAVY_ARM, 0.2, **options)
        controller.begin(1)
        return [float(controller.act(each)[0]) * 80.0 / gains.proportional for each in seen]

    lead = gains.derivative_time
    assert commands(derivative="none", integral=False) == pytest.approx([0.3, 0.4])
    assert commands(derivative="sensed", integral=False) == pytest.approx(
        [0.3 + lead * 1.5, 0.4 + lead * 1.5]
    )
    # The first difference is unknown: no kick.
    assert commands(derivative="differences", integral=False) == pytest.approx(
        [0.3, 0.4 + lead * 0.1 / TICK]
    )


@given(volts=st.floats(-100.0, 100.0))
def test_linear_amplifier_is_linear(volts: float) -> None:
    arm = linear_amplifier(HEAVY_ARM)
    given_volts = arm.motor_voltage(np.array(volts / 80.0))
    assert given_volts == pytest.approx(volts, rel=1e-11, abs=1e-12)
    assert arm.time_constant == HEAVY_ARM.time_constant


def test_crossing_mode_goes_to_where_the_ball_will_come_down() -> None:
    throws = draw_throws(40, np.random.default_rng(0), arms=(1,))
    controller = PIDController(HEAVY_ARM, 0.1, reference="crossing", throws=throws)
    recording = play(LINEAR_WORLD, throws, controller)
    np.testing.assert_array_equal(recording.traces["reference"][0], throws.crossing_x)
    assert np.abs(recording.position_error).max() < 0.1
    # (2 lambda s + 1) / (lambda s + 1)^2 has settled to a few per cent after 1.1 s.
    assert np.all(
        np.abs(recording.position_error) < 0.09 * np.abs(throws.crossing_x - throws.arm_x) + 1e-9
    )


def test_gain_scheduling_gives_each_ball_its_own_lambda() -> None:
    throws = draw_throws(40, np.random.default_rng(0), arms=(1,))
    scheduled = play(LINEAR_WORLD, throws, PIDController(HEAVY_ARM, (0.3, 0.15), throws=throws))
    for ball, slow in enumerate((0.3, 0.15)):
        mine = throws.ball == ball
        alone = play(LINEAR_WORLD, throws[mine], PIDController(HEAVY_ARM, slow))
        np.testing.assert_array_equal(scheduled.position_error[mine], alone.position_error)


def test_an_observer_says_which_ball_it_is_and_is_not_obeyed() -> None:
    observer = Observer(ball=[1.0, 0.0, -1.0], crossing_x=[np.nan] * 3)
    controller = PIDController(HEAVY_ARM, (0.1, 0.4), observer=observer, integral=False)
    controller.begin(3)
    commands = controller.act(sensed(3, ball_x=0.3)) * 80.0
    fast, slow = (0.3 * Gains.imc(HEAVY_ARM, each).proportional for each in (0.1, 0.4))
    # While nobody knows the ball, the gentlest gains.
    assert commands == pytest.approx([slow, fast, slow])
    assert (observer.begun, observer.shown) == (3, 1)
    assert set(controller.traces()) == {"ball", "crossing_x", "reference"}


def test_the_arm_is_braked_while_the_crossing_is_unknown() -> None:
    observer = Observer(ball=[0.0, 0.0], crossing_x=[np.nan, 1.5])
    controller = PIDController(HEAVY_ARM, 0.2, reference="crossing", observer=observer)
    controller.begin(2)
    commands = controller.act(sensed(2, arm_x=1.0, arm_v=0.5)) * 80.0
    gains = Gains.imc(HEAVY_ARM, 0.2)
    damping = -0.5 * gains.derivative_time
    assert commands == pytest.approx(
        [gains.proportional * damping, gains.proportional * (0.5 + damping)]
    )
    observer.says["crossing_x"] = np.array([1.5, 1.5])
    after = controller.act(sensed(2, arm_x=1.5))
    # The integral of the first begins when it knows where to go.
    assert after * 80.0 == pytest.approx(
        [0.0, gains.proportional * 0.5 * TICK / gains.integral_time]
    )


def test_throws_that_are_over_are_left_alone() -> None:
    controller = PIDController(HEAVY_ARM, 0.2)
    controller.begin(1)
    assert controller.act(sensed(1, active=False, ball_x=np.nan, arm_v=0.3)) == 0.0


@pytest.mark.parametrize("slow", [0.0, -0.1, np.nan])
def test_lambda_must_be_positive(slow: float) -> None:
    with pytest.raises(InvalidInput, match="closed_loop"):
        PIDController(HEAVY_ARM, slow)


def test_somebody_must_know() -> None:
    throws = draw_throws(2, np.random.default_rng(0))
    for needed in ({"reference": "crossing"}, {"closed_loop": (0.1, 0.2)}):
        with pytest.raises(InvalidInput, match="must say which ball"):
            PIDController(HEAVY_ARM, **{"closed_loop": 0.1, **needed})
    with pytest.raises(InvalidInput, match="not both"):
        PIDController(HEAVY_ARM, 0.1, throws=throws, observer=Observer([0.0], [0.0]))
    with pytest.raises(InvalidInput, match="one lambda for each"):
        PIDController(HEAVY_ARM, (0.1, 0.2, 0.3), throws=replace(throws, ball=throws.ball + 7))
    with pytest.raises(InvalidInput, match="told of 2 throws"):
        PIDController(HEAVY_ARM, 0.1, throws=throws).begin(3)
