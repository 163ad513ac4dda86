"""What the thesis leaves open about the learner, chosen once (note E10), and what is changed."""

from dataclasses import dataclass, fields, replace

import numpy as np

from handeye.arrays import count, finite, scalar
from handeye.catching.comparator import Comparator
from handeye.catching.signals import SENSES
from handeye.errors import InvalidInput


@dataclass(frozen=True)
class Tuning:
    """How one network measures its inputs and outputs.

    input_scales, output_scales  one per row of its table, in the row's units: a difference of one
                                 scale counts as one
    threshold                    error, in output scales, from which it learns or adds a neuron
    half_max_fraction            h; 0.8 in the thesis
    replays                      times that all samples are learned anew, in random order; 0: each
                                 once, as it comes, as in the thesis

    Raises:
        InvalidInput: a scale or fraction that is not positive, or a negative number.
    """

    input_scales: tuple[float, ...]
    output_scales: tuple[float, ...]
    threshold: float
    half_max_fraction: float = 0.8
    replays: int = 0

    def __post_init__(self) -> None:
        for name in ("input_scales", "output_scales"):
            if not np.all(finite(getattr(self, name), name) > 0.0):
                raise InvalidInput(f"{name} must be positive, got {getattr(self, name)}")
        scalar(self.threshold, "threshold", least=0.0)
        scalar(self.half_max_fraction, "half_max_fraction", above=0.0)
        count(self.replays, "replays", least=0)


@dataclass(frozen=True)
class CatcherSettings:
    """Settings of a Learner. The defaults are those of THESIS, fields marked * are not in it.

    The tunings of the networks, in the order of tables 4.1 and 4.2:

    motor_command    velocities and times count a fifth of displacements, or they would decide alone
                     which neuron is near; catch_correction likewise
    ball_crossing    the vertical velocity, which says when the ball is down, counts most
    arm_state, ball_state  likewise what tells apart what the next tick brings
    arm_recognition  how far the arm moved counts most; the drive force, which is the same for both
                     arms, hardly
    ball_recognition vertical velocity, in which drag shows, is what changes most

    And what the thesis states no number for:

    ball_threshold         activity that a line of the ball recognition net needs: a right one
                           rises to 1. Balls are told apart at the sixth tick, with time to lose
    arm_threshold          the same of the arm recognition net: what is asked again at the next
                           tick need not be guessed
    ball_comparator        thresholds of dx, dz [m], vx, vz [m/s] over a tick: so that of 100 balls
                           taken for the other 99 are found out in six comparisons, and of 100 known
                           ones 5 surprise during the flight
    arm_comparator         of dx [m], v [m/s], force [N]: so that of 100 heavy arms taken for the
                           light one 97 are found out within ten ticks. That an arm surprises
                           without need costs little: it is not stopped
    reach                  an arm that stays so near its place has arrived there; half of the room
                           that a ball has in the cup [m]
    rest_speed             an arm that stays slower is at rest [m/s]
    least_amplitude        epsilon of the random pursuits [V]: with it the heavy arm has practised
                           ways of half a metre that take as long as a ball's flight
    arrive_early           how long before the ball the mentor wants the arm to be there [s]
    largest_correction     of target [m] and arrival [s], as `reach` and `arrive_early`: an arm that
                           cannot be earlier would be asked for ever more; 0, 0: the mentor's
                           advice is not taken
    perceptual_delay       ticks by which all senses are late
    repeated               a pursuit may follow a completed one (section 4.4.2)
    gentle *               amplitudes of random pursuits are uniform in their logarithm: most of
                           the uniform ones saturate the amplifier, so slow ways, which a throw
                           usually leaves time for, are hardly practised
    try_all *              while an identity is unknown, the state nets of all predict, and who
                           predicts clearly best is chosen before the recognition net's choice
    excitation *           at the start of a throw the arm is moved to and fro with this voltage, so
                           that it is seen which it is while the ball is still being watched [V]
    novelty_limits *       no pursuit begins unless the motor command net has a neuron nearer than
                           the first, in its input scales: the arm waits until what is left to do
                           resembles what it has practised, or as much as it will; and none goes
                           on beyond the second. None: it always acts
    lead *                 how long before the predicted crossing the arm is asked to be there [s]:
                           time to follow a better prediction with another pursuit
    profiles *             the networks trigger the profile generator of the pursuits instead of
                           emitting a voltage at each tick (conclusion 3 of 5.1.2); motor_command
                           then maps displacement and time to target and amplitude

    Raises:
        InvalidInput: a number out of range, or a tuning that does not fit its network's table.
    """

    arm_recognition: Tuning = Tuning((1.0, 1.0, 1.0, 1.0, 0.03, 0.15, 10.0, 10.0), (1.0,), 0.05)
    arm_state: Tuning = Tuning((1.0, 1.0), (0.1, 3.0, 10.0), 0.05)
    motor_command: Tuning = Tuning((5.0, 1.0, 5.0), (1.0,), 0.02)
    catch_correction: Tuning = Tuning((5.0, 1.0, 5.0), (1.0, 1.0), 0.05)
    ball_recognition: Tuning = Tuning((2.0, 4.0, 0.05, 0.1, 0.15, 0.3, 0.25, 0.5), (1.0,), 0.05)
    ball_state: Tuning = Tuning((8.0, 2.0, 0.4, 0.1), (0.05, 0.05, 2.0, 2.0), 0.02)
    ball_crossing: Tuning = Tuning((4.0, 0.5, 0.3, 0.3, 3.0), (1.0, 1.0, 1.0), 0.05)
    ball_threshold: float = 0.5
    arm_threshold: float = 0.9
    ball_comparator: Comparator = Comparator((0.016, 0.016, 0.32, 0.32))  # noqa: RUF009 (frozen)
    arm_comparator: Comparator = Comparator((0.006, 0.12, 0.6))  # noqa: RUF009
    reach: float = 0.05
    rest_speed: float = 0.02
    least_amplitude: float = 0.05
    arrive_early: float = 0.1
    largest_correction: tuple[float, float] = (0.05, 0.1)
    perceptual_delay: int = 0
    repeated: bool = False
    gentle: bool = False
    try_all: bool = False
    excitation: float = 0.0
    novelty_limits: tuple[float, float] | None = None
    lead: float = 0.0
    profiles: bool = False

    def __post_init__(self) -> None:
        for name in ("reach", "rest_speed", "ball_threshold", "arm_threshold"):
            scalar(getattr(self, name), name, above=0.0)
        for name in ("arrive_early", "excitation", "lead"):
            scalar(getattr(self, name), name, least=0.0)
        most = finite(self.largest_correction, "largest_correction")
        if most.shape != (2,) or np.any(most < 0.0):
            raise InvalidInput(f"largest_correction must be a distance and a time, got {most}")
        if self.novelty_limits is not None:
            begin, go_on = finite(self.novelty_limits, "novelty_limits")
            if not 0.0 < begin <= go_on:
                raise InvalidInput(f"novelty_limits must rise from above 0, got {(begin, go_on)}")
        if not 0.0 < scalar(self.least_amplitude, "least_amplitude") <= 1.0:
            raise InvalidInput(f"least_amplitude must be in (0, 1], got {self.least_amplitude}")
        count(self.perceptual_delay, "perceptual_delay", least=0)
        sizes = {**_SIZES, "motor_command": (2, 2)} if self.profiles else _SIZES
        for name, size in sizes.items():
            tuning: Tuning = getattr(self, name)
            if (len(tuning.input_scales), len(tuning.output_scales)) != size:
                raise InvalidInput(f"{name} needs {size[0]} input and {size[1]} output scales")

    @property
    def takes_advice(self) -> bool:
        """Whether a mentor has any effect."""
        return any(self.largest_correction)

    @property
    def delays(self) -> dict[str, int]:
        """Ticks by which each delayed stream of memory lags."""
        return dict.fromkeys((*SENSES, "voltage"), self.perceptual_delay)


_SIZES = {
    "arm_recognition": (8, 1),
    "arm_state": (2, 3),
    "motor_command": (3, 1),
    "catch_correction": (3, 2),
    "ball_recognition": (8, 1),
    "ball_state": (4, 4),
    "ball_crossing": (5, 3),
}
"""Inputs and outputs in tables 4.1 and 4.2; of a recognition net, one output for each identity."""

THESIS = CatcherSettings()
"""The learner of the thesis."""

IMPROVED = replace(
    THESIS,
    arm_state=Tuning((1.0, 4.0), (0.1, 4.0, 10.0), 0.005, 2.0, 2),
    motor_command=Tuning((6.0, 0.5, 0.5), (1.0,), 0.1, 2.0, 3),
    catch_correction=Tuning((4.0, 1.0, 1.0), (1.0, 1.0), 0.01),
    ball_recognition=Tuning((4.0, 4.0, 0.1, 0.1, 0.3, 0.3, 0.5, 0.5), (1.0,), 0.05, 2.0, 1),
    ball_state=Tuning((4.0, 4.0, 0.2, 0.2), (0.1, 0.1, 4.0, 4.0), 0.002, 3.0, 1),
    ball_crossing=Tuning((4.0, 4.0, 0.2, 0.2, 1.0), (1.0, 1.0, 1.0), 0.005, 3.0, 2),
    ball_comparator=Comparator((0.01, 0.01, 0.2, 0.2)),
    arm_comparator=Comparator((0.015, 0.3, 2.0)),
    arm_threshold=0.5,
    reach=0.03,
    least_amplitude=0.03,
    repeated=True,
    gentle=True,
    largest_correction=(0.0, 0.0),
    try_all=True,
    excitation=0.15,
)
"""Better than the thesis: samples are replayed in random order into wider neurons, so that they
generalise between trajectories instead of along them; practice is gentler; pursuits are repeated.
These buy the most (figure 6.6). Arms show at the start of a throw which they are, and unknown
identities are tried. The mentor's advice is not taken: an arm that follows every new prediction
until the ball comes needs none."""

SMOOTH = replace(
    IMPROVED,
    motor_command=Tuning((0.5, 0.5), (0.5, 0.3), 0.02, 2.0, 5),
    rest_speed=0.4,
    lead=0.5,
    profiles=True,
)
"""IMPROVED with networks that trigger the antisymmetric profile generator, early enough for
a second one: a profile that is to end with the ball follows the first, poorest prediction only."""

CHANGES = tuple(f.name for f in fields(CatcherSettings)
                if getattr(IMPROVED, f.name) != getattr(THESIS, f.name))  # fmt: skip
"""Fields in which IMPROVED differs: each can be switched on or off by itself."""
