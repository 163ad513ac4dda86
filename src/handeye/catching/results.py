"""What a catcher achieves, as plain data that tables, pages and JSON are made from."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import sqrt
from typing import Any

import numpy as np

from handeye.arrays import Booleans
from handeye.catching.play import Recording
from handeye.errors import InvalidInput
from handeye.intervals import wilson_interval

IDENTITIES = ("light", "heavy")
"""What identities 0 and 1 are called, of balls and of arms."""

ANY = -1
"""In place of an identity: of all of them together."""


_NETWORKS = {
    "ball_recogniser": "ball recognition",
    "arm_recogniser": "arm recognition",
    "ball_states": "state of the {} ball",
    "crossings": "crossing of the {} ball",
    "arm_states": "state of the {} arm",
    "motors": "motor command, {} arm",
    "corrections": "catch correction, {} arm",
}


def network_name(key: str) -> str:
    """A network of `Learner.neurons` in words: "motors.1" is "motor command, heavy arm"."""
    kind, _, identity = key.partition(".")
    return _NETWORKS[kind].format(_called(int(identity)) if identity else "")


@dataclass(frozen=True)
class Score:
    """Catches among n >= 1 throws of one ball at one arm.

    ball, arm  identities
    caught     how many ended in the cup
    rms        root mean square of the cup's distance from the crossing at crossing time [m]
    """

    ball: int
    arm: int
    n: int
    caught: int
    rms: float

    @property
    def name(self) -> str:
        """In words: "light ball, heavy arm"."""
        return f"{_called(self.ball)} ball, {_called(self.arm)} arm"

    @property
    def share(self) -> float:
        """Share of the throws that were caught."""
        return self.caught / self.n

    @property
    def interval(self) -> tuple[float, float]:
        """Wilson's 95 % interval of the probability of a catch."""
        return wilson_interval(self.caught, self.n)

    def to_json(self) -> dict[str, Any]:
        """All numbers by name; lengths in metres."""
        low, high = self.interval
        return {
            "ball": _called(self.ball), "arm": _called(self.arm), "n": self.n,
            "caught": self.caught, "share": self.share, "low": low, "high": high,
            "rms_position_error": self.rms,
        }  # fmt: skip


def scores_of(recording: Recording) -> tuple[Score, ...]:
    """One score for each pair of ball and arm in a recording, in order."""
    throws = recording.throws
    pairs = sorted(set(zip(throws.ball.tolist(), throws.arm.tolist(), strict=True)))
    return tuple(
        _score(recording, (throws.ball == ball) & (throws.arm == arm), ball, arm)
        for ball, arm in pairs
    )


def total_of(recording: Recording) -> Score:
    """Over all throws of a recording, of any ball at any arm."""
    return _score(recording, np.ones(len(recording), np.bool_), ANY, ANY)


def sum_of(scores: Sequence[Score]) -> Score:
    """The score of all throws of some scores together."""
    n = sum(score.n for score in scores)
    squares = sum(score.n * score.rms**2 for score in scores)
    return Score(ANY, ANY, n, sum(score.caught for score in scores), sqrt(squares / n))


def _score(recording: Recording, rows: Booleans, ball: int, arm: int) -> Score:
    n = int(np.count_nonzero(rows))
    if n == 0:
        raise InvalidInput("there are no throws: nothing can be said about catching")
    rms = float(np.sqrt(np.mean(recording.position_error[rows] ** 2)))
    return Score(ball, arm, n, int(np.count_nonzero(recording.caught[rows])), rms)


@dataclass(frozen=True)
class Mark:
    """A moment of training at which catching was tested.

    pursuits  made so far with each arm
    mentored  throws so far on which the mentor gave advice
    """

    pursuits: int
    mentored: int
    scores: tuple[Score, ...]


@dataclass(frozen=True)
class Take:
    """The same throws as in the other takes, at one moment of training.

    title      what a reader should call it, such as "10 pursuits"
    recording  with some time after the end of each throw, so that one sees what came of it
    """

    title: str
    recording: Recording


@dataclass(frozen=True)
class CatchingResult:
    """Everything that a report on a catcher shows.

    test         the test throws, with the controller's traces
    surprised    some throws for which it believed in the wrong ball and arm at the start
    takes        the same few throws at several moments of training, earliest first
    marks        tests during training, earliest first; empty for one that was not trained here
    neurons      key of a network (see `network_name`) -> neurons in use
    cpu_seconds  processor time of all training so far
    settings     everything needed to do it again
    """

    test: Recording
    surprised: Recording
    takes: Sequence[Take]
    marks: Sequence[Mark]
    neurons: Mapping[str, int]
    cpu_seconds: float
    settings: Mapping[str, str] = field(default_factory=dict[str, str])

    @property
    def scores(self) -> tuple[Score, ...]:
        """Of the test throws."""
        return scores_of(self.test)


def _called(identity: int) -> str:
    return "any" if identity == ANY else IDENTITIES[identity]
