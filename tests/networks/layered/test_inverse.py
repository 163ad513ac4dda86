"""Back-propagation across an unknown plant (eq A.15 to A.18)."""

import numpy as np
import pytest
from tests.networks.layered.formulas import steps

from handeye.errors import InvalidInput
from handeye.networks import InputSpace
from handeye.networks.layered import InverseLearner, LayeredNetwork, measured_slopes

A = np.array([[1.0, 0.5], [-0.3, 0.8]])


def layered(n_inputs, n_outputs, hidden=(), seed=0, **settings):
    rng = np.random.default_rng(seed)
    return LayeredNetwork(n_inputs, n_outputs, hidden, rng=rng, **settings)


def linear_pair(rate=0.2):
    return InverseLearner(layered(2, 2, seed=1, rate=rate), layered(2, 2, seed=2, rate=rate))


def arm(joints):
    """Where an arm with links of 1 and 1 has its hand; joints near (0, pi/2)."""
    alpha, beta = np.asarray(joints)[..., 0], np.asarray(joints)[..., 1] + 0.5 * np.pi
    return np.stack(
        [np.cos(alpha) + np.cos(alpha + beta), np.sin(alpha) + np.sin(alpha + beta)], axis=-1
    )


def test_the_change_of_the_controller_equals_its_formula():
    learner = InverseLearner(layered(3, 2, (4,), rate=0.1), layered(3, 2, (5,), seed=3, rate=0.05))
    goal, state, command = np.array([0.3, -0.5]), np.array([0.2]), np.array([0.1, 0.7])
    outcome = np.array([-0.2, 0.4])
    model = learner.model.copy()
    model.learn([*command, *state], outcome)
    slopes = model.slopes([*command, *state])[:, :2]
    wanted = [sum((goal[j] - outcome[j]) * slopes[j, k] for j in range(2)) for k in range(2)]
    before = learner.controller.weights
    changes = steps(learner.controller, np.append(goal, state), wanted)
    expected = outcome - learner.model.predict([*command, *state])
    error, model_error = learner.learn(goal, command, outcome, state)
    np.testing.assert_allclose(error, goal - outcome, rtol=1e-14)
    np.testing.assert_allclose(model_error, expected, rtol=1e-14)
    for new, old, change in zip(learner.controller.weights, before, changes, strict=True):
        np.testing.assert_allclose(new - old, change, rtol=1e-9, atol=1e-14)
    np.testing.assert_array_equal(learner.model.weights[0], model.weights[0])


def test_with_a_perfect_model_the_goal_error_descends():
    """The change is -rate d/dw |goal - A command(goal)|^2 / 2, by differences."""
    learner = linear_pair()
    learner.model.weights = [np.column_stack([A, np.zeros(2)])]
    goal, before = np.array([0.6, -0.4]), learner.controller.weights[0]

    def energy(weights):
        return 0.5 * np.sum((goal - A @ (weights @ np.append(goal, 1.0))) ** 2)

    command = learner.command(goal)
    learner.learn(goal, command, A @ command)
    for place in np.ndindex(2, 3):
        sides = [energy(before + tiny * _one(place)) for tiny in (1e-6, -1e-6)]
        change = learner.controller.weights[0][place] - before[place]
        assert change == pytest.approx(-0.2 * (sides[0] - sides[1]) / 2e-6, rel=1e-6, abs=1e-10)


def _one(place):
    matrix = np.zeros((2, 3))
    matrix[place] = 1.0
    return matrix


def test_of_a_linear_plant_model_and_inverse_are_found():
    learner, rng = linear_pair(), np.random.default_rng(0)
    for goal in rng.uniform(-1, 1, (3000, 2)):
        command = learner.command(goal)
        learner.learn(goal, command, A @ command)
    np.testing.assert_allclose(learner.model.weights[0][:, :2], A, atol=1e-3)
    np.testing.assert_allclose(learner.controller.weights[0][:, :2], np.linalg.inv(A), atol=1e-3)


def test_an_arm_learns_to_reach_without_being_told_a_command():
    rng = np.random.default_rng(0)
    inputs = InputSpace.box([0.0, 0.0], [2.0, 2.0])
    controller = layered(2, 2, (12,), inputs=inputs, rate=0.1)
    learner = InverseLearner(controller, layered(2, 2, (16,), seed=1, rate=0.05))
    goals = arm(rng.uniform(-0.6, 0.6, (200, 2)))

    def missed():
        return float(np.linalg.norm(goals - arm(controller.predict_many(goals)), axis=1).mean())

    before = missed()
    for joints in rng.uniform(-0.8, 0.8, (2000, 2)):
        learner.observe(joints, arm(joints))
    assert missed() == before
    for goal in arm(rng.uniform(-0.6, 0.6, (8000, 2))):
        command = learner.command(goal)
        learner.learn(goal, command, arm(command))
    assert before > 0.5
    assert missed() < 0.1


def test_what_depends_on_a_state_is_learned_with_it():
    """A plant whose sign the state decides has no inverse that does not know it."""
    rng = np.random.default_rng(0)
    controller = layered(2, 1, (8,), rate=0.03)
    learner = InverseLearner(controller, layered(2, 1, (8,), seed=1, rate=0.05))

    def miss(goal, state):
        return abs(goal - state * learner.command([goal], [state])[0])

    for command, state in zip(rng.uniform(-1, 1, 8000), rng.choice([-1.0, 1.0], 8000), strict=True):
        learner.observe([command], [state * command], [state])
    for goal, state in zip(
        rng.uniform(-0.7, 0.7, 8000), rng.choice([-1.0, 1.0], 8000), strict=True
    ):
        command = learner.command([goal], [state])
        learner.learn([goal], command, state * command, [state])
    tries = [(goal, state) for goal in (-0.6, -0.2, 0.4) for state in (-1.0, 1.0)]
    assert max(miss(*one) for one in tries) < 0.1


def test_measured_slopes_are_the_derivatives_of_the_plant():
    joints = np.array([0.2, -0.3])
    a, ab = joints[0], joints.sum() + 0.5 * np.pi
    expected = [[-np.sin(a) - np.sin(ab), -np.sin(ab)], [np.cos(a) + np.cos(ab), np.cos(ab)]]
    np.testing.assert_allclose(measured_slopes(arm, joints), expected, atol=1e-6)
    np.testing.assert_allclose(measured_slopes(lambda a: A @ a, [1.0, 2.0]), A, rtol=1e-9)


def test_measured_slopes_take_the_place_of_a_model():
    controller, rng = layered(2, 2, rate=0.2), np.random.default_rng(0)
    for goal in rng.uniform(-1, 1, (1500, 2)):
        command = controller.predict(goal)
        miss = goal - A @ command
        controller.learn_change(goal, miss @ measured_slopes(lambda a: A @ a, command))
    np.testing.assert_allclose(controller.weights[0][:, :2], np.linalg.inv(A), atol=1e-3)


@pytest.mark.parametrize(("model", "controller"), [((2, 3), (2, 2)), ((3, 2), (2, 2))])
def test_networks_that_do_not_fit_are_refused(model, controller):
    with pytest.raises(InvalidInput, match="do not fit"):
        InverseLearner(layered(*controller), layered(*model))


@pytest.mark.parametrize("bad", [[np.nan, 0.0], [0.0], None, ["1", "2"], [1e200, 0.0]])
def test_what_cannot_be_used_is_refused_and_changes_nothing(bad):
    learner, good = linear_pair(), [0.1, 0.2]
    kept = [learner.model.weights[0], learner.controller.weights[0]]
    for call in (
        lambda: learner.learn(bad, good, good),
        lambda: learner.learn(good, bad, good),
        lambda: learner.learn(good, good, bad),
        lambda: learner.observe(bad, good),
        lambda: learner.observe(good, bad),
        lambda: learner.command(bad),
        lambda: learner.command(good, bad),
        lambda: learner.learn(good, good, good, [1.0]),
    ):
        with pytest.raises(InvalidInput):
            call()
    np.testing.assert_array_equal(learner.model.weights[0], kept[0])
    np.testing.assert_array_equal(learner.controller.weights[0], kept[1])
    with pytest.raises(InvalidInput, match="step"):
        measured_slopes(arm, good, step=0.0)
