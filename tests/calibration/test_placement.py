"""Base and marker from sightings: exact, noisy and spoilt ones, and the UR10's."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from tests.calibration.placements import UR10, Planar, random_joints, sightings

from handeye.calibration.placement import Placement, estimate_placement
from handeye.calibration.placement_problem import PlacementProblem
from handeye.calibration.placement_start import base_turn, starts
from handeye.errors import InvalidInput
from handeye.geometry import make_pose, matrix_from_wxyz, wxyz_from_matrix
from handeye.io.convert import convert
from handeye.observations import PointObservation

seeds = st.integers(0, 2**32 - 1).map(np.random.default_rng)


@given(rng=seeds, n=st.sampled_from([6, 12, 60]), marker=st.sampled_from([0.0, 0.2, 1.5]))
def test_exact_sightings_with_orientation_give_back_both_poses(rng, n, marker):
    true, seen = sightings(UR10, random_joints(rng, n), rng, marker=marker)
    fit = estimate_placement(UR10, seen)
    np.testing.assert_allclose(fit.placement.T_sensor_base, true.T_sensor_base, atol=1e-8)
    np.testing.assert_allclose(fit.placement.T_flange_marker, true.T_flange_marker, atol=1e-8)
    np.testing.assert_allclose(fit.residuals, 0.0, atol=1e-9)
    assert fit.orientation_residuals is not None
    np.testing.assert_allclose(fit.orientation_residuals, 0.0, atol=1e-7)
    assert fit.undetermined == ()
    assert fit.status.startswith("base and marker are determined")


@given(rng=seeds, n=st.sampled_from([8, 12, 60]), marker=st.sampled_from([0.0, 0.2, 1.5]))
def test_exact_positions_alone_give_back_base_and_marker_position(rng, n, marker):
    true, seen = sightings(UR10, random_joints(rng, n), rng, oriented=False, marker=marker)
    fit = estimate_placement(UR10, seen)
    np.testing.assert_allclose(fit.placement.T_sensor_base, true.T_sensor_base, atol=1e-7)
    marker_at = fit.placement.T_flange_marker
    np.testing.assert_allclose(marker_at[:3, 3], true.T_flange_marker[:3, 3], atol=1e-7)
    np.testing.assert_array_equal(marker_at[:3, :3], np.eye(3))
    assert fit.orientation_residuals is None


@given(seeds)
def test_prediction_is_the_chain_of_poses_and_residual_is_measured_minus_predicted(rng):
    joints = random_joints(rng, 30)
    _, seen = sightings(UR10, joints, rng, noise=1e-3)
    fit = estimate_placement(UR10, seen)
    chain = fit.placement.T_sensor_base @ UR10.poses(joints) @ fit.placement.T_flange_marker
    predicted = fit.placement.predict(UR10, joints)
    np.testing.assert_allclose(predicted, chain[:, :3, 3], atol=1e-12)
    np.testing.assert_allclose(fit.residuals, seen.position - predicted, atol=1e-12)


@given(rng=seeds, oriented=st.booleans())
def test_a_fifth_of_gross_outliers_does_not_move_the_fit_far(rng, oriented):
    true, seen = sightings(UR10, random_joints(rng, 100), rng, noise=1e-3, oriented=oriented)
    spoilt = seen.position.copy()
    spoilt[:20] += 0.5 * rng.normal(size=(20, 3))
    fit = estimate_placement(UR10, replace(seen, position=spoilt))
    assert np.abs(fit.placement.T_sensor_base - true.T_sensor_base).max() < 3e-3


@given(seeds)
def test_a_few_sharp_rows_outweigh_many_blurred_ones(rng):
    true, seen = sightings(UR10, random_joints(rng, 100), rng, noise=1e-4, oriented=False)
    std = np.where(np.arange(100)[:, None] < 70, 0.05, 1e-4) * np.ones(3)
    blurred = seen.position + np.where(std > 1e-2, std, 0.0) * rng.normal(size=(100, 3))
    weighted = estimate_placement(UR10, replace(seen, position=blurred, position_std=std))
    off = weighted.placement.T_sensor_base - true.T_sensor_base
    assert np.abs(off).max() < 1e-3


@given(seeds)
def test_the_fit_is_a_minimum_of_the_robust_sum(rng):
    _, seen = sightings(UR10, random_joints(rng, 40), rng, noise=2e-3, oriented=False)
    fit = estimate_placement(UR10, seen)
    std = np.median(np.linalg.norm(fit.residuals, axis=1)) / 1.538

    def cost(base, marker):
        shifted = Placement(
            base @ fit.placement.T_sensor_base, fit.placement.T_flange_marker @ marker
        )
        z = (seen.position - shifted.predict(UR10, seen.joints)) / std
        return np.sum(2.0 * (np.sqrt(1.0 + z**2) - 1.0))

    least = cost(np.eye(4), np.eye(4))
    for axis in range(6):
        for step in (1e-3, -1e-3):
            twist = step * np.eye(6)[axis]
            nudge = make_pose(Rotation.from_rotvec(twist[:3]).as_matrix(), twist[3:])
            assert cost(nudge, np.eye(4)) > least
            if axis >= 3:
                assert cost(np.eye(4), nudge) > least


@given(rng=seeds, fixed=st.booleans())
def test_jacobian_equals_central_differences(rng, fixed):
    _, seen = sightings(UR10, random_joints(rng, 5), rng)
    problem = PlacementProblem.of(UR10, seen, fixed=fixed)
    start = (Rotation.random(rng=rng).as_matrix(), 0.0 * rng.normal(size=3))
    x = problem.begin(start) + 0.7 * rng.normal(size=6 if fixed else 9)
    J = problem.jacobian(start, x)
    for i, step in enumerate(1e-6 * np.eye(len(x))):
        ahead, behind = problem.residuals(start, x + step), problem.residuals(start, x - step)
        np.testing.assert_allclose(J[:, :, i], (ahead - behind) / 2e-6, atol=1e-7)


@given(seeds)
def test_turn_from_orientations_is_exact_and_absent_for_one_axis(rng):
    R, Z = Rotation.random(2, rng=rng).as_matrix()
    flanges = Rotation.random(10, rng=rng).as_matrix()
    found = base_turn(flanges, R @ flanges @ Z)
    assert found is not None
    np.testing.assert_allclose(found, R, atol=1e-7)
    one_axis = Rotation.from_rotvec(rng.normal(size=(10, 1)) * rng.normal(size=3)).as_matrix()
    assert base_turn(one_axis, R @ one_axis @ Z) is None


@given(seeds)
def test_of_all_turns_that_lay_a_line_on_a_line_the_smallest_is_the_start(rng):
    R = Rotation.from_rotvec([0.0, 0.0, 0.4]).as_matrix()
    path = rng.normal(size=(10, 1)) * [1.0, 2.0, 0.0]
    line = starts(make_pose(np.eye(3), path), path @ R.T + 1.0, None, fixed=True)
    np.testing.assert_allclose(line[0][0], R, atol=1e-6)


@given(seeds)
def test_orientations_do_not_bend_what_positions_determine(rng):
    _, seen = sightings(UR10, random_joints(rng, 50), rng, noise=1e-3)
    assert seen.orientation is not None
    R = Rotation.from_rotvec(0.05 * rng.normal(size=(50, 3))).as_matrix()
    twisted = wxyz_from_matrix(R @ matrix_from_wxyz(seen.orientation))
    with_them = estimate_placement(UR10, replace(seen, orientation=twisted))
    without = estimate_placement(UR10, replace(seen, orientation=None))
    np.testing.assert_allclose(
        with_them.placement.T_sensor_base, without.placement.T_sensor_base, atol=1e-6
    )


@given(seeds)
def test_planar_arm_with_a_fixed_marker_is_determined(rng):
    true, seen = sightings(Planar(), random_joints(rng, 30, 2), rng, marker=0.0, oriented=False)
    fit = estimate_placement(Planar(), seen, marker="fixed")
    np.testing.assert_allclose(fit.placement.T_sensor_base, true.T_sensor_base, atol=1e-9)
    np.testing.assert_array_equal(fit.placement.T_flange_marker, np.eye(4))
    assert fit.undetermined == ()


def test_rows_that_do_not_fit_the_arm_are_refused():
    rng = np.random.default_rng(9)
    _, seen = sightings(UR10, random_joints(rng, 10), rng)
    with pytest.raises(InvalidInput, match="got none"):
        estimate_placement(UR10, seen[:0])
    with pytest.raises(InvalidInput, match="joints must have shape"):
        estimate_placement(UR10, replace(seen, joints=seen.joints[:, :5]))
    with pytest.raises(InvalidInput, match="position must have shape"):
        estimate_placement(UR10, replace(seen, position=seen.position[:, :2]))
    with pytest.raises(InvalidInput, match="orientation must have shape"):
        estimate_placement(UR10, replace(seen, orientation=np.eye(10, 3)))
    with pytest.raises(InvalidInput, match="finite"):
        estimate_placement(UR10, replace(seen, position=seen.position * np.nan))


@pytest.mark.parametrize("use", ["all", "positions"])
def test_ur10_placement_reaches_what_ordinary_methods_reach(shared_data, use):
    folder = shared_data / "ur10_joint_configurations"
    seen = convert(folder / "measurements_joint_configurations.csv").observations
    assert isinstance(seen, PointObservation)
    if use == "positions":
        seen = replace(seen, orientation=None, position_std=None)
    rows = np.random.default_rng(0).permutation(len(seen))
    fit = estimate_placement(UR10, seen[rows[:1000]])
    test = seen[rows[1000:]]
    off = np.linalg.norm(test.position - fit.placement.predict(UR10, test.joints), axis=1)
    assert off.mean() == pytest.approx(1.04e-3, abs=0.03e-3)
    assert np.sqrt(np.mean(off**2)) == pytest.approx(1.11e-3, abs=0.03e-3)
    assert fit.undetermined == ()
    assert fit.condition < 30.0
    if use == "all":
        assert fit.orientation_residuals is not None
        # Were the angles of the file read in another order, this would be tens of degrees.
        turned = np.degrees(np.linalg.norm(fit.orientation_residuals, axis=1))
        assert np.median(turned) < 0.1
