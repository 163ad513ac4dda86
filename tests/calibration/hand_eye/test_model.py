"""The equations, and every derivative against differences."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.calibration.hand_eye.arms import Wrist
from tests.calibration.hand_eye.scenes import SETUPS, apart, random_poses, scene, seen

from handeye.arrays import Array
from handeye.calibration.hand_eye.links import Links
from handeye.calibration.hand_eye.model import Guess, Model, motions
from handeye.calibration.hand_eye.samples import Samples, Setup
from handeye.calibration.hand_eye.starts import starts
from handeye.calibration.hand_eye.turns import (
    inverse_right_jacobian,
    left_jacobian,
    turn,
    turned_by,
)
from handeye.geometry import invert, make_pose

BOTH = pytest.mark.parametrize("setup", SETUPS)


def differences(f, x: Array, step: float = 1e-6) -> Array:
    """Central differences of f at x, last axis: the component of x."""
    steps = step * np.eye(len(x))
    return np.stack([(f(x + d) - f(x - d)) / (2.0 * step) for d in steps], axis=-1)


def guess(rng: np.random.Generator, n_links: int = 0) -> Guess:
    links = np.tile(np.eye(4), (n_links, 1, 1))
    return Guess(random_poses(rng, 1)[0], random_poses(rng, 1)[0], 1.3, links).moved(
        np.concatenate([np.zeros(12), 0.05 * rng.normal(size=6 * n_links)])
    )


@pytest.mark.parametrize("angle", [0.0, 1e-9, 5e-4, 2e-3, 1.0, 3.0])
def test_jacobians_of_turns(angle: float):
    rng = np.random.default_rng(1)
    v = rng.normal(size=3)
    v *= angle / np.linalg.norm(v)
    # exp(v + d) exp(v)^-1 is the turn J d; log(exp(v) exp(d)) is v + K d.
    J = differences(lambda x: turned_by(turn(x) @ turn(v).T), v)
    np.testing.assert_allclose(left_jacobian(v), J, atol=1e-8)
    K = differences(lambda d: turned_by(turn(v) @ turn(d)), np.zeros(3))
    np.testing.assert_allclose(inverse_right_jacobian(v), K, atol=1e-8)


@BOTH
@pytest.mark.parametrize("free_scale", [False, True])
def test_jacobian_of_the_residuals(setup: Setup, free_scale: bool):
    rng = np.random.default_rng(2)
    samples = Samples.of(random_poses(rng, 6), random_poses(rng, 6), setup, in_order=False)
    model, start = Model(samples, free_scale), guess(rng)
    x = 0.3 * rng.normal(size=model.n_unknowns)
    expected = differences(lambda y: model.residuals(start.moved(y)), x)
    np.testing.assert_allclose(model.jacobian(start, x), expected, atol=2e-8)


@BOTH
def test_jacobian_with_the_errors_of_an_arm(setup: Setup):
    rng = np.random.default_rng(3)
    arm, q = Wrist(), rng.uniform(-1.0, 1.0, (6, 4))
    samples = Samples.of(arm.poses(q), random_poses(rng, 6), setup, in_order=True)
    model, start = Model(samples, False, Links.of(arm, q)), guess(rng, 3)
    x = 0.05 * rng.normal(size=model.n_unknowns)
    expected = differences(lambda y: model.residuals(start.moved(y)), x)
    np.testing.assert_allclose(model.jacobian(start, x), expected, atol=2e-8)


@BOTH
def test_how_an_error_of_the_flange_enters(setup: Setup):
    rng = np.random.default_rng(4)
    A, S = random_poses(rng, 5), random_poses(rng, 5)
    here = guess(rng)

    def residuals(x: Array) -> Array:
        moved = make_pose(turn(x[:3]) @ A[:, :3, :3], A[:, :3, 3] + x[3:])
        return Model(Samples.of(moved, S, setup, in_order=True)).residuals(here)

    found = Model(Samples.of(A, S, setup, in_order=True)).by_flange(here)
    np.testing.assert_allclose(found, differences(residuals, np.zeros(6)), atol=2e-8)


@BOTH
def test_residuals_are_measured_minus_predicted(setup: Setup):
    rng = np.random.default_rng(5)
    there = scene(rng, setup, 6)
    off_turn, off_shift = np.array([0.02, -0.01, 0.03]), np.array([1e-3, 2e-3, -3e-3])
    sensed = make_pose(turn(off_turn) @ there.sensed[:, :3, :3], there.sensed[:, :3, 3] + off_shift)
    samples = Samples.of(there.flanges, sensed, setup, in_order=True)
    camera, target = (there.X, there.Z) if setup == "eye_in_hand" else (there.Z, there.X)
    found = Model(samples).residuals(Guess(camera, target, 1.0, np.zeros((0, 4, 4))))
    np.testing.assert_allclose(found, np.tile(np.r_[off_turn, off_shift], (6, 1)), atol=1e-12)


def test_links_that_depart_are_those_of_a_bent_arm():
    rng = np.random.default_rng(6)
    arm, q = Wrist(), rng.uniform(-1.0, 1.0, (5, 4))
    links = Links.of(arm, q)
    np.testing.assert_allclose(links.flanges(np.tile(np.eye(4), (3, 1, 1))), arm.poses(q))
    # A turn about a joint's own axis is an offset of that joint.
    for i in range(3):
        offset = np.zeros(4)
        offset[i] = 0.01
        departures = np.tile(np.eye(4), (3, 1, 1))
        K = links.frames[i, 0]
        axis = arm.jacobians(q[:1])[0, 3:, i]
        departures[i, :3, :3] = Rotation.from_rotvec(0.01 * K[:3, :3].T @ axis).as_matrix()
        np.testing.assert_allclose(links.flanges(departures), arm.poses(q + offset), atol=1e-12)


def test_steps_of_a_camera_are_samples_with_one_unknown_pose():
    rng = np.random.default_rng(7)
    there = scene(rng, "eye_in_hand", 6)
    steps = motions(Samples.of(there.flanges, there.sensed, "eye_in_hand", in_order=True))
    both = Guess(there.X, there.X, 1.0, np.zeros((0, 4, 4)))
    np.testing.assert_allclose(Model(steps).residuals(both), 0.0, atol=1e-12)


@BOTH
@pytest.mark.parametrize("free_scale", [False, True])
def test_closed_forms_are_exact_without_errors(setup: Setup, free_scale: bool):
    rng = np.random.default_rng(8)
    there = scene(rng, setup, 8)
    sensed = there.sensed.copy()
    sensed[:, :3, 3] *= 1.7 if free_scale else 1.0
    samples = Samples.of(there.flanges, sensed, setup, in_order=False)
    first = starts(samples, free_scale=free_scale, tied=False)[0]
    camera, target = (there.X, there.Z) if setup == "eye_in_hand" else (there.Z, there.X)
    assert max(*apart(first.camera, camera), *apart(first.target, target)) < 1e-9
    assert first.scale == pytest.approx(1.7 if free_scale else 1.0)


def test_three_right_samples_are_found_among_wrong_ones():
    rng = np.random.default_rng(11)
    there = scene(rng, "eye_in_hand", 20)
    sensed = there.sensed.copy()
    sensed[:8] = random_poses(rng, 8)
    samples = Samples.of(there.flanges, sensed, "eye_in_hand", in_order=False)
    first = starts(samples, free_scale=False, tied=False)[0]
    assert max(apart(first.camera, there.X)) < 1e-6


def test_closed_form_of_steps_is_exact():
    rng = np.random.default_rng(9)
    there = scene(rng, "eye_in_hand", 8)
    steps = motions(Samples.of(there.flanges, there.sensed, "eye_in_hand", in_order=True))
    first = starts(steps, free_scale=False, tied=True)[0]
    assert max(apart(first.camera, there.X)) < 1e-9


def test_samples_are_sorted_and_given_back_as_they_came():
    rng = np.random.default_rng(10)
    A, X, Z = random_poses(rng, 7), *random_poses(rng, 2)
    S = seen(A, X, Z, "eye_in_hand")
    samples = Samples.of(A, S, "eye_in_hand", in_order=False)
    other = Samples.of(A[::-1], S[::-1], "eye_in_hand", in_order=False)
    np.testing.assert_array_equal(samples.flanges, other.flanges)
    np.testing.assert_allclose(samples.as_given(samples.flanges), A, atol=1e-15)
    np.testing.assert_allclose(samples.carriers, invert(samples.flanges))
