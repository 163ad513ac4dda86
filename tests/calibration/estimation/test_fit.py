"""Batch estimates: the optimum that scipy finds, and what is said about it."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import least_squares
from tests.calibration.cases import sightings as world_sightings

from handeye.calibration.drift import Thermal
from handeye.calibration.estimation import (
    NAMES,
    THESIS,
    Assumptions,
    Tolerances,
    fit_plant,
)
from handeye.calibration.estimation.gauges import gauges
from handeye.calibration.estimation.kernels import residual_rows
from handeye.calibration.estimation.objectives import sightings
from handeye.calibration.estimation.parameters import indices, vector
from handeye.calibration.world import Region
from handeye.errors import InvalidInput
from handeye.geometry.angles import wrap
from handeye.thesis.plants import LARGE, NOMINAL, NORMAL

LOCAL = Region(
    alpha=(-np.pi / 3 - 0.1, -np.pi / 3 + 0.1),
    beta=(2 * np.pi / 3 - 0.1, 2 * np.pi / 3 + 0.1),
    eccentricity=0.05,
)

TIGHT = {"xtol": 1e-15, "ftol": 1e-15, "gtol": 1e-15, "max_nfev": 2000, "x_scale": "jac"}


def scipys(seen, known):
    """The same problem, written with numpy and solved by scipy."""
    free, nominal = indices(known.free), vector(NOMINAL)
    std = known.tolerances.std()[free]
    range_std = np.hypot(NOMINAL.head.range_std(seen.range, seen.eccentricity), known.range_error)
    bearing_std = np.hypot(NOMINAL.head.eccentricity_std(seen.eccentricity), known.bearing_error)
    data = 2 * len(seen)

    def residuals(x):
        p = nominal.copy()
        p[free] = x
        alpha, beta = seen.joints.T + p[4:6, None]
        dx = p[0] * np.cos(alpha) + p[1] * np.cos(alpha + beta) - p[2]
        dy = p[0] * np.sin(alpha) + p[1] * np.sin(alpha + beta) - p[3]
        along = (seen.range - p[7] * np.hypot(dx, dy)) / range_std
        bearing = seen.pointing + seen.eccentricity + p[6] - np.arctan2(dy, dx)
        return np.concatenate([along, wrap(bearing) / bearing_std, (nominal[free] - x) / std])

    def loss(z):
        # scipy's own loss functions would weigh the priors down as well.
        rho = np.stack([z, np.ones_like(z), np.zeros_like(z)])
        t, s = 1.0 + z[:data], z[:data]
        if known.loss == "soft_l1":
            rho[:, :data] = [2.0 * s / (np.sqrt(t) + 1.0), t**-0.5, -0.5 * t**-1.5]
        if known.loss == "cauchy":
            rho[:, :data] = [np.log1p(s), 1.0 / t, -1.0 / t**2]
        if known.loss == "huber":
            out, root = s > 1.0, np.sqrt(np.maximum(s, 1.0))
            rho[:, :data] = np.where(
                out, [2.0 * root - 1.0, 1.0 / root, -0.5 / root**3], rho[:, :data]
            )
        return rho

    def solve(x, loss, f_scale=1.0):
        # The scale belongs to the data only: the priors are rows without loss.
        return least_squares(residuals, x, jac="3-point", loss=loss, f_scale=f_scale, **TIGHT)

    x = solve(nominal[free], "linear").x
    if known.loss != "squared":
        x = solve(x, loss, known.loss_scale).x
    p = nominal.copy()
    p[free] = x
    return p


@pytest.mark.parametrize("loss", ["squared", "soft_l1", "huber", "cauchy"])
@pytest.mark.parametrize("free", [THESIS, NAMES[:-1], NAMES], ids=len)
@pytest.mark.parametrize("plant", [NORMAL.without_perturbations(), NORMAL], ids=["noise", "all"])
def test_the_optimum_is_the_one_scipy_finds(plant, free, loss):
    seen = world_sightings(plant, 40)
    known = Assumptions(free=free, loss=loss)
    fit = fit_plant(NOMINAL, seen, assumptions=known)
    np.testing.assert_allclose(fit.parameters, scipys(seen, known), rtol=0.0, atol=1e-8)
    np.testing.assert_array_equal(vector(fit.plant), fit.parameters)


@pytest.mark.parametrize("objective", ["forward", "reverse"])
def test_the_thesiss_objectives_identify_a_clean_plant(objective):
    true = NORMAL.without_noise().without_perturbations()
    fit = fit_plant(NOMINAL, world_sightings(true, 10), objective, Assumptions(free=THESIS))
    assert fit.solution.converged
    assert fit.knowledge is None
    np.testing.assert_allclose(fit.parameters, vector(true), rtol=1e-5, atol=1e-9)


def test_noise_free_parameters_are_found_but_for_the_pull_of_the_priors():
    true = LARGE.without_noise().without_perturbations()
    known = Assumptions(free=THESIS)
    fit = fit_plant(NOMINAL.without_noise(), world_sightings(true, 30), assumptions=known)
    assert fit.solution.converged
    np.testing.assert_allclose(fit.parameters, vector(true), rtol=0.0, atol=1e-6)


def test_robust_losses_shrug_off_outliers():
    plant = NORMAL.without_perturbations()
    seen = world_sightings(plant, 200)
    wild = seen.range.copy()
    wild[::10] *= 1.5
    spoilt = replace(seen, range=wild)

    def error(loss, observations):
        known = Assumptions(free=THESIS, loss=loss)
        p = fit_plant(NOMINAL, observations, assumptions=known).parameters
        return np.abs(p - vector(plant)).max()

    plain = error("squared", spoilt)
    assert plain > 10.0 * error("squared", seen)
    for loss in ("soft_l1", "huber", "cauchy"):
        assert error(loss, spoilt) < 0.3 * plain


def test_the_covariance_is_the_inverse_of_the_information():
    seen, known = world_sightings(NORMAL, 50), Assumptions(free=THESIS, loss="squared")
    fit = fit_plant(NOMINAL, seen, assumptions=known)
    rows = sightings(NOMINAL, known, seen)
    values, slopes = np.empty(100), np.empty((100, 8))
    residual_rows(fit.parameters, rows, values, slopes)
    free = indices(THESIS)
    J = np.vstack([slopes[:, free], np.diag(1.0 / known.tolerances.std()[free])])
    assert fit.knowledge is not None
    covariance = fit.knowledge.covariance
    np.testing.assert_allclose(covariance[np.ix_(free, free)], np.linalg.inv(J.T @ J), rtol=1e-8)
    assert not covariance[[4, 7]].any()
    assert not covariance[:, [4, 7]].any()
    np.testing.assert_allclose(fit.knowledge.std**2, np.diag(covariance))
    scaled = J * known.tolerances.std()[free]
    assert fit.knowledge.condition == pytest.approx(np.linalg.cond(scaled), rel=1e-9)


def test_standard_deviations_are_those_of_many_repetitions():
    plant, known = NORMAL.without_perturbations(), Assumptions(free=THESIS)
    fits = [fit_plant(NOMINAL, world_sightings(plant, 60, k), assumptions=known) for k in range(60)]
    free = indices(THESIS)
    errors = np.array([fit.parameters - vector(plant) for fit in fits])[:, free]
    stated = np.array([fit.knowledge.std for fit in fits if fit.knowledge])[:, free].mean(axis=0)
    # 60 repetitions know a standard deviation to one part in eleven.
    np.testing.assert_allclose(np.sqrt(np.mean(errors**2, axis=0)), stated, rtol=0.35)


@pytest.mark.parametrize("replicate", range(3))
def test_gauges_change_no_sighting(replicate):
    p = vector(LARGE)
    seen = world_sightings(NORMAL, 20, replicate)
    rows, free, tolerances = sightings(NOMINAL, Assumptions(), seen), np.arange(8), np.ones(8)
    values, slopes = np.empty(40), np.empty((40, 8))
    residual_rows(p, rows, values, slopes)
    both = gauges(p, free, tolerances)
    assert len(both) == 2
    for gauge in both:
        np.testing.assert_allclose(slopes @ gauge.direction, 0.0, atol=1e-9 * np.abs(slopes).max())
        assert np.linalg.norm(gauge.direction) == pytest.approx(1.0)


def test_a_gauge_needs_all_its_parameters_free():
    def words(*fixed):
        free = indices([name for name in NAMES if name not in fixed])
        found = gauges(vector(LARGE), free, np.ones(len(free)))
        return " ".join(gauge.words.split()[0] for gauge in found)

    assert words() == "turning growing"
    assert words("O_alpha") == "growing"
    assert words("range_scale") == "turning"
    assert words("v_x") == ""


def test_what_everywhere_seen_sightings_do_not_tell_is_the_gauges():
    seen = world_sightings(NORMAL, 200)
    everything = fit_plant(NOMINAL, seen).knowledge
    assert everything is not None
    assert len(everything.undetermined) == 2
    assert everything.undetermined[0].startswith("turning arm, eye and both zeros")
    assert everything.undetermined[1].startswith("growing all lengths")
    assert "harmless" in everything.status
    six = fit_plant(NOMINAL, seen, assumptions=Assumptions(free=THESIS)).knowledge
    assert six is not None
    assert six.undetermined == ()
    assert "every parameter is determined" in six.status


def test_a_localized_region_leaves_a_direction_open_and_says_so():
    # Section 3.6.2: seen through a noisy head, a small region does not tell the links apart.
    world = NORMAL.without_perturbations()
    known = Assumptions(free=THESIS)
    local = fit_plant(NOMINAL, world_sightings(world, 100, region=LOCAL), assumptions=known)
    wide = fit_plant(NOMINAL, world_sightings(world, 100), assumptions=known)
    assert local.knowledge is not None
    assert wide.knowledge is not None
    assert len(local.knowledge.undetermined) == 1
    assert {"a", "b"} <= set(local.knowledge.undetermined[0].split())
    assert "Add poses that spread wider" in local.knowledge.status
    assert local.knowledge.condition > 3.0 * wide.knowledge.condition
    assert (local.knowledge.std[:4] > 3.0 * wide.knowledge.std[:4]).all()


def test_tighter_tolerances_decide_what_sightings_cannot():
    # Lengths 5 % larger and ranges 5 % too short look the same.
    seen = world_sightings(NOMINAL.without_noise().with_range_scale(0.95), 50)
    lengths_known = Assumptions(tolerances=Tolerances(link=1e-4, eye=1e-4, range_scale=0.1))
    scale_known = Assumptions(tolerances=Tolerances(link=0.1, eye=0.1, range_scale=1e-4))
    p = fit_plant(NOMINAL, seen, assumptions=lengths_known).parameters
    np.testing.assert_allclose(p[[0, 1, 2, 7]], [1.0, 1.0, -1.0, 0.95], atol=1e-3)
    p = fit_plant(NOMINAL, seen, assumptions=scale_known).parameters
    np.testing.assert_allclose(p[[0, 1, 2, 7]], [0.95, 0.95, -0.95, 1.0], atol=1e-3)


def test_no_sightings_an_unknown_objective_and_a_drifting_nominal_plant_raise():
    seen = world_sightings(NORMAL, 5)
    with pytest.raises(InvalidInput, match="got none"):
        fit_plant(NOMINAL, seen[:0])
    with pytest.raises(InvalidInput, match="objective"):
        fit_plant(NOMINAL, seen, "backward")  # pyright: ignore[reportArgumentType]
    drifting = Thermal(100)(NOMINAL, np.arange(5))
    with pytest.raises(InvalidInput, match="changes from trial to trial"):
        fit_plant(drifting, seen)
