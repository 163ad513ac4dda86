"""What a learner makes of what it sees and feels: predictions, identities, surprise (4.3, 4.5)."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from handeye.arrays import Array, Booleans, Integers
from handeye.catching.learner import Learner, last_known
from handeye.catching.play import Controller, Recording, play
from handeye.catching.world import Sensed, World
from handeye.randomness import stream
from handeye.thesis.catching import AFTERWARDS, BALLS, HEAVY, LIGHT, ThrowSet, over, throws_for
from handeye.thesis.experiment import Curve, Effort, Quantities

FRACTIONS: Array = np.linspace(0.1, 1.0, 19)
"""Moments of a flight, as parts of it."""
TICKS: Integers = np.arange(1, 21)
"""Clock ticks after an event within which it may be noticed."""

SHORTLY = 0.1
"""How long predictions are followed after the bounce [s]."""


class Still:
    """A controller that lets the arm be."""

    def __init__(self) -> None:
        self._n = 0

    def begin(self, n: int) -> None:
        """Expect n throws."""
        self._n = n

    def act(self, sensed: Sensed) -> Array:  # noqa: ARG002 (whatever happens)
        """No voltage."""
        return np.zeros(self._n)

    def traces(self) -> dict[str, Array]:
        """Thinks nothing."""
        return {}


def thoughts(controller: Controller, recording: Recording) -> dict[str, Array]:
    """What a controller would have thought at each tick of a recording, name -> (T, N).

    It sees all that was recorded, also after the end of a trial, and its commands go nowhere.
    """
    ticks, n = recording.sensed.time.shape
    controller.begin(n)
    kept: list[dict[str, Array]] = []
    for tick in range(ticks):
        now = Sensed(*(np.asarray(part)[tick] for part in recording.sensed))
        controller.act(now._replace(active=np.isfinite(now.time)))
        kept.append({name: trace.copy() for name, trace in controller.traces().items()})
    return {name: np.array([thought[name] for thought in kept]) for name in kept[0]}


def flights(learner: Learner, replicate: int, effort: Effort) -> Quantities:
    """What is made of both balls while the arm is out of the way.

    <ball>_place_error, <ball>_time_error
                        rms errors of the predicted crossing over FRACTIONS of the flight
    <ball>_recognised   share of flights in which an unknown ball is recognised before it crosses
    <ball>_recognition_time
                        until it is first taken for what it is, on average; the whole flight where
                        it never is [s]
    <ball>_flight_place, <ball>_flight_time
                        in the first replicate, the errors during one flight, until one bounce later
    bounce_noticed      share of bounces that surprise within each of TICKS, over both balls
    false_alarms        share of flights of a known ball with surprise before the bounce
    """
    world = World(collisions=False)
    measured: dict[str, float | Curve] = {}
    bounces: list[Array] = []
    alarms: list[float] = []
    for name, ball in BALLS.items():
        tests = throws_for(ball, HEAVY, replicate, effort)
        seen = play(world, tests.throws, Still(), after=AFTERWARDS)
        crossing = tests.throws.crossing_time
        known = thoughts(learner.catcher(ball=ball), seen)
        place, time = foresight(seen, known)
        measured[f"{name}_place_error"] = Curve(FRACTIONS, over_the_flight(seen, place))
        measured[f"{name}_time_error"] = Curve(FRACTIONS, over_the_flight(seen, time))
        if replicate == 0:
            measured |= _one_flight(name, seen, known, place, time)
        bounces.append(noticed(seen.sensed.time, crossing, known["ball_surprise"] >= 1.0))
        flying = seen.sensed.time < crossing
        early: Booleans = np.any(flying & (known["ball_surprise"] >= 1.0), axis=0)
        alarms.append(float(early.mean()))
        named = np.where(flying, thoughts(learner.catcher(), seen)["ball"], np.nan)
        measured |= _recognised(name, ball, named, tests, seen)
    return {
        **measured,
        "recognised_20": over(measured, [f"{name}_recognised_20" for name in BALLS]),
        "bounce_noticed": Curve(TICKS.astype(float), np.mean(bounces, axis=0)),
        "false_alarms": float(np.mean(alarms)),
    }


def _one_flight(
    name: str, seen: Recording, known: Mapping[str, Array], place: Array, time: Array
) -> dict[str, Curve]:
    """Errors over time [s] in the first flight, wherever something is predicted."""
    clock = seen.sensed.time[:, 0]
    told = ~np.isnan(known["crossing_x"][:, 0]) & (clock < seen.throws.crossing_time[0] + SHORTLY)
    return {
        f"{name}_flight_{what}": Curve(clock[told], errors[told, 0])
        for what, errors in (("place", place), ("time", time))
    }


def _recognised(
    name: str, ball: int, named: Array, tests: ThrowSet, seen: Recording
) -> dict[str, float]:
    right: Booleans = last_known(named) == ball
    first = np.where(named == ball, seen.sensed.time, np.inf).min(axis=0)
    return {
        f"{name}_recognised_20": float(right[: tests.sequence].mean()),
        f"{name}_recognised": float(right[tests.sequence :].mean()),
        f"{name}_recognition_time": float(np.mean(np.minimum(first, tests.throws.crossing_time))),
    }


def foresight(recording: Recording, traces: Mapping[str, Array]) -> tuple[Array, Array]:
    """Errors (T, N) of the crossing's predicted place [m] and time [s], predicted less actual.

    Who predicts nothing might as well say "here and now": its error is that of the ball's place
    and of the time.
    """
    throws, sensed = recording.throws, recording.sensed
    silent = np.isnan(traces["crossing_x"])
    place = np.where(silent, sensed.ball_x, traces["crossing_x"])
    time = np.where(silent, sensed.time, traces["crossing_time"])
    return place - throws.crossing_x, time - throws.crossing_time


def over_the_flight(recording: Recording, errors: Array) -> Array:
    """Rms over N flights of errors (T, N), at the last tick before each of FRACTIONS."""
    times, crossing = recording.sensed.time, recording.throws.crossing_time
    flight = np.arange(len(crossing))
    ticks = [(times < f * crossing).sum(axis=0) - 1 for f in FRACTIONS]
    return np.array([np.sqrt(np.mean(errors[tick, flight] ** 2)) for tick in ticks])


def noticed(time: Array, event: Array, alarm: Booleans) -> Array:
    """Share of N events (N,) that raise an alarm (T, N) within each of TICKS.

    The first tick after the event counts as one.
    """
    after = time > event
    raised = after & alarm
    trial = np.arange(len(event))
    number = np.cumsum(after, axis=0)[raised.argmax(axis=0), trial]
    first = np.where(raised.any(axis=0), number, np.inf)
    # No event is no success, so that a run of a few throws has a number too.
    return np.array([np.sum(first <= ticks) / max(len(event), 1) for ticks in TICKS])


def collisions(learner: Learner, replicate: int, effort: Effort) -> Quantities:
    """collision_noticed: share of balls that hit the cup's rim and surprise within each of TICKS.

    An arm at rest stands half a cup, give or take the ball's radius, beside the crossing. Balls
    that fall into it are not counted, nor are those that pass it.
    """
    world, rng = World(), stream("catching: collisions", replicate)
    shares: list[Array] = []
    for ball in BALLS.values():
        throws = throws_for(ball, LIGHT, replicate, effort).throws
        half, radius = 0.5 * world.layout.cup.width, world.balls[ball].radius
        beside = rng.choice([-half, half], len(throws)) + rng.uniform(-radius, radius, len(throws))
        seen = play(
            world, replace(throws, arm_x=throws.crossing_x + beside), Still(), after=AFTERWARDS
        )
        hit = np.isfinite(seen.contact_time) & ~seen.caught
        surprised = thoughts(learner.catcher(ball=ball), seen)["ball_surprise"] >= 1.0
        shares.append(noticed(seen.sensed.time[:, hit], seen.contact_time[hit], surprised[:, hit]))
    return {"collision_noticed": Curve(TICKS.astype(float), np.mean(shares, axis=0))}
