"""Who is it? A line for each identity, with recognisers that learned two points."""

from dataclasses import replace
from typing import Any, cast

import numpy as np
import pytest

from handeye.catching.memory import ShortTermMemory
from handeye.catching.recognition import UNKNOWN, Recogniser
from handeye.catching.repertoire import Repertoire
from handeye.catching.settings import IMPROVED, THESIS, Tuning
from handeye.catching.signals import Stream, Table

x = Stream("x")
TABLE = Table((x(0),), ())
TUNING = Tuning((1.0,), (1.0,), 0.01)
PLACES = (1.0, 5.0)


def recogniser(threshold: float) -> Recogniser:
    """Identity 0 shows at 1, identity 1 at 5."""
    made = Recogniser(TABLE, TUNING, threshold, len(PLACES))
    for identity, place in enumerate(PLACES):
        made.learn(identity, {"x": np.full((1, 1), place)}, {})
    return made


def named(made: Recogniser, *values: float) -> list[int]:
    memory = ShortTermMemory(["x"], 1, len(values))
    memory.tick()
    memory.record("x", values)
    return made.choose(memory, np.arange(len(values))).tolist()


def test_who_showed_at_a_place_is_named_there():
    assert named(recogniser(0.5), *PLACES) == [0, 1]


class Lines:
    """Stands in for a skill: says these lines, whatever it hears."""

    table = TABLE

    def answer(self, inputs):
        return np.array([[0.2, 0.6], [0.7, 0.1], [0.4, 0.3]])[: len(inputs)]


@pytest.mark.parametrize(
    ("threshold", "expected"),
    [(0.0, [1, 0, 0]), (0.5, [1, 0, UNKNOWN]), (0.65, [UNKNOWN, 0, UNKNOWN])],
)
def test_the_highest_line_above_the_threshold_names_the_identity(threshold, expected):
    made = recogniser(threshold)
    made.skill = cast("Any", Lines())
    assert named(made, 1.0, 1.0, 1.0) == expected


def test_nothing_is_named_without_memory():
    assert named(recogniser(-9.0), np.nan, 1.0) == [UNKNOWN, 0]


@pytest.mark.parametrize("settings", [THESIS, IMPROVED, replace(THESIS, ball_threshold=0.7)])
def test_balls_and_arms_have_thresholds_of_their_own(settings):
    made = Repertoire.empty(settings, 2, 2)
    assert made.ball_recogniser.threshold == settings.ball_threshold
    assert made.arm_recogniser.threshold == settings.arm_threshold
