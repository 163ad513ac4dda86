"""What a motion leaves open is named, and the rest is given."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.calibration.hand_eye.scenes import SETUPS, apart, noisy, scene, turned_about

from handeye.arrays import Array
from handeye.calibration.hand_eye import Mounting, solve
from handeye.calibration.hand_eye.samples import Setup
from handeye.errors import InvalidInput
from handeye.geometry import make_pose

BOTH = pytest.mark.parametrize("setup", SETUPS)
NOISE = pytest.mark.parametrize("noise", [0.0, 1.0], ids=["exact", "noisy"])
DIAGONAL = np.array([2.0, -1.0, 2.0]) / 3.0


@BOTH
@NOISE
@pytest.mark.parametrize("axis", [np.array([0.0, 0.0, 1.0]), DIAGONAL], ids=["z", "diagonal"])
def test_turning_about_one_axis_leaves_the_shift_along_it_open(
    setup: Setup, noise: float, axis: Array
):
    rng = np.random.default_rng(1)
    there = scene(rng, setup, turned_about(rng, 15, axis))
    flanges = noisy(rng, there.flanges, noise * 5e-4, noise * 3e-4)
    fit = solve(flanges, noisy(rng, there.sensed, noise * 2e-3, noise * 1e-3), setup=setup)
    assert not fit.determined
    name = "camera" if setup == "eye_in_hand" else "target"
    numbers = "0.00, 0.00, 1.00" if axis[2] == 1.0 else "0.67, -0.33, 0.67"
    assert fit.undetermined == (f"translation of the {name} along ({numbers}) of the flange",)
    assert f"turns about its axis ({numbers}) only: add poses that turn it about another" in (
        fit.status
    )
    # What is determined is right, and what is not is where the flange is.
    off = fit.X[:3, 3] - there.X[:3, 3]
    assert np.linalg.norm(off - axis * (axis @ off)) < 1e-6 + 5e-3 * noise
    assert apart(fit.X, there.X)[0] < 1e-6 + 5e-3 * noise
    assert abs(axis @ fit.X[:3, 3]) < 1e-6 + 2e-3 * noise
    along = np.concatenate([np.zeros(3), axis])
    assert along @ fit.covariance[:6, :6] @ along == pytest.approx(1.0, rel=0.01)
    np.testing.assert_allclose(fit.predict(there.flanges), there.sensed, atol=1e-6 + 0.01 * noise)


@BOTH
@NOISE
def test_a_flange_that_does_not_turn_leaves_every_shift_open(setup: Setup, noise: float):
    rng = np.random.default_rng(2)
    R = Rotation.random(rng=rng).as_matrix()
    there = scene(rng, setup, make_pose(R, rng.normal(size=(15, 3)) * 0.2))
    flanges = noisy(rng, there.flanges, noise * 5e-4, noise * 3e-4)
    fit = solve(flanges, noisy(rng, there.sensed, noise * 2e-3, noise * 1e-3), setup=setup)
    name = "camera" if setup == "eye_in_hand" else "target"
    assert fit.undetermined == (f"translation of the {name} in any direction",)
    assert "the flange does not turn: add poses" in fit.status
    assert apart(fit.X, there.X)[0] < 1e-6 + 1e-2 * noise
    assert np.linalg.norm(fit.X[:3, 3]) < 1e-5 + 0.01 * noise


@BOTH
def test_a_flange_that_moves_along_a_line_leaves_a_turn_about_it_open(setup: Setup):
    rng = np.random.default_rng(3)
    line = np.linspace(-0.3, 0.3, 12)[:, None] * DIAGONAL
    there = scene(rng, setup, make_pose(np.eye(3), line))
    fit = solve(there.flanges, there.sensed, setup=setup)
    turn, shift = fit.undetermined
    name = "camera" if setup == "eye_in_hand" else "target"
    assert turn == f"orientation of the {name} about (0.67, -0.33, 0.67) of the flange"
    assert shift == f"translation of the {name} in any direction"
    np.testing.assert_allclose(fit.predict(there.flanges), there.sensed, atol=1e-6)


def test_a_flange_that_stands_still_determines_nothing():
    rng = np.random.default_rng(4)
    there = scene(rng, "eye_in_hand", np.tile(np.eye(4), (6, 1, 1)))
    fit = solve(there.flanges, noisy(rng, there.sensed, 1e-3, 1e-3))
    assert fit.undetermined == (
        "orientation of the camera in every way",
        "translation of the camera in any direction",
    )


def test_what_is_open_follows_the_expected_mounting():
    rng = np.random.default_rng(5)
    axis = np.array([0.0, 1.0, 0.0])
    there = scene(rng, "eye_in_hand", turned_about(rng, 15, axis))
    expected = there.X.copy()
    expected[:3, 3] += np.array([0.02, 0.01, -0.02])
    mounting = Mounting(expected, turn_std=0.1, position_std=0.03)
    fit = solve(there.flanges, there.sensed, mounting=mounting)
    np.testing.assert_allclose(fit.X[:3, 3], there.X[:3, 3] + 0.01 * axis, atol=1e-5)
    assert fit.std[4] == pytest.approx(0.03, rel=1e-3)
    assert "0.03 m and 5.73 degrees" in fit.status
    # Where the samples decide, the mounting does not.
    general = scene(rng, "eye_in_hand", 12)
    fit = solve(general.flanges, general.sensed, mounting=mounting)
    assert max(apart(fit.X, general.X)) < 1e-7


def test_a_scale_needs_motion():
    rng = np.random.default_rng(6)
    turns = Rotation.random(10, rng=rng).as_matrix()
    # The flange only turns: without a shift of known length nothing is in metres.
    there = scene(rng, "eye_in_hand", make_pose(turns, np.zeros(3)))
    fit = solve(there.flanges, there.sensed, free_scale=True)
    assert "the scale of what the camera measures" in fit.undetermined


def test_few_poses_are_told_from_many():
    rng = np.random.default_rng(7)
    there = scene(rng, "eye_in_hand", 4)
    assert "4 poses leave little to check them with" in solve(there.flanges, there.sensed).status
    there = scene(rng, "eye_in_hand", 12)
    assert "\n" not in solve(there.flanges, there.sensed).status


@pytest.mark.parametrize(
    "given", [{"turn_std": 0.0}, {"position_std": -1.0}, {"pose": np.zeros((4, 4))}]
)
def test_mountings_that_are_none_are_refused(given: dict[str, float]):
    with pytest.raises(InvalidInput):
        Mounting(**given)  # pyright: ignore[reportArgumentType]
