"""The three objectives: their formulas, written the slow way, and their derivatives."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.calibration.cases import sightings as world_sightings

from handeye.calibration.estimation import NAMES, THESIS, Assumptions, Tolerances
from handeye.calibration.estimation.kernels import (
    commanded_rows,
    forward_rows,
    residual_rows,
    reverse_rows,
)
from handeye.calibration.estimation.losses import LOSSES, curvature, rho, weight
from handeye.calibration.estimation.objectives import OBJECTIVES, PlanarProblem, sightings
from handeye.calibration.estimation.parameters import indices, plant_with, vector
from handeye.errors import InvalidInput
from handeye.geometry.angles import wrap
from handeye.robots.encoder import AxisEncoder
from handeye.sensors.stereo import StereoHead
from handeye.thesis.plants import LARGE, NOMINAL, NORMAL

SEEN = world_sightings(NORMAL, 40)
ROWS = sightings(NOMINAL, Assumptions(), SEEN)
P = np.array([1.02, 0.97, -1.03, 0.04, 0.03, -0.05, 0.06, 0.95])
KERNELS = {"forward": forward_rows, "reverse": reverse_rows, "residuals": residual_rows}


def evaluate(objective, p, rows):
    n = len(rows) * (2 if objective == "residuals" else 1)
    values, slopes = np.full(n, np.nan), np.full((n, 8), np.nan)
    KERNELS[objective](np.asarray(p), rows, values, slopes)
    return values, slopes


def differences(f, p, steps):
    columns = []
    for k in range(len(p)):
        d = np.zeros(len(p))
        d[k] = steps
        columns.append((f(p + d) - f(p - d)) / (2.0 * steps))
    return np.stack(columns, axis=-1)


@given(seed=st.integers(0, 2**32 - 1))
@pytest.mark.parametrize("objective", OBJECTIVES)
def test_derivatives_are_those_of_the_values(objective, seed):
    rng = np.random.default_rng(seed)
    rows = sightings(NOMINAL, Assumptions(), world_sightings(NORMAL, 1, seed % 1000))
    p = vector(NOMINAL) + 0.02 * rng.uniform(-1.0, 1.0, 8)
    if objective != "residuals":
        p[7] = 1.0  # the thesis has no range scale
    _, slopes = evaluate(objective, p, rows)
    assert slopes[:, 7].any() == (objective == "residuals")
    numeric = differences(lambda p: evaluate(objective, p, rows)[0], p, 1e-6)
    free = slice(0, 8 if objective == "residuals" else 7)
    if np.abs(numeric).max() > 1e6:
        return  # a difference across the cut of an angle
    scale = np.abs(slopes).max()
    np.testing.assert_allclose(slopes[:, free], numeric[:, free], atol=3e-7 * max(scale, 1.0))


def test_residuals_are_signed_components_over_their_standard_deviations():
    values, _ = evaluate("residuals", P, ROWS)
    head = StereoHead()
    for i in range(len(SEEN)):
        alpha, beta = SEEN.joints[i] + P[4:6]
        x = P[0] * np.cos(alpha) + P[1] * np.cos(alpha + beta) - P[2]
        y = P[0] * np.sin(alpha) + P[1] * np.sin(alpha + beta) - P[3]
        r, eps = SEEN.range[i], SEEN.eccentricity[i]
        along = (r - 0.95 * np.hypot(x, y)) / np.hypot(head.range_std(r, eps), 1e-4)
        bearing = SEEN.pointing[i] + eps + P[6] - np.arctan2(y, x)
        across = wrap(bearing) / np.hypot(head.eccentricity_std(eps), 1e-4)
        np.testing.assert_allclose(values[2 * i : 2 * i + 2], [along, across], rtol=1e-10)


def test_the_forward_objective_is_eq_3_117_with_the_sign_of_note_e5():
    p = P.copy()
    p[7] = 1.0
    values, slopes = evaluate("forward", p, ROWS)
    a, b, v_x, v_y, o_alpha, o_beta, o_gamma, _ = p
    for i in range(len(SEEN)):
        alpha, beta = SEEN.joints[i] + [o_alpha, o_beta]
        x = a * np.cos(alpha) + b * np.cos(alpha + beta) - v_x
        y = a * np.sin(alpha) + b * np.sin(alpha + beta) - v_y
        r2 = x**2 + y**2
        theta = wrap(np.arctan2(y, x) - o_gamma)
        measured = SEEN.range[i] ** 2 + wrap(SEEN.pointing[i] + SEEN.eccentricity[i]) ** 2
        np.testing.assert_allclose(values[i], measured - r2 - theta**2, atol=1e-12)
        # Eq 3.120 to 3.126 as printed; the residual's derivative has the other sign.
        q = theta / r2
        hand = np.array([a * np.cos(alpha) + b * np.cos(alpha + beta), y + v_y])
        expected = [
            2 * (x * np.cos(alpha) + y * np.sin(alpha))
            + 2 * q * (x * np.sin(alpha) - y * np.cos(alpha)),
            2 * (x * np.cos(alpha + beta) + y * np.sin(alpha + beta))
            + 2 * q * (x * np.sin(alpha + beta) - y * np.cos(alpha + beta)),
            -2 * (x - q * y),
            -2 * (y + q * x),
            -2 * (x - q * y) * hand[1] + 2 * (y + q * x) * hand[0],
            -2 * (x - q * y) * b * np.sin(alpha + beta)
            + 2 * (y + q * x) * b * np.cos(alpha + beta),
            -2 * theta,
        ]
        np.testing.assert_allclose(-slopes[i, :7], expected, rtol=1e-10, atol=1e-12)


def test_the_reverse_objective_squares_the_angles_that_the_plant_commands():
    p = P.copy()
    values, _ = evaluate("reverse", p, ROWS)
    joints = plant_with(NOMINAL, p).joints_for(SEEN.target)
    expected = np.sum(wrap(SEEN.joints) ** 2, axis=1) - np.sum(joints**2, axis=1)
    np.testing.assert_allclose(values, expected, atol=1e-12)


def test_commanded_rows_are_what_the_plant_commands():
    each = P + 0.01 * np.random.default_rng(3).normal(size=(len(ROWS), 8))
    joints = np.empty((len(ROWS), 2))
    commanded_rows(each, ROWS, joints)
    expected = [plant_with(NOMINAL, p).joints_for(SEEN[i].target) for i, p in enumerate(each)]
    np.testing.assert_allclose(joints, expected, atol=1e-13)


@pytest.mark.parametrize("objective", OBJECTIVES)
@pytest.mark.parametrize("plant", [NORMAL, LARGE])
def test_true_parameters_leave_nothing_in_a_clean_world(objective, plant):
    true = plant.without_noise().without_perturbations()
    rows = sightings(NOMINAL, Assumptions(), world_sightings(true, 300))
    values, _ = evaluate(objective, vector(true), rows)
    assert np.abs(values).max() < 1e-8


def test_a_hand_in_the_eye_or_out_of_reach_has_finite_rows():
    rows = np.array([[0.0, np.pi, 0.0, 0.3, 0.01, 0.01], [0.0, 0.5, 9.0, 0.0, 0.01, 0.01]])
    for objective in OBJECTIVES:
        values, slopes = evaluate(objective, [1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], rows)
        assert np.isfinite(values).all()
        assert np.isfinite(slopes).all()


def test_standard_deviations_come_from_the_head_with_a_floor():
    known = Assumptions(range_error=0.003, bearing_error=0.004)
    silent = sightings(NOMINAL.without_noise(), known, SEEN)
    np.testing.assert_allclose(silent[:, 4], 0.003)
    np.testing.assert_allclose(silent[:, 5], 0.004)
    noisy = sightings(NOMINAL, known, SEEN)
    head = NOMINAL.head.range_std(SEEN.range, SEEN.eccentricity)
    np.testing.assert_allclose(noisy[:, 4] ** 2, head**2 + 0.003**2)


RHO = {
    "squared": lambda s: s,
    "soft_l1": lambda s: 2.0 * (np.sqrt(1.0 + s) - 1.0),
    "huber": lambda s: np.where(s <= 1.0, s, 2.0 * np.sqrt(s) - 1.0),
    "cauchy": np.log1p,
}


@pytest.mark.parametrize("loss", LOSSES)
@pytest.mark.parametrize("z", [0.0, 1e-9, -0.3, 0.9, 1.1, -7.0, 1e6])
def test_losses_have_their_formulas_and_derivatives(loss, z):
    k = LOSSES.index(loss)
    np.testing.assert_allclose(rho(k, z), RHO[loss](z**2), rtol=1e-7, atol=1e-15)
    s, h = z**2 + 1e-3, 1e-4 * (z**2 + 1e-3)
    z = np.sqrt(s)
    slope = (RHO[loss](s + h) - RHO[loss](s - h)) / (2.0 * h)
    np.testing.assert_allclose(weight(k, z), slope, rtol=1e-5)
    bend = (RHO[loss](s + h) - 2.0 * RHO[loss](s) + RHO[loss](s - h)) / h**2
    expected = max(slope + 2.0 * s * bend, 0.1 * slope)
    np.testing.assert_allclose(curvature(k, z), expected, rtol=2e-2)


@pytest.mark.parametrize("loss", LOSSES)
@pytest.mark.parametrize("objective", OBJECTIVES)
def test_a_problem_of_any_free_parameters_has_the_gradient_of_its_cost(objective, loss):
    for free in (THESIS, NAMES, ("O_gamma", "a", "v_x")):
        known = Assumptions(free=free, loss=loss)
        problem = PlanarProblem(objective, NOMINAL, known, ROWS)
        p = P[indices(free)]
        np.testing.assert_array_equal(problem.full(p)[indices(free)], p)
        fixed = np.delete(np.arange(8), indices(free))
        np.testing.assert_array_equal(problem.full(p)[fixed], vector(NOMINAL)[fixed])
        gradient = 2.0 * problem.jacobian(p).T @ problem.residuals(p)
        numeric = differences(lambda p, f=problem: np.array([f.cost(p)]), p, 1e-7)[0]
        if objective != "residuals" and "range_scale" in free:
            gradient, numeric = gradient[:-1], numeric[:-1]
        np.testing.assert_allclose(gradient, numeric, rtol=1e-4, atol=1e-5 * np.abs(numeric).max())


def test_priors_pull_to_nominal_by_their_tolerances():
    known = Assumptions(tolerances=Tolerances(0.1, 0.2, 0.3, 0.4))
    problem = PlanarProblem("residuals", NOMINAL, known, ROWS)
    std = np.array([0.1, 0.1, 0.2, 0.2, 0.3, 0.3, 0.3, 0.4])
    pull = problem.residuals(P)[-8:]
    np.testing.assert_allclose(pull, (vector(NOMINAL) - P) / std)
    np.testing.assert_allclose(problem.jacobian(P)[-8:], np.diag(-1.0 / std))


@pytest.mark.parametrize("place", [0, 1, 7])
def test_lengths_and_scales_that_cannot_be_cost_infinitely(place):
    problem = PlanarProblem("residuals", NOMINAL, Assumptions(), ROWS)
    p = P.copy()
    p[place] = -0.1
    assert problem.cost(p) == np.inf


@pytest.mark.parametrize(
    "wrong",
    [
        {"free": ()},
        {"free": ("a", "a")},
        {"free": ("length",)},
        {"range_error": 0.0},
        {"bearing_error": -1.0},
        {"loss_scale": 0.0},
        {"loss": "l7"},
    ],
)
def test_assumptions_that_make_no_sense_raise(wrong):
    with pytest.raises(InvalidInput):
        Assumptions(**wrong)


@pytest.mark.parametrize("name", ["link", "eye", "offset", "range_scale"])
def test_tolerances_must_be_positive(name):
    with pytest.raises(InvalidInput, match=name):
        Tolerances(**{name: 0.0})


def test_a_plant_and_its_vector_are_the_same():
    plant = plant_with(NORMAL, P)
    np.testing.assert_array_equal(vector(plant), P)
    assert plant_with(NORMAL, vector(NORMAL)) == NORMAL
    assert plant.head == replace(NORMAL.head, range_scale=0.95)
    assert plant.beta == AxisEncoder(-0.05, 1.8e-3, 1.0, -1.0)
