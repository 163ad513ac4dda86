import numpy as np
import pytest

from handeye.catching.settings import Tuning
from handeye.catching.signals import Stream, Table
from handeye.catching.skills import Samples, Skill, answers, novelties
from handeye.errors import InvalidInput
from handeye.networks import InputSpace, ResourceAllocatingNetwork
from handeye.randomness import stream

TABLE = Table((Stream("a")(0), Stream("b")(0)), (Stream("c")(0),))
ONCE = Tuning((2.0, 0.5), (10.0,), 0.001)
REPLAYED = Tuning((2.0, 0.5), (10.0,), 0.001, 2.0, 3)
RNG = np.random.default_rng(0)
X = RNG.normal(size=(40, 2))
Y = (20.0 * np.sin(X[:, :1]) + X[:, 1:]) * 3.0


def network(h):
    return ResourceAllocatingNetwork(
        2, 1, inputs=InputSpace.scaled([2.0, 0.5]), half_max_fraction=h,
        error_threshold=0.001, learning_threshold=0.001,
    )  # fmt: skip


def test_a_skill_is_a_network_in_scaled_outputs_that_learns_in_order():
    skill, expected = Skill(TABLE, ONCE), network(0.8)
    skill.practise(X, Y)
    expected.learn_many(X, Y / 10.0)
    np.testing.assert_array_equal(skill.answer(X), expected.predict_many(X) * 10.0)
    assert len(skill.experience.inputs) == 0


def test_replaying_learns_everything_anew_in_random_orders():
    skill, expected = Skill(TABLE, REPLAYED), network(2.0)
    skill.practise(X, Y)
    order = stream("replay")
    for _ in range(3):
        chosen = order.permutation(40)
        expected.learn_many(X[chosen], Y[chosen] / 10.0)
    np.testing.assert_array_equal(skill.network.weights, expected.weights)


def test_what_is_replayed_does_not_depend_on_the_portions():
    whole, parts = Skill(TABLE, REPLAYED), Skill(TABLE, REPLAYED)
    whole.practise(X, Y)
    for i in range(0, 40, 7):
        parts.practise(X[i : i + 7], Y[i : i + 7])
    np.testing.assert_array_equal(parts.answer(X), whole.answer(X))


def test_each_trial_asks_the_skill_of_its_identity():
    skills = [Skill(TABLE, ONCE), Skill(TABLE, ONCE)]
    skills[0].practise(X, Y)
    skills[1].practise(X, -Y)
    inputs = np.vstack([X[:3], [[np.nan, 0.0]]])
    found = answers(skills, np.array([0, 1, -1, 0]), inputs)
    np.testing.assert_allclose(found[0], skills[0].answer(X[:1])[0])
    np.testing.assert_allclose(found[1], skills[1].answer(X[1:2])[0])
    assert np.isnan(found[2:]).all()


def test_novelty_is_the_scaled_distance_to_experience_of_ones_own_skill():
    skills = [Skill(TABLE, ONCE), Skill(TABLE, ONCE)]
    skills[0].practise(np.zeros((1, 2)), np.array([[5.0]]))
    found = novelties(skills, np.array([0, 1, -1]), np.tile([2.0, 0.5], (3, 1)))
    np.testing.assert_allclose(found, [np.sqrt(2.0), np.inf, np.inf])


def test_taking_over_what_does_not_fit_changes_nothing():
    skill = Skill(TABLE, ONCE)
    skill.practise(X, Y)
    before = skill.answer(X)
    nothing = Samples(np.empty((0, 2)), np.empty((0, 1)))
    with pytest.raises(InvalidInput, match="2 inputs and 1 outputs"):
        skill.take_over(ResourceAllocatingNetwork(3, 1), nothing)
    with pytest.raises(InvalidInput, match="outputs"):
        skill.take_over(network(0.8), Samples(np.empty((1, 2)), np.empty((0, 1))))
    np.testing.assert_array_equal(skill.answer(X), before)
