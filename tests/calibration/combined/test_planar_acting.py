"""Commands of a planar robot: the envelope that they stay in, and what is judged by them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.calibration.combined.robots import CHAIN, stream

from handeye.calibration.combined.planar.acting import act, act_many, judge, missed, nominal_hand
from handeye.calibration.combined.planar.chain import seen_rows
from handeye.calibration.combined.planar.kernels import (
    PARAMETERS,
    planar_command,
    planar_residuals,
)
from handeye.calibration.combined.planar.suggesting import expected_sightings
from handeye.geometry.angles import wrap
from handeye.thesis.plants import NOMINAL

N = len(CHAIN.names)
NOTHING = np.zeros(2)
ROWS = seen_rows(stream(20, plant=NOMINAL))
SEEDS = st.integers(0, 2**32 - 1)


def command(x, seen):
    joints = np.empty(2)
    planar_command(CHAIN.kernel, x, seen, joints)
    return joints


def acted(x, seen, envelope, extra=NOTHING):
    joints = np.empty(2)
    held = act(CHAIN.kernel, x, extra, seen, envelope, joints)
    return joints, held


def hand(joints):
    return np.array(nominal_hand(CHAIN.kernel, *joints))


def a_robot(rng):
    return CHAIN.tolerance * rng.normal(size=N)


def test_the_nominal_hand_is_that_of_the_nominal_plant():
    shifted = CHAIN.kernel._replace(nominal=CHAIN.kernel.nominal + 0.1)
    joints = np.array([0.3, -1.2])
    np.testing.assert_allclose(hand(joints), NOMINAL.tips(joints), atol=1e-12)
    a, b, _, _, o_alpha, o_beta, _, _ = shifted.nominal
    first, both = 0.3 + o_alpha, 0.3 + o_alpha - 1.2 + o_beta
    expected = (a * np.cos(first) + b * np.cos(both), a * np.sin(first) + b * np.sin(both))
    np.testing.assert_allclose(nominal_hand(shifted, *joints), expected, rtol=1e-12)


@given(seed=SEEDS)
def test_inside_the_envelope_it_is_the_learned_command_and_more(seed):
    rng = np.random.default_rng(seed)
    x, extra, seen = a_robot(rng), rng.normal(size=2), ROWS[rng.integers(len(ROWS))]
    joints, held = acted(x, seen, 1e9, extra)
    assert not held
    np.testing.assert_allclose(wrap(joints - command(x, seen) - extra), 0.0, atol=1e-12)
    assert np.all(np.abs(joints) <= np.pi)


@given(seed=SEEDS)
def test_outside_it_goes_part_of_the_way_to_its_edge(seed):
    rng = np.random.default_rng(seed)
    x, seen = a_robot(rng), ROWS[rng.integers(len(ROWS))]
    start = command(np.zeros(N), seen)
    whole = wrap(command(x, seen) - start)
    away = float(np.linalg.norm(hand(start + whole) - hand(start)))
    envelope = 0.5 * away
    joints, held = acted(x, seen, envelope)
    assert held
    went = wrap(joints - start)
    part = went @ whole / (whole @ whole)
    np.testing.assert_allclose(went, part * whole, atol=1e-12)
    assert 0.0 < part < 1.0
    assert np.linalg.norm(hand(joints) - hand(start)) == pytest.approx(envelope, rel=1e-6)
    joints, held = acted(x, seen, 1.000001 * away)
    assert not held
    np.testing.assert_allclose(wrap(joints - start), whole, atol=1e-12)


@pytest.mark.parametrize("place", [0, 1, 7])
def test_a_robot_that_cannot_be_is_answered_with_the_nominal_command(place):
    x = np.zeros(N)
    x[4] = 0.2
    x[place] = -1.01 * CHAIN.kernel.nominal[place]
    for unknowns in (x, np.full(N, np.nan)):
        joints, held = acted(unknowns, ROWS[0], 0.1)
        np.testing.assert_allclose(joints, wrap(command(np.zeros(N), ROWS[0])), atol=1e-12)
        assert not held


def test_a_correction_that_is_no_number_is_left_out():
    joints, _ = acted(np.zeros(N), ROWS[0], 0.1, np.array([0.01, np.nan]))
    np.testing.assert_allclose(joints, wrap(command(np.zeros(N), ROWS[0])), atol=1e-12)


def test_many_are_one_by_one():
    x, extra = a_robot(np.random.default_rng(1)), np.full((len(ROWS), 2), 0.3)
    joints, held = np.empty((len(ROWS), 2)), np.empty(len(ROWS), np.bool_)
    act_many(CHAIN.kernel, x, extra, ROWS, 0.2, joints, held)
    for seen, one, held_one, more in zip(ROWS, joints, held, extra, strict=True):
        expected = acted(x, seen, 0.2, more)
        np.testing.assert_array_equal(one, expected[0])
        assert held_one == expected[1]
    assert held.any()


def test_a_miss_is_the_hand_where_it_was_less_where_the_command_brings_it():
    seen, joints, out = ROWS[3], np.array([0.4, 1.1]), np.empty(2)
    missed(CHAIN.kernel, seen, joints, out)
    np.testing.assert_allclose(out, hand(seen[:2]) - hand(joints), rtol=1e-12)


def test_two_commanders_are_judged_on_the_same_sighting():
    x, seen = a_robot(np.random.default_rng(2)), ROWS[4]
    joints, misses = np.empty((2, 2)), np.empty((2, 2))
    judge(CHAIN.kernel, x, seen, 0.05, joints, misses)
    for k, unknowns in enumerate((np.zeros(N), x)):
        np.testing.assert_array_equal(joints[k], acted(unknowns, seen, 0.05)[0])
        np.testing.assert_allclose(misses[k], hand(seen[:2]) - hand(joints[k]), rtol=1e-12)


@given(seed=SEEDS)
def test_what_would_be_seen_of_the_hand_leaves_no_residual(seed):
    rng = np.random.default_rng(seed)
    x = a_robot(rng)
    m = CHAIN.kernel.n_curve
    pointing = slice(PARAMETERS + 2 * m, PARAMETERS + 3 * m)
    rows = np.zeros((1, 5))
    rows[0, :2], rows[0, 4] = (0.5, 1.3), 0.2
    values, slopes = np.empty(2), np.empty((2, N))
    first_order = np.abs(x[pointing]).sum() * m / CHAIN.kernel.half * np.pi
    for curve, off in ((x[pointing].copy(), first_order * np.abs(x[pointing]).sum()), (0.0, 1e-12)):
        x[pointing] = curve
        expected_sightings(CHAIN.kernel, x, rows)
        planar_residuals(CHAIN.kernel, x, rows[0], 1.0, values, slopes)
        assert abs(values[0]) < 1e-12
        assert abs(values[1]) <= off
