from dataclasses import replace

import numpy as np
import pytest
from tests.catching.trained import WORLD, throws

from handeye.catching import practice
from handeye.catching.learner import Learner
from handeye.catching.settings import IMPROVED, THESIS
from handeye.errors import InvalidInput


@pytest.mark.parametrize("settings", [THESIS, IMPROVED])
def test_portions_make_no_difference(settings):
    whole, parts = Learner(settings), Learner(settings)
    practice.train(whole, WORLD, 7, pursuits=23, tosses=11, mentored=0)
    for pursuits, tosses in ((4, 11), (10, 11), (23, 11)):
        practice.train(parts, WORLD, 7, pursuits=pursuits, tosses=tosses, mentored=0)
    # Arms share a recognition net, which meets them in another order.
    alike = [name for name in whole.neurons if not name.endswith("recogniser")]
    assert {n: whole.neurons[n] for n in alike} == {n: parts.neurons[n] for n in alike}
    x = np.random.default_rng(0).normal(size=(20, 3))
    for one, other in zip(whole.repertoire.motors, parts.repertoire.motors, strict=True):
        np.testing.assert_array_equal(one.answer(x), other.answer(x))


def test_replicates_practise_different_things():
    x = np.zeros((1, 3))
    answers = []
    for replicate in (0, 1):
        learner = Learner()
        practice.train(learner, WORLD, replicate, pursuits=5, tosses=0, mentored=0)
        answers.append(learner.repertoire.motors[0].answer(x)[0, 0])
    assert answers[0] != answers[1]


def test_practice_may_differ_between_identities():
    learner = Learner()
    practice.train(learner, WORLD, 0, pursuits=(3, 5), tosses=(2, 0), mentored=0)
    assert (learner.pursuits, learner.tosses) == ([3, 5], [2, 0])
    practice.train(learner, WORLD, 0, pursuits=1, tosses=1, mentored=0)
    assert (learner.pursuits, learner.tosses) == ([3, 5], [2, 1])
    with pytest.raises(InvalidInput, match="pursuits must be one number or 2"):
        practice.train(learner, WORLD, 0, pursuits=(1, 2, 3))


def test_the_modes_learn_what_they_are_about():
    learner, rng = Learner(), np.random.default_rng(0)
    practice.practise_arm(learner, WORLD, 0, 5, rng)
    arm = {"motors.0", "arm_states.0", "arm_recogniser"}
    assert {name for name, n in learner.neurons.items() if n} == arm
    practice.watch_tosses(learner, WORLD, 1, 5, rng)
    ball = {"crossings.1", "ball_states.1", "ball_recogniser"}
    assert {name for name, n in learner.neurons.items() if n} == arm | ball
    said = []
    practice.coach(
        learner, WORLD, throws(2, arms=(0,), balls=(1,)), lambda *news: said.append(news)
    )
    assert learner.mentored == 2
    assert said == [("mentored throws", 1, 2), ("mentored throws", 2, 2)]


def test_watched_balls_are_not_touched():
    learner = Learner()
    spy = learner.repertoire.crossings[0]
    practice.watch_tosses(learner, WORLD, 0, 20, np.random.default_rng(1))
    # At every tick of a flight the time left and the way left were learned from its own crossing.
    assert spy.network.trials > 20 * 30


def test_gentle_practice_is_uniform_in_the_logarithm_of_the_amplitude():
    drawn = [
        practice._pursuits(
            Learner(replace(IMPROVED, gentle=gentle)), WORLD, 1, 200, np.random.default_rng(0)
        ).amplitude
        for gentle in (False, True)
    ]
    np.testing.assert_allclose(drawn[1], 0.03 ** ((1.0 - drawn[0]) / 0.97))
    assert 0.03 <= drawn[1].min() < 0.04
    assert 0.9 < drawn[1].max() <= 1.0
