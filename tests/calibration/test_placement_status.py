"""What a placement says of sightings that leave something open or cannot be right."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.calibration.placements import UR10, Planar, random_joints, sightings

from handeye.calibration.placement import estimate_placement

seeds = st.integers(0, 2**32 - 1).map(np.random.default_rng)


@given(rng=seeds, noise=st.sampled_from([0.0, 1e-3]))
def test_planar_arm_leaves_the_free_marker_open_along_its_axis(rng, noise):
    true, seen = sightings(
        Planar(), random_joints(rng, 60, 2), rng, noise=noise, oriented=False, marker=0.1
    )
    fit = estimate_placement(Planar(), seen)
    marker = fit.placement.T_flange_marker[:3, 3]
    np.testing.assert_allclose(
        marker[:2], true.T_flange_marker[:2, 3], atol=1e-7 if noise == 0.0 else 5e-3
    )
    assert abs(marker[2]) < 1e-6
    assert fit.undetermined == (
        "the position of the base together with the position of the marker",
    )
    assert "turns about one axis only" in fit.status
    assert fit.condition == np.inf
    assert np.linalg.norm(fit.residuals, axis=1).max() < 10.0 * noise + 1e-9


def moving_only(rng, *joints, n=50):
    q = np.tile(random_joints(rng, 1), (n, 1))
    q[:, list(joints)] = rng.uniform(-2.0, 2.0, (n, len(joints)))
    return q


@pytest.mark.parametrize("oriented", [True, False])
@pytest.mark.parametrize(
    ("joints", "said"),
    [
        ((), "neither turns nor moves"),
        ((0,), "turns about one axis only"),
        ((5,), "turns about one axis only"),
        ((1, 2, 3), "turns about one axis only"),
    ],
    ids=["none", "first", "last", "parallel"],
)
def test_joints_that_stand_still_are_named_as_what_is_missing(joints, said, oriented):
    rng = np.random.default_rng(3)
    _, seen = sightings(UR10, moving_only(rng, *joints), rng, noise=1e-3, oriented=oriented)
    fit = estimate_placement(UR10, seen)
    assert fit.undetermined
    assert said in fit.status
    assert "the arm does not explain the log" not in fit.status
    # What is left open must not run away.
    assert np.linalg.norm(fit.placement.T_flange_marker[:3, 3]) < 1.0
    assert np.linalg.norm(fit.residuals, axis=1).max() < 6e-3


def test_encoder_noise_of_a_joint_that_stands_still_is_not_taken_for_motion():
    rng = np.random.default_rng(4)
    joints = moving_only(rng, 0) + 1e-4 * rng.normal(size=(50, 6))
    _, seen = sightings(UR10, joints, rng, noise=1e-3)
    fit = estimate_placement(UR10, seen)
    assert fit.undetermined
    assert "turns about one axis only" in fit.status
    assert np.linalg.norm(fit.placement.T_flange_marker[:3, 3]) < 1.0


@pytest.mark.parametrize("n", [1, 2])
def test_too_few_rows_are_said_to_be_too_few(n):
    rng = np.random.default_rng(5)
    _, seen = sightings(UR10, random_joints(rng, n), rng)
    fit = estimate_placement(UR10, seen)
    assert fit.undetermined
    assert "add rows" in fit.status


def test_rows_that_leave_nothing_to_check_are_said_to():
    rng = np.random.default_rng(6)
    _, seen = sightings(UR10, random_joints(rng, 4), rng)
    assert "leave next to nothing to check them with" in estimate_placement(UR10, seen).status


def test_a_log_of_another_arm_is_doubted():
    rng = np.random.default_rng(7)
    joints = random_joints(rng, 100)
    _, seen = sightings(UR10, joints[:, ::-1], rng)
    fit = estimate_placement(UR10, replace(seen, joints=joints))
    assert "the arm does not explain the log" in fit.status


def test_quaternions_in_the_wrong_order_are_doubted_but_do_no_harm():
    rng = np.random.default_rng(8)
    true, seen = sightings(UR10, random_joints(rng, 100), rng, noise=1e-4)
    assert seen.orientation is not None
    xyzw = np.roll(seen.orientation, -1, axis=1)
    fit = estimate_placement(UR10, replace(seen, orientation=xyzw))
    assert "w first" in fit.status
    np.testing.assert_allclose(fit.placement.T_sensor_base, true.T_sensor_base, atol=1e-3)
