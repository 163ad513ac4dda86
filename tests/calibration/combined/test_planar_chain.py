"""The planar chain: derivatives, inverse, and the nominal robot as a special case."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.calibration.combined.robots import CHAIN, MODEL, stream

from handeye.calibration.combined import DataSheet, Informed, floor
from handeye.calibration.combined.planar.chain import seen_rows, target_rows
from handeye.calibration.combined.planar.curves import curve_std, legendre, sine_slope, sine_terms
from handeye.calibration.combined.planar.kernels import (
    planar_command,
    planar_reach,
    planar_residuals,
)
from handeye.calibration.combined.planar.suggesting import expected_sightings
from handeye.calibration.engine.chain import Chain, Group
from handeye.calibration.session import WorldStreams, position_errors
from handeye.calibration.world import PlanarWorld
from handeye.errors import InvalidInput
from handeye.geometry.angles import wrap
from handeye.thesis.plants import LARGE, NOMINAL, NORMAL

N = len(CHAIN.names)
SEEDS = st.integers(0, 2**32 - 1)
DOUBT = 1e-4


def residuals(x, seen, doubt=DOUBT):
    values, slopes = np.empty(2), np.empty((2, N))
    planar_residuals(CHAIN.kernel, x, seen, doubt, values, slopes)
    return values, slopes


def a_robot(rng):
    """Unknowns as far from nominal as the data sheet lets expect."""
    return CHAIN.tolerance * rng.normal(size=N)


def sightings(x, rng, n=1):
    """What the robot x sees of its hand without noise, at poses where it is not at the eye."""
    rows = np.zeros((n, 5))
    rows[:, 0] = rng.uniform(-2.5, 2.5, n)
    rows[:, 1] = rng.uniform(0.4, 2.4, n) * rng.choice([-1.0, 1.0], n)
    rows[:, 4] = rng.uniform(-0.5, 0.5, n)
    expected_sightings(CHAIN.kernel, x, rows)
    return rows[rows[:, 3] > 0.3]


@given(seed=SEEDS)
def test_derivatives_are_those_of_differences(seed):
    rng = np.random.default_rng(seed)
    x = a_robot(rng)
    for seen in sightings(x, rng):
        # Slopes leave out that standard deviations change with range: a large doubt keeps them.
        steps = 1e-6 * CHAIN.tolerance
        for j in range(N):
            moved = np.zeros(N)
            moved[j] = steps[j]
            up, down = residuals(x + moved, seen, 1e3)[0], residuals(x - moved, seen, 1e3)[0]
            expected = (up - down) / (2.0 * steps[j])
            np.testing.assert_allclose(residuals(x, seen, 1e3)[1][:, j], expected, atol=1e-7)


@given(seed=SEEDS)
def test_commands_undo_every_stage(seed):
    rng = np.random.default_rng(seed)
    x = a_robot(rng)
    for seen in sightings(x, rng):
        for _ in range(20):  # `expected_sightings` undoes the pointing curve to first order only
            seen[2] -= residuals(x, seen, 1.0)[0][1]
        assert np.abs(residuals(x, seen, 1.0)[0]).max() < 1e-12
        joints = np.empty(2)
        planar_command(CHAIN.kernel, x, seen, joints)
        np.testing.assert_allclose(wrap(joints - seen[:2]), 0.0, atol=1e-8)


@given(seed=SEEDS)
def test_reach_turns_residuals_into_metres(seed):
    rng = np.random.default_rng(seed)
    x = np.zeros(N)
    for seen in sightings(x, rng):
        metres, tip = np.empty((2, 2)), NOMINAL.tips(seen[:2])
        planar_reach(CHAIN.kernel, x, seen, 1e-3, metres)
        moved = seen.copy()
        moved[:2] += 1e-6 * rng.normal(size=2)
        change = residuals(x, moved, 1e-3)[0] - residuals(x, seen, 1e-3)[0]
        expected = NOMINAL.tips(moved[:2]) - tip
        np.testing.assert_allclose(-metres @ change, expected, rtol=0.02, atol=2e-8)


def test_reach_allows_for_the_range_scale():
    x, metres = np.zeros(N), np.empty((2, 2))
    x[7] = 0.25
    (seen,) = sightings(x, np.random.default_rng(1))
    planar_reach(CHAIN.kernel, x, seen, DOUBT, metres)
    d = seen[3] / 1.25
    range_std = -d / residuals(x, seen)[1][0, 7]
    assert np.hypot(*metres[:, 0]) == pytest.approx(range_std / 1.25, rel=1e-12)


def test_a_turn_more_of_the_eye_changes_no_residual():
    for seen in sightings(np.zeros(N), np.random.default_rng(2), 20):
        turned = seen + np.array([0.0, 0.0, 2.0 * np.pi, 0.0, 0.0])
        np.testing.assert_allclose(
            residuals(np.zeros(N), turned)[0], residuals(np.zeros(N), seen)[0], atol=1e-8
        )


def test_a_hand_at_the_eye_has_finite_residuals_and_slopes():
    nominal = CHAIN.kernel.nominal.copy()
    nominal[2:7] = (nominal[0] + nominal[1], 0.0, 0.0, 0.0, 0.0)
    values, slopes = np.empty(2), np.empty((2, N))
    stretched = np.array([0.0, 0.0, 0.1, 0.2, 0.0])
    kernel = CHAIN.kernel._replace(nominal=nominal)
    planar_residuals(kernel, np.zeros(N), stretched, DOUBT, values, slopes)
    assert np.isfinite(values).all()
    assert np.isfinite(slopes).all()


def test_with_nothing_learned_it_is_the_nominal_robot():
    seen = stream(50)
    joints = np.empty((50, 2))
    for i, row in enumerate(target_rows(seen.target)):
        planar_command(CHAIN.kernel, np.zeros(N), row, joints[i])
    np.testing.assert_allclose(joints, NOMINAL.joints_for(seen.target), atol=1e-9)


def test_noise_is_that_of_the_nominal_head():
    seen = stream(1, plant=NOMINAL)[0]
    row = seen_rows(seen)
    values, slopes = residuals(np.zeros(N), row, 1e-12)
    tip = NOMINAL.tips(seen.joints) - np.array([NOMINAL.v_x, NOMINAL.v_y])
    d = np.hypot(*tip)
    assert slopes[0, 7] == pytest.approx(-d / NOMINAL.head.range_std(d, row[4]))
    assert slopes[1, 6] == pytest.approx(1.0 / NOMINAL.head.eccentricity_std(row[4]))
    assert values[0] == pytest.approx((row[3] - d) / NOMINAL.head.range_std(d, row[4]))


def test_sine_terms_are_sines():
    terms = np.empty(16)
    x = np.linspace(-3.9, 3.9, 41)
    weights = np.random.default_rng(0).normal(size=16)
    for at in x:
        sine_terms(at, 4.0, terms)
        k = np.arange(1, 17)
        np.testing.assert_allclose(terms, np.sin(k * np.pi * (at + 4.0) / 8.0), atol=1e-12)
        value, slope = sine_slope(at, 4.0, weights)
        up, down = sine_slope(at + 1e-6, 4.0, weights)[0], sine_slope(at - 1e-6, 4.0, weights)[0]
        assert value == pytest.approx(terms @ weights)
        assert slope == pytest.approx((up - down) / 2e-6, abs=1e-6)


def test_curve_priors_have_the_kernel_of_their_process():
    half, length = 4.0, 0.7
    std = curve_std(40, half, ((2.0, length),))
    x = np.linspace(-2.0, 2.0, 9)
    phi = np.sin(np.arange(1, 41) * np.pi * (x[:, np.newaxis] + half) / (2.0 * half))
    kernel = 4.0 * np.exp(-0.5 * (x[:, np.newaxis] - x) ** 2 / length**2)
    np.testing.assert_allclose((phi * std**2) @ phi.T, kernel, atol=1e-3)


def test_legendre_polynomials_and_slopes():
    value, slope = np.empty(7), np.empty(7)
    for x in (-1.0, -0.3, 0.0, 0.8):
        legendre(x, value, slope)
        for k in range(7):
            p = np.polynomial.legendre.Legendre.basis(k)
            assert value[k] == pytest.approx(p(x), abs=1e-12)
            assert slope[k] == pytest.approx(p.deriv()(x), abs=1e-12)
    legendre(5.0, value, slope)
    edge = value.copy()
    legendre(50.0, value, slope)
    np.testing.assert_array_equal(value, edge)
    assert not slope.any()


@pytest.mark.parametrize("plant", [NORMAL, LARGE], ids=["normal", "large"])
def test_the_informed_command_is_exact_without_noise(plant):
    world = PlanarWorld(plant.without_noise())
    assert floor(world, 0, WorldStreams.of(0), 200).max() < 1e-9


def test_the_floor_is_what_position_errors_gives_the_informed():
    world = PlanarWorld(NORMAL)
    (errors,) = position_errors(world, [Informed(NORMAL)], 0, WorldStreams.of(2), 100)
    lengths = floor(world, 0, WorldStreams.of(2), 100)
    np.testing.assert_array_equal(lengths, np.linalg.norm(errors, axis=1))
    assert 0.006 < lengths.mean() < 0.011
    seen = stream(5)
    np.testing.assert_allclose(
        Informed(NORMAL).errors(seen), Informed(NORMAL).observe_many(seen).error
    )


def test_a_chain_must_fit_together():
    fields = {name: getattr(CHAIN, name) for name in CHAIN.__dataclass_fields__}
    for wrong in (
        {"tolerance": -CHAIN.tolerance},
        {"units": ("m",)},
        {"groups": (Group("half", (0, 1)),)},
        {"changes": (Group("none", ()),)},
    ):
        with pytest.raises(InvalidInput):
            Chain(**{**fields, **wrong})


def test_a_data_sheet_has_positive_numbers():
    with pytest.raises(InvalidInput, match="lens"):
        DataSheet(lens=0.0)
    assert MODEL.nominal is NOMINAL
