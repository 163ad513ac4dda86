"""The thesis's solver: its direction, its rule, and every way in which it can end."""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from handeye.calibration.estimation import Status, levenberg_marquardt
from handeye.calibration.estimation.levenberg_marquardt import normal_equations, orthogonal
from handeye.errors import InvalidInput

DIRECTIONS = pytest.mark.parametrize("direction", [normal_equations, orthogonal])


class Sum:
    """A sum of squares of given residuals."""

    def __init__(self, residuals, jacobian):
        self.residuals: Any = residuals
        self.jacobian: Any = jacobian
        self.tried = []

    def cost(self, parameters):
        self.tried.append(parameters.copy())
        return float(np.sum(self.residuals(parameters) ** 2))


def rosenbrock():
    return Sum(
        lambda p: np.array([10.0 * (p[1] - p[0] ** 2), 1.0 - p[0]]),
        lambda p: np.array([[-20.0 * p[0], 10.0], [-1.0, 0.0]]),
    )


def line(t, y):
    J = np.stack([t, np.ones_like(t)], axis=1)
    return Sum(lambda p: J @ p - y, lambda _: J)


@DIRECTIONS
@pytest.mark.parametrize("damping", [1e-6, 1.0, 30.0])
def test_the_direction_is_that_of_eq_3_114_to_3_116(direction, damping):
    rng = np.random.default_rng(0)
    J, r = rng.normal(size=(7, 3)), rng.normal(size=7)
    H = np.zeros((3, 3))
    gradient = np.zeros(3)
    for i in range(7):
        for k in range(3):
            gradient[k] += J[i, k] * r[i]
            for m in range(3):
                H[k, m] += J[i, k] * J[i, m]
    M = H + damping * np.eye(3) * H
    np.testing.assert_allclose(direction(r, J, damping), np.linalg.inv(M) @ -gradient, rtol=1e-10)


@DIRECTIONS
def test_it_finds_the_minimum_of_a_curved_valley(direction):
    found = levenberg_marquardt(rosenbrock(), [-1.2, 1.0], direction=direction)
    assert found.status is Status.CONVERGED
    assert found.converged
    np.testing.assert_allclose(found.parameters, [1.0, 1.0], rtol=1e-12)
    assert found.cost < 1e-20


def test_a_linear_fit_with_noise_equals_the_closed_form():
    rng = np.random.default_rng(1)
    t = np.linspace(0.0, 1.0, 20)
    y = 3.0 * t - 1.0 + rng.normal(size=20)
    found = levenberg_marquardt(line(t, y), [0.0, 0.0])
    assert found.converged
    np.testing.assert_allclose(found.parameters, np.polyfit(t, y, 1), rtol=1e-9)
    assert found.cost == pytest.approx(np.sum((np.polyval(found.parameters, t) - y) ** 2))


def test_the_damping_falls_by_the_factor_after_a_step_and_grows_by_it_after_a_refusal():
    used = []

    def watched(r, J, damping):
        used.append(damping)
        return normal_equations(r, J, damping)

    problem = rosenbrock()
    costs = [np.inf]
    levenberg_marquardt(problem, [-1.2, 1.0], direction=watched, damping=0.01, factor=5.0)
    expected = [0.01]
    best = problem.cost(problem.tried[0])
    for tried in problem.tried[1 : len(used)]:
        cost = float(np.sum(problem.residuals(tried) ** 2))
        accepted = cost < best
        costs.append(cost)
        best = min(best, cost)
        expected.append(expected[-1] / 5.0 if accepted else expected[-1] * 5.0)
    np.testing.assert_allclose(used, expected[: len(used)], rtol=1e-12)
    assert any(b > a for a, b in pairwise(used)), "no step was refused"


def test_the_cost_never_rises_and_the_best_parameters_are_returned():
    problem = rosenbrock()
    found = levenberg_marquardt(problem, [-1.2, 1.0], iterations=6)
    assert found.status is Status.TOO_MANY_ITERATIONS
    assert found.iterations == 6
    assert found.cost == problem.cost(found.parameters)
    assert found.cost == min(problem.cost(p) for p in list(problem.tried))


def test_a_minimum_at_the_start_is_left_exactly():
    found = levenberg_marquardt(rosenbrock(), [1.0, 1.0])
    assert found.converged
    assert found.iterations == 0
    np.testing.assert_array_equal(found.parameters, [1.0, 1.0])


def test_a_parameter_without_effect_is_said_to_be_undetermined():
    problem = Sum(lambda p: p[:1] - 2.0, lambda _: np.array([[1.0, 0.0]]))
    found = levenberg_marquardt(problem, [0.0, 5.0])
    assert found.status is Status.NOT_DETERMINED
    assert "fix it" in found.status.value
    np.testing.assert_array_equal(found.parameters, [0.0, 5.0])


@DIRECTIONS
def test_parameters_that_only_work_together_are_solved_by_the_damping(direction):
    J = np.array([[1.0, 1.0], [2.0, 2.0]])
    problem = Sum(lambda p: J @ p - np.array([1.0, 2.0]), lambda _: J)
    found = levenberg_marquardt(problem, [0.0, 0.0], direction=direction)
    assert found.cost < 1e-20
    np.testing.assert_allclose(found.parameters.sum(), 1.0, rtol=1e-9)


def test_a_wrong_jacobian_ends_without_a_better_step():
    problem = rosenbrock()
    right = problem.jacobian
    problem.jacobian = lambda p: -right(p)
    found = levenberg_marquardt(problem, [-1.2, 1.0])
    assert found.status is Status.NO_BETTER_STEP
    assert "check the Jacobian" in found.status.value
    np.testing.assert_array_equal(found.parameters, [-1.2, 1.0])


def test_a_start_without_finite_residuals_is_a_status():
    problem = Sum(lambda p: np.log(np.where(p > 0.0, p, np.nan)), lambda p: np.diag(1.0 / p))
    found = levenberg_marquardt(problem, [-1.0])
    assert found.status is Status.IMPOSSIBLE_START
    assert levenberg_marquardt(problem, [3.0]).converged


def test_derivatives_that_are_not_finite_are_a_status():
    problem = Sum(lambda p: p, lambda _: np.array([[np.inf]]))
    assert levenberg_marquardt(problem, [1.0]).status is Status.DIVERGED


def test_every_status_advises():
    assert len({status.value for status in Status}) == len(Status)
    assert all(len(status.value.split()) > 5 for status in Status)


@pytest.mark.parametrize(
    "wrong",
    [{"damping": 0.0}, {"factor": 1.0}, {"tolerance": -1.0}, {"iterations": 0}],
)
def test_settings_that_make_no_sense_raise(wrong):
    with pytest.raises(InvalidInput):
        levenberg_marquardt(rosenbrock(), [0.0, 0.0], **wrong)


@pytest.mark.parametrize("start", [[np.nan, 0.0], [[0.0, 0.0]], ["a", "b"]])
def test_starts_that_are_no_finite_vector_raise(start):
    with pytest.raises(InvalidInput):
        levenberg_marquardt(rosenbrock(), start)


def test_residuals_and_jacobian_that_do_not_fit_raise():
    with pytest.raises(InvalidInput, match="Jacobian"):
        levenberg_marquardt(Sum(lambda p: p, lambda _: np.eye(3)), [1.0, 2.0])
