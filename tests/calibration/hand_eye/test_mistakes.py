"""Poses that were meant in another way are recognised, and those that were not are left alone."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.calibration.hand_eye.arms import Wrist
from tests.calibration.hand_eye.scenes import SETUPS, Scene, noisy, random_poses, scene, seen

from handeye.arrays import Array
from handeye.calibration.hand_eye import solve, solve_arm
from handeye.calibration.hand_eye.samples import Setup
from handeye.geometry import invert, make_pose

BOTH = pytest.mark.parametrize("setup", SETUPS)
AGREE = "the poses would agree if this were a mistake: "


def measured(setup: Setup, seed: int = 0, n: int = 15) -> Scene:
    """Poses of an arm of ordinary size, with 2 mrad and 1 mm of noise."""
    rng = np.random.default_rng(seed)
    there = scene(rng, setup, n)
    return there._replace(sensed=noisy(rng, there.sensed, 2e-3, 1e-3))


def scaled(T: Array, by: float) -> Array:
    return make_pose(T[:, :3, :3], by * T[:, :3, 3])


def read_as(T: Array, *, last: bool) -> Array:
    """Quaternions written with the scalar last, or first, and read the other way."""
    numbers = Rotation.from_matrix(T[:, :3, :3]).as_quat(scalar_first=not last)
    wrong = Rotation.from_quat(numbers, scalar_first=last).as_matrix()
    return make_pose(wrong, T[:, :3, 3])


def transposed(T: Array) -> Array:
    return make_pose(T[:, :3, :3].swapaxes(1, 2), T[:, :3, 3])


MISTAKES = {
    "either the target's poses are T_target_camera": lambda A, S: (A, invert(S)),
    "or the flange's are T_flange_base": lambda A, S: (invert(A), S),
    "the quaternions of the flange were read as w, x, y, z but are x, y, z, w": (
        lambda A, S: (read_as(A, last=True), S)
    ),
    "the quaternions of the target were read as w, x, y, z but are x, y, z, w": (
        lambda A, S: (A, read_as(S, last=True))
    ),
    "the quaternions of flange and target were read as x, y, z, w but are w, x, y, z": (
        lambda A, S: (read_as(A, last=False), read_as(S, last=False))
    ),
    "the rotation matrices of the flange are transposed": lambda A, S: (transposed(A), S),
    "the rotation matrices of the target are transposed": lambda A, S: (A, transposed(S)),
    "each pose of the target belongs to the one of the flange after it": lambda A, S: (
        A[:-1],
        S[1:],
    ),
    "each pose of the target belongs to the one of the flange before it": lambda A, S: (
        A[1:],
        S[:-1],
    ),
    "the target's positions are in millimetres, the flange's in metres": lambda A, S: (
        A,
        scaled(S, 1e3),
    ),
    "the flange's positions are in millimetres": lambda A, S: (scaled(A, 1e3), S),
    "the flange's positions are in inches, the target's in metres": lambda A, S: (
        scaled(A, 39.37),
        S,
    ),
    "the camera's lengths are 1.4 times what they should be": lambda A, S: (A, scaled(S, 1.4)),
    ", and the target's positions are in centimetres": lambda A, S: (A, scaled(invert(S), 1e2)),
}


@pytest.mark.parametrize("said", MISTAKES)
def test_a_mistake_is_named(said: str):
    setup = SETUPS[len(said) % 2]
    there = measured(setup)
    status = solve(*MISTAKES[said](there.flanges, there.sensed), setup=setup).status
    assert status.startswith(AGREE)
    assert said in status.splitlines()[0]


@BOTH
def test_the_other_setup_is_named(setup: Setup):
    there = measured(setup)
    other: Setup = "eye_to_hand" if setup == "eye_in_hand" else "eye_in_hand"
    status = solve(there.flanges, there.sensed, setup=other).status
    assert status.splitlines()[0].endswith(f"or the setup is {setup}")


@BOTH
@pytest.mark.parametrize("noise", [0.0, 1.0, 10.0])
def test_nothing_is_suspected_of_poses_that_agree(setup: Setup, noise: float):
    rng = np.random.default_rng(1)
    there = scene(rng, setup)
    sensed = noisy(rng, there.sensed, noise * 2e-3, noise * 2e-3)
    assert "mistake" not in solve(there.flanges, sensed, setup=setup).status


def test_nothing_is_suspected_where_nothing_agrees():
    rng = np.random.default_rng(2)
    for n in (5, 12):
        assert "mistake" not in solve(random_poses(rng, n), random_poses(rng, n)).status


def test_poses_that_agree_by_half_do_not_agree():
    rng = np.random.default_rng(5)
    there = measured("eye_in_hand")
    # Inverted, and in no place that makes sense: the turns alone would agree.
    sensed = make_pose(invert(there.sensed)[:, :3, :3], rng.normal(size=(15, 3)))
    assert "mistake" not in solve(there.flanges, sensed).status


def test_poses_all_in_millimetres_are_too_far_for_a_hall():
    there = measured("eye_in_hand")
    status = solve(scaled(there.flanges, 1e3), scaled(there.sensed, 1e3)).status
    assert "the flange would move over" in status
    assert "give positions in metres" in status


@BOTH
def test_what_makes_no_pose_disagree_puts_the_camera_far_from_the_flange(setup: Setup):
    rng = np.random.default_rng(3)
    A, X, Z = random_poses(rng, 12), *random_poses(rng, 2, 0.05)
    Z[:3, 3] = [0.7, 0.2, 0.1]
    S = seen(A, X, Z, setup)
    assert solve(A, S, setup=setup).status.startswith("everything is determined")
    asked = "they are T_flange_base and T_target_camera, the inverse of"
    assert asked in solve(invert(A), invert(S), setup=setup).status
    exchanged = solve(S, A, setup=setup)
    if setup == "eye_in_hand":
        assert "either poses of flange and target were exchanged" in exchanged.status
    else:
        # Nothing gives it away: everything is where it was, seen from the other end.
        assert exchanged.status.startswith("everything is determined")
        np.testing.assert_allclose(exchanged.X, invert(X), atol=1e-6)


def test_joints_in_degrees_are_recognised():
    rng = np.random.default_rng(4)
    arm, q = Wrist(), rng.uniform(-1.5, 1.5, (15, 4))
    X, Z = random_poses(rng, 2, 0.1)
    sensed = seen(arm.poses(q), X, Z, "eye_in_hand")
    assert "joints are in degrees" in solve_arm(arm, np.degrees(q), sensed).status
