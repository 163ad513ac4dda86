"""Whether stated uncertainties, influences and noise are what they say."""

import numpy as np
import pytest
from tests.calibration.hand_eye.arms import Wrist
from tests.calibration.hand_eye.scenes import SETUPS, apart, noisy, random_poses, scene, seen

from handeye.calibration.hand_eye import Tolerances, solve, solve_arm
from handeye.calibration.hand_eye.links import Links
from handeye.calibration.hand_eye.model import Guess, Model
from handeye.calibration.hand_eye.refinement import Refinement
from handeye.calibration.hand_eye.samples import Samples, Setup
from handeye.calibration.hand_eye.turns import turned_by
from handeye.errors import InvalidInput
from handeye.geometry import make_pose

BOTH = pytest.mark.parametrize("setup", SETUPS)


def deviations(found, right):
    """Turn and shift (6,) from the right pose to the found one, as the covariance counts them."""
    turn = turned_by(found[:3, :3] @ right[:3, :3].T)
    return np.concatenate([turn, found[:3, 3] - right[:3, 3]])


@BOTH
def test_errors_are_as_large_as_the_covariance_says(setup: Setup):
    rng = np.random.default_rng(1)
    squares: list[float] = []
    for _ in range(8):
        there = scene(rng, setup, 20)
        A = noisy(rng, there.flanges, 5e-4, 3e-4)
        fit = solve(A, noisy(rng, there.sensed, 2e-3, 1e-3), setup=setup)
        d = np.concatenate([deviations(fit.X, there.X), deviations(fit.Z, there.Z)])
        squares.append(float(d @ np.linalg.solve(fit.covariance, d)) / 12.0)
    # The mean of 96 squares of standard normal numbers scatters by 0.15; noise that is estimated
    # from 120 numbers widens it.
    assert 0.55 < np.mean(squares) < 1.6


def test_noise_of_the_camera_is_found_by_axis():
    rng = np.random.default_rng(2)
    there = scene(rng, "eye_in_hand", 150)
    sensed = noisy(rng, there.sensed, 2e-3, 1e-3)
    sensed[:, 2, 3] += rng.normal(size=150) * 3e-3
    fit = solve(there.flanges, sensed)
    np.testing.assert_allclose(fit.noise.camera_position, [1e-3, 1e-3, 3.16e-3], rtol=0.2)
    assert fit.noise.flange_turn < 3e-4
    np.testing.assert_allclose(fit.noise.camera_turn, 2e-3, rtol=0.2)


def test_noise_of_the_arm_is_told_from_the_camera_by_its_lever():
    rng = np.random.default_rng(3)
    there = scene(rng, "eye_in_hand", random_poses(rng, 150, 1.0))
    fit = solve(noisy(rng, there.flanges, 2e-3, 1e-7), noisy(rng, there.sensed, 2e-4, 2e-4))
    assert fit.noise.flange_turn == pytest.approx(2e-3, rel=0.15)
    assert np.all(fit.noise.camera_turn < 1e-3)
    np.testing.assert_allclose(np.std(fit.normalised, axis=0), 1.0, atol=0.25)


@BOTH
def test_influence_is_what_leaving_a_sample_out_changes(setup: Setup):
    rng = np.random.default_rng(4)
    there = scene(rng, setup, 25)
    sensed = noisy(rng, there.sensed, 2e-3, 1e-3)
    fit = solve(there.flanges, sensed, setup=setup)
    most = int(np.argmax(fit.influence))
    rest = np.arange(25) != most
    without = solve(there.flanges[rest], sensed[rest], setup=setup)
    d = np.concatenate([deviations(without.X, fit.X), deviations(without.Z, fit.Z)])
    moved = np.sqrt(d @ np.linalg.solve(fit.covariance, d) / 12.0)
    assert fit.influence[most] == pytest.approx(moved, rel=0.5)


@BOTH
def test_an_arm_that_was_built_wrong_is_mended(setup: Setup):
    rng = np.random.default_rng(5)
    built, nominal = Wrist(rng.normal(size=(4, 6)) * np.repeat([3e-3, 1e-3], 3)), Wrist()
    q = rng.uniform(-1.5, 1.5, (40, 4))
    X, Z = random_poses(rng, 2, 0.1)
    sensed = noisy(rng, seen(built.poses(q), X, Z, setup), 5e-4, 3e-4)
    mended = solve_arm(nominal, q, sensed, setup=setup)
    rigid = solve(nominal.poses(q), sensed, setup=setup)
    assert mended.determined
    by_arm, by_frames = (np.abs(fit.residuals[:, 3:]).mean() for fit in (mended, rigid))
    assert by_arm < 0.4 * by_frames
    # Also where it has not been.
    other = rng.uniform(-1.5, 1.5, (40, 4))
    expected = seen(built.poses(other), X, Z, setup)[:, :3, 3]
    off = mended.predict(mended.flanges(nominal, other))[:, :3, 3] - expected
    off_rigid = rigid.predict(nominal.poses(other))[:, :3, 3] - expected
    assert np.abs(off).mean() < 0.4 * np.abs(off_rigid).mean()
    np.testing.assert_array_equal(rigid.flanges(nominal, other), nominal.poses(other))


def test_three_poses_cannot_do_without_one_of_them():
    there = scene(np.random.default_rng(9), "eye_in_hand", 3)
    assert np.all(np.isinf(solve(there.flanges, there.sensed).influence))


def test_an_arm_without_errors_stays_as_it_is():
    rng = np.random.default_rng(6)
    arm, q = Wrist(), rng.uniform(-1.5, 1.5, (25, 4))
    X, Z = random_poses(rng, 2, 0.1)
    fit = solve_arm(arm, q, seen(arm.poses(q), X, Z, "eye_in_hand"))
    assert max(apart(fit.X, X)) < 1e-5
    assert fit.links is not None
    np.testing.assert_allclose(fit.links, np.tile(np.eye(4), (3, 1, 1)), atol=1e-5)
    shuffled = rng.permutation(25)
    sensed = noisy(rng, seen(arm.poses(q), X, Z, "eye_in_hand"), 1e-3, 1e-3)
    one, other = solve_arm(arm, q, sensed), solve_arm(arm, q[shuffled], sensed[shuffled])
    np.testing.assert_array_equal(one.X, other.X)
    np.testing.assert_array_equal(one.residuals[shuffled], other.residuals)


def test_bad_joints_and_tolerances_are_refused():
    arm = Wrist()
    S = random_poses(np.random.default_rng(7), 5)
    with pytest.raises(InvalidInput, match="joints must have shape"):
        solve_arm(arm, np.zeros((5, 3)), S)
    with pytest.raises(InvalidInput, match="pair up"):
        solve_arm(arm, np.zeros((4, 4)), S)
    for given in ({"angle": 0.0}, {"length": -1.0}):
        with pytest.raises(InvalidInput):
            Tolerances(**given)


def test_millimetres_or_metres_give_the_same():
    rng = np.random.default_rng(8)
    there = scene(rng, "eye_in_hand", 20)
    sensed = noisy(rng, there.sensed, 2e-3, 1e-3)
    in_millimetres = make_pose(sensed[:, :3, :3], 1e3 * sensed[:, :3, 3])
    one = solve(there.flanges, sensed, free_scale=True)
    other = solve(there.flanges, in_millimetres, free_scale=True)
    assert other.scale == pytest.approx(1e3 * one.scale, rel=1e-4)
    np.testing.assert_allclose(other.X, one.X, atol=1e-4)


@pytest.mark.parametrize(("times", "least", "most"), [(0.0, 0.49, 0.9), (6.0, 2.0, 8.0)])
def test_tolerances_follow_the_arm(times: float, least: float, most: float):
    rng = np.random.default_rng(10)
    stated = Tolerances(1e-3, 5e-4)
    errors = times * rng.normal(size=(4, 6)) * np.repeat([stated.angle, stated.length], 3)
    q = rng.uniform(-1.5, 1.5, (60, 4))
    X, Z = random_poses(rng, 2, 0.1)
    sensed = noisy(rng, seen(Wrist(errors).poses(q), X, Z, "eye_in_hand"), 2e-4, 1e-4)
    samples = Samples.of(Wrist().poses(q), sensed, "eye_in_hand", in_order=True)
    refinement = Refinement(Model(samples, links=Links.of(Wrist(), q)), stated)
    found = refinement.fit(Guess(X, Z, 1.0, np.tile(np.eye(4), (3, 1, 1)))).tolerances
    # The stated ones count as one link beside the three that were seen.
    for name in ("angle", "length"):
        assert least < getattr(found, name) / getattr(stated, name) < most
