"""Who it is and whether it behaves as predicted, with state nets that know two simple laws."""

from typing import Any, cast

import numpy as np

from handeye.catching.comparator import Comparator
from handeye.catching.memory import ShortTermMemory
from handeye.catching.signals import Stream, Table
from handeye.catching.understanding import Understanding, discrepancy_streams

x = Stream("x")
TABLE = Table((x(0),), (x(1) - x(0),))


class Constant:
    """Predicts that x grows by so much a tick."""

    table = TABLE

    def __init__(self, growth):
        self.growth = growth

    def answer(self, inputs):
        return np.full((len(inputs), 1), self.growth)


class Recogniser:
    """Names what it is told to, from a tick on."""

    def __init__(self, names=(), since=0):
        self.names, self.since, self.tick = np.array(names, np.int64), since, -1

    def choose(self, _memory, rows):
        names = self.names if self.tick >= self.since else np.full_like(self.names, -1)
        return names[rows]


class Scene:
    def __init__(self, believed, recogniser, *, try_all=False, laws=(1.0, 2.0)):
        n = len(believed)
        self.memory = ShortTermMemory(["x", *discrepancy_streams("ball", 2)], 12, n)
        self.recogniser = recogniser
        self.thing = Understanding(
            "ball", cast("Any", [*map(Constant, laws)]), recogniser, Comparator((0.1,)),
            np.array(believed), try_all=try_all,
        )  # fmt: skip
        self.x = np.zeros(n)

    def ticks(self, number, growth):
        for _ in range(number):
            self.memory.tick()
            self.recogniser.tick += 1
            self.memory.record("x", self.x)
            self.thing.judge(self.memory)
            self.thing.expect(self.memory)
            self.x = self.x + growth


def test_what_behaves_as_predicted_is_comprehended_with_enough_data():
    scene = Scene([0], Recogniser([0]))
    scene.ticks(3, 1.0)
    assert not scene.thing.comprehended[0]
    scene.ticks(1, 1.0)
    assert scene.thing.comprehended[0]
    assert scene.thing.surprise[0] == 0.0


def test_a_wrong_belief_is_dropped_recognised_and_comprehended_in_mid_trial():
    scene = Scene([0, 1], Recogniser([1, 1], since=6))
    scene.ticks(4, 2.0)
    np.testing.assert_array_equal(scene.thing.identity, [-1, 1])
    np.testing.assert_array_equal(scene.thing.latest, [0, 1])
    np.testing.assert_array_equal(scene.thing.comprehended, [False, True])
    np.testing.assert_allclose(scene.thing.surprise, [10.0, 0.0])
    scene.ticks(3, 2.0)
    np.testing.assert_array_equal(scene.thing.identity, [1, 1])
    assert not scene.thing.comprehended[0]
    scene.ticks(3, 2.0)
    assert scene.thing.comprehended.all()


def test_an_unknown_one_is_asked_about_until_it_is_named():
    scene = Scene([-1], Recogniser([0], since=5))
    scene.ticks(5, 1.0)
    assert scene.thing.identity[0] == -1
    assert np.isnan(scene.thing.surprise[0])
    scene.ticks(1, 1.0)
    assert scene.thing.identity[0] == scene.thing.latest[0] == 0


def test_an_event_is_noticed_within_ten_ticks_and_forgotten():
    scene = Scene([0], Recogniser([0]))
    scene.ticks(12, 1.0)
    scene.x -= 0.7  # a bounce
    scene.ticks(1, 1.0)
    assert not scene.thing.comprehended[0]
    scene.ticks(3, 1.0)
    assert scene.thing.comprehended[0]


def test_small_deviations_below_the_threshold_are_tolerated():
    scene = Scene([0], Recogniser([0]))
    scene.ticks(12, 1.09)
    assert scene.thing.comprehended[0]
    scene.ticks(12, 1.11)
    assert not scene.thing.comprehended[0]


def test_trying_all_finds_who_predicts_best_whatever_the_recogniser_says():
    scene = Scene([-1, -1], Recogniser([0, 0]), try_all=True)
    scene.ticks(4, np.array([1.0, 2.0]))
    np.testing.assert_array_equal(scene.thing.identity, [0, 1])
    assert scene.thing.comprehended.all()


def test_trying_all_asks_the_recogniser_between_equals():
    scene = Scene([-1], Recogniser([1]), try_all=True)
    scene.ticks(4, 1.5)
    assert scene.thing.identity[0] == 1
    assert not scene.thing.comprehended[0]


def test_who_is_tried_after_poor_predictions_gets_new_ones():
    scene = Scene([-1], Recogniser([1]), try_all=True)
    scene.ticks(6, 1.5)
    assert scene.thing.identity[0] == 1
    assert np.isnan(scene.thing.surprise[0])
    scene.ticks(1, 1.5)
    assert scene.thing.identity[0] == -1


def test_one_surprise_is_no_proof_of_a_change():
    scene = Scene([0], Recogniser([1]), try_all=True, laws=(1.0, 1.08))
    scene.ticks(12, 1.0)
    scene.x -= 0.7
    scene.ticks(1, 1.0)
    assert scene.thing.identity[0] == -1
    scene.ticks(4, 1.08)  # the other is clearly better, but the first is good enough
    assert scene.thing.identity[0] == 0
