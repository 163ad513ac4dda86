"""A robot that learns to catch: arm learning, ball learning and catch training (section 4.4.2)."""

from collections.abc import Mapping
from os import PathLike

import numpy as np

from handeye.arrays import Array, Integers, count
from handeye.catching import storage
from handeye.catching.catcher import Catcher
from handeye.catching.mentor import advise, arrival
from handeye.catching.movements import Movements
from handeye.catching.play import Recording
from handeye.catching.recognition import UNKNOWN
from handeye.catching.repertoire import Repertoire
from handeye.catching.settings import THESIS, CatcherSettings
from handeye.catching.signals import ARM_RECOGNITION, SENSES
from handeye.catching.skills import Skill, samples
from handeye.errors import InvalidInput


class Learner:
    """Learns from movements of its own arm, tosses that it watches, and a mentor's advice.

    It starts with nothing: no model of arms or balls, no controller, no program for catching. What
    it is told is which arm or ball it practises with, and afterwards what it could see.

    Args:
        settings: THESIS, IMPROVED, SMOOTH or your own.
        n_balls, n_arms: identities there can be.
    """

    def __init__(
        self, settings: CatcherSettings = THESIS, *, n_balls: int = 2, n_arms: int = 2
    ) -> None:
        self.settings = settings
        self.n_balls = count(n_balls, "n_balls")
        self.n_arms = count(n_arms, "n_arms")
        self.repertoire = Repertoire.empty(settings, n_balls, n_arms)
        self.pursuits = [0] * n_arms
        """Movements learned from so far with each arm."""
        self.tosses = [0] * n_balls
        """Tosses of each ball learned from so far."""
        self.mentored = 0
        """Throws so far on which the mentor gave advice."""

    @property
    def neurons(self) -> dict[str, int]:
        """Neurons allocated by each network, by its name, such as "motors.1"."""
        return {name: skill.network.n_neurons for name, skill in self.repertoire.skills()}

    def learn_arm(self, identity: int, movements: Movements) -> None:
        """Learn from pursuit movements with an arm: to command, to predict and to recognise it.

        Movements that ran into the end of the travel teach nothing.

        Raises:
            InvalidInput: no such arm; nothing has been learned.
        """
        self._check(identity, self.n_arms, "arm")
        free = movements[~movements.hit_stop]
        sensed = ("time", "arm_x", "arm_v", "arm_force", "voltage", "stop_x", "stop_time")
        streams: dict[str, Array] = {name: getattr(free, name) for name in sensed}
        streams["command"] = streams["voltage"]
        streams["profile_x"], streams["profile_amplitude"] = _profiles(streams)
        own = self.repertoire
        self._practise(own.motors[identity], streams)
        streams = _from_rest(streams)
        self._practise(own.arm_states[identity], streams)
        own.arm_recogniser.learn(identity, streams, self.settings.delays)
        self.pursuits[identity] += len(movements)

    def learn_ball(self, identity: int, tosses: Recording) -> None:
        """Learn from tosses that crossed undisturbed: to predict a ball and to recognise it.

        Raises:
            InvalidInput: no such ball; nothing has been learned.
        """
        self._check(identity, self.n_balls, "ball")
        final = tosses.final
        streams = {
            **_sensed(tosses),
            "crossing_x": final.ball_x,
            "crossing_time": final.time,
            "crossing_vx": final.ball_vx,
        }
        own = self.repertoire
        self._practise(own.ball_states[identity], streams)
        self._practise(own.crossings[identity], streams)
        own.ball_recogniser.learn(identity, streams, self.settings.delays)
        self.tosses[identity] += len(tosses)

    def learn_catch(self, recording: Recording) -> None:
        """Let the mentor say what would have been better, and learn it (eq 4.5, 4.6).

        The adjustment is added to the corrections that were generated at each tick. A throw in
        which no arm was recognised, or a deflected ball had not been, teaches nothing.

        Args:
            recording: of throws played by this learner's catcher.
        """
        streams = _coached(recording, self.settings)
        arm = last_known(recording.traces["arm"])
        for identity, skill in enumerate(self.repertoire.corrections):
            of_arm = np.flatnonzero(arm == identity)
            if of_arm.size:
                self._practise(skill, {name: v[..., of_arm] for name, v in streams.items()})
        self.mentored += len(recording)

    def catcher(
        self,
        arm: int | Integers | None = None,
        ball: int | Integers | None = None,
        *,
        repeated: bool | None = None,
    ) -> Catcher:
        """A controller that catches with what has been learned so far.

        Args:
            arm: identities believed at the start, one for all throws or (N,); None: unknown.
            ball: the same of balls.
            repeated: pursuits may follow each other; None: as the settings say.

        Raises:
            InvalidInput: no such arm or ball.
        """
        arms = self._believed(arm, self.n_arms, "arm")
        balls = self._believed(ball, self.n_balls, "ball")
        again = self.settings.repeated if repeated is None else repeated
        return Catcher(self.repertoire, self.settings, arms, balls, repeated=again)

    def save(self, path: str | PathLike[str]) -> None:
        """Write everything to one safetensors file; one that is loaded goes on as this one would.

        An old file is replaced only once the new one is complete.
        """
        storage.save(self, path)

    @staticmethod
    def load(path: str | PathLike[str]) -> "Learner":
        """The learner that `save` wrote.

        Raises:
            FileFormatError: no such file, damaged, foreign, or from a newer version.
        """
        return storage.load(path)

    def _practise(self, skill: Skill, streams: Mapping[str, Array]) -> None:
        skill.practise(*samples(skill.table, streams, self.settings.delays))

    @staticmethod
    def _check(identity: int, number: int, thing: str) -> None:
        if not 0 <= count(identity, thing, least=0) < number:
            raise InvalidInput(f"there are {number} identities of the {thing}, got {identity}")

    @staticmethod
    def _believed(identity: int | Integers | None, number: int, thing: str) -> Integers:
        believed = np.asarray(UNKNOWN if identity is None else identity)
        if believed.dtype.kind not in "iu" or np.any((believed < UNKNOWN) | (believed >= number)):
            raise InvalidInput(
                f"{thing} must be identities from -1 to {number - 1}, got {identity}"
            )
        return believed.astype(np.int64)


def last_known(identities: Array) -> Integers:
    """The latest identity of each trial that was not UNKNOWN, from traces (T, N)."""
    known = np.nan_to_num(identities, nan=UNKNOWN).astype(np.int64)
    ticks = np.arange(len(known))[:, np.newaxis]
    last = np.where(known != UNKNOWN, ticks, 0).max(axis=0)
    return known[last, np.arange(known.shape[1])]


def _from_rest(streams: Mapping[str, Array]) -> dict[str, Array]:
    """What the arm's streams (T, N) held since before each movement: it had been left alone."""
    rest = {"arm_x": streams["arm_x"][:1], "arm_v": 0.0, "arm_force": 0.0, "voltage": 0.0}
    earlier = (ARM_RECOGNITION.reach, streams["arm_x"].shape[1])
    return {
        name: np.vstack([np.broadcast_to(value, earlier), streams[name]])
        for name, value in rest.items()
    }


def _profiles(streams: Mapping[str, Array]) -> tuple[Array, Array]:
    """Targets [m] and amplitudes [V] of pursuits, (T, N): at their first tick, else NaN.

    The drive is reversed past the midpoint of start and target, so the target lies as far beyond
    the reversal as that beyond the start; the reversal is taken halfway between the ticks around.
    """
    x, voltage = streams["arm_x"], streams["voltage"]
    target, amplitude = np.full((2, *x.shape), np.nan)
    if x.size:
        trials = np.arange(len(x[0]))
        reversed_at = (voltage * voltage[0] < 0.0).argmax(axis=0)
        middle = 0.5 * (x[reversed_at, trials] + x[np.maximum(reversed_at - 1, 0), trials])
        target[0] = np.where(reversed_at > 0, 2.0 * middle - x[0], np.nan)
        amplitude[0] = np.abs(voltage[0])
    return target, amplitude


def _sensed(recording: Recording) -> dict[str, Array]:
    return {name: np.asarray(getattr(recording.sensed, name)) for name in SENSES}


def _coached(recording: Recording, settings: CatcherSettings) -> dict[str, Array]:
    """Streams in which the corrections are those that the mentor would have liked."""
    traces, final = recording.traces, recording.final
    sensed = _sensed(recording)
    stop_x, stop_time = arrival(
        sensed["time"], sensed["arm_x"], final.time, final.arm_x, settings.reach
    )
    crossing_x, crossing_time = _crossing(recording, sensed["time"])
    advice = advise(crossing_x, crossing_time, stop_x, stop_time, settings.arrive_early)
    most_x, most_t = settings.largest_correction
    return {
        **sensed,
        "crossing_x": crossing_x,
        "crossing_time": crossing_time,
        "correction_x": _within(most_x, traces["correction_x"] + advice.delta_x),
        "correction_time": _within(most_t, traces["correction_time"] + advice.delta_t),
    }


def _within(most: float, values: Array) -> Array:
    return np.clip(values, -most, most)


def _crossing(recording: Recording, time: Array) -> tuple[Array, Array]:
    """Where and when the balls crossed, or what was predicted just before the arm touched them."""
    trials = np.arange(recording.contact_time.size)
    touched = np.isfinite(recording.contact_time)
    before = time < recording.contact_time
    last = np.where(before, np.arange(len(time))[:, np.newaxis], 0).max(axis=0)
    predicted = (recording.traces[name][last, trials] for name in ("crossing_x", "crossing_time"))
    observed = (recording.final.ball_x, recording.final.time)
    x, t = (np.where(touched, p, o) for p, o in zip(predicted, observed, strict=True))
    return x, t
