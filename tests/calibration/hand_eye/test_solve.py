import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.calibration.hand_eye.scenes import (
    SETUPS,
    apart,
    noisy,
    random_poses,
    scene,
)

from handeye.arrays import Array
from handeye.calibration.hand_eye import solve
from handeye.calibration.hand_eye.samples import Setup
from handeye.errors import InvalidInput
from handeye.geometry import invert, make_pose

BOTH = pytest.mark.parametrize("setup", SETUPS)


@settings(max_examples=8, deadline=None)
@given(seed=st.integers(0, 10_000), n=st.integers(3, 15), setup=st.sampled_from(SETUPS))
def test_poses_without_errors_are_recovered(seed: int, n: int, setup: Setup):
    there = scene(np.random.default_rng(seed), setup, n)
    fit = solve(there.flanges, there.sensed, setup=setup)
    assert fit.determined, fit.status
    # Three poses may by chance turn little about a second axis.
    tolerance = 1e-4 if n == 3 else 1e-7
    assert max(*apart(fit.X, there.X), *apart(fit.Z, there.Z)) < tolerance


@BOTH
def test_named_frames_and_prediction(setup: Setup):
    there = scene(np.random.default_rng(1), setup)
    fit = solve(there.flanges, there.sensed, setup=setup)
    if setup == "eye_in_hand":
        assert fit.T_flange_camera is fit.X
        assert fit.T_base_target is fit.Z
    else:
        assert fit.T_flange_target is fit.X
        assert fit.T_base_camera is fit.Z
    wrong = "T_base_camera" if setup == "eye_in_hand" else "T_flange_camera"
    with pytest.raises(InvalidInput, match="use T_"):
        getattr(fit, wrong)
    np.testing.assert_allclose(fit.predict(there.flanges), there.sensed, atol=1e-9)


@BOTH
def test_order_of_samples_does_not_matter(setup: Setup):
    rng = np.random.default_rng(2)
    there = scene(rng, setup, 15)
    sensed = noisy(rng, there.sensed, 2e-3, 1e-3)
    sensed[4] = random_poses(rng, 1)[0]
    shuffled = rng.permutation(15)
    one = solve(there.flanges, sensed, setup=setup)
    other = solve(there.flanges[shuffled], sensed[shuffled], setup=setup)
    np.testing.assert_array_equal(one.X, other.X)
    np.testing.assert_array_equal(one.residuals[shuffled], other.residuals)
    np.testing.assert_array_equal(one.influence[shuffled], other.influence)
    assert list(one.outliers) == [4]
    assert list(shuffled[other.outliers]) == [4]


@BOTH
def test_another_base_frame_moves_only_what_is_in_the_base(setup: Setup):
    rng = np.random.default_rng(3)
    there = scene(rng, setup, 15)
    sensed = noisy(rng, there.sensed, 2e-3, 1e-3)
    moved = random_poses(rng, 1)[0]
    one = solve(there.flanges, sensed, setup=setup)
    other = solve(moved @ there.flanges, sensed, setup=setup)
    np.testing.assert_allclose(other.X, one.X, atol=2e-5)
    np.testing.assert_allclose(other.Z, moved @ one.Z, atol=2e-5)


@BOTH
def test_another_flange_frame_moves_only_what_is_on_the_flange(setup: Setup):
    rng = np.random.default_rng(4)
    there = scene(rng, setup, 15)
    sensed = noisy(rng, there.sensed, 2e-3, 1e-3)
    # A turn only: errors of the flange's position mean another thing at another origin.
    moved = make_pose(random_poses(rng, 1)[0, :3, :3], np.zeros(3))
    one = solve(there.flanges, sensed, setup=setup)
    other = solve(there.flanges @ moved, sensed, setup=setup)
    np.testing.assert_allclose(other.X, invert(moved) @ one.X, atol=2e-5)
    np.testing.assert_allclose(other.Z, one.Z, atol=2e-5)


@BOTH
def test_a_camera_that_knows_no_metres(setup: Setup):
    rng = np.random.default_rng(5)
    there = scene(rng, setup, 15)
    sensed = there.sensed.copy()
    sensed[:, :3, 3] *= 2.5
    fit = solve(there.flanges, sensed, setup=setup, free_scale=True)
    assert fit.scale == pytest.approx(2.5, abs=1e-6)
    assert max(apart(fit.X, there.X)) < 1e-6
    known = solve(there.flanges, there.sensed, setup=setup)
    assert (known.scale, known.scale_std) == (1.0, 0.0)


def counting(rng: np.random.Generator, sensed: Array) -> Array:
    """What a camera senses that adds up its steps, each with 2 mrad and 1 mm."""
    T = invert(sensed)
    out = T.copy()
    for k in range(1, len(T)):
        out[k] = out[k - 1] @ noisy(rng, (invert(T[k - 1]) @ T[k])[None], 2e-3, 1e-3)[0]
    return invert(out)


def test_a_camera_that_counts_its_way():
    rng = np.random.default_rng(6)
    errors: list[tuple[float, float]] = []
    for _ in range(2):
        there = scene(rng, "eye_in_hand", 40)
        sensed = counting(rng, there.sensed)
        counted, at_once = solve(there.flanges, sensed, odometry=True), solve(there.flanges, sensed)
        errors.append((apart(counted.X, there.X)[1], apart(at_once.X, there.X)[1]))
        for start, right in ((0, there.X), (6, there.Z)):
            found = counted.X if start == 0 else counted.Z
            assert np.all(
                np.abs(found[:3, 3] - right[:3, 3]) < 4.0 * counted.std[start + 3 : start + 6]
            )
        assert counted.residuals.shape == (39, 6)
    by_steps, by_poses = np.mean(errors, axis=0)
    assert by_steps < 0.5 * by_poses


def test_a_camera_that_stands_still_counts_no_way():
    there = scene(np.random.default_rng(6), "eye_to_hand")
    with pytest.raises(InvalidInput, match="camera that moves"):
        solve(there.flanges, there.sensed, setup="eye_to_hand", odometry=True)


@BOTH
@pytest.mark.parametrize("share", [0.2, 0.4])
def test_wrong_samples_do_not_count(setup: Setup, share: float):
    rng = np.random.default_rng(7)
    there = scene(rng, setup, 30)
    sensed = noisy(rng, there.sensed, 2e-3, 1e-3)
    clean = solve(there.flanges, sensed, setup=setup)
    wrong = np.sort(rng.choice(30, round(30 * share), replace=False))
    sensed[wrong] = random_poses(rng, len(wrong), 0.5)
    fit = solve(there.flanges, sensed, setup=setup)
    np.testing.assert_array_equal(fit.outliers, wrong)
    assert f"{len(wrong)} of 30 samples look wrong" in fit.status
    assert ("with so many wrong" in fit.status) == (share > 0.3)
    assert apart(fit.X, there.X)[1] < 2.0 * apart(clean.X, there.X)[1] + 5e-4


def test_heavy_tails_are_weighed_rather_than_cut():
    rng = np.random.default_rng(8)
    ours, plain = [], []
    for _ in range(3):
        there = scene(rng, "eye_in_hand", 30)
        sensed = there.sensed.copy()
        tails = np.sqrt(2.0 / rng.chisquare(2.0, 30))
        sensed = np.concatenate(
            [noisy(rng, sensed[i][None], 2e-3 * tails[i], 1e-3 * tails[i]) for i in range(30)]
        )
        ours.append(apart(solve(there.flanges, sensed).X, there.X)[1])
        good = noisy(rng, there.sensed, 2e-3, 1e-3)
        plain.append(apart(solve(there.flanges, good).X, there.X)[1])
    assert np.mean(ours) < 3.0 * np.mean(plain)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda A, S: (A[:2], S[:2]), "at least 3 poses, got 2: add poses"),
        (lambda A, S: (A, S[:-1]), "must pair up, got 12 and 11"),
        (lambda A, S: (A[:, :3], S), "shape"),
        (lambda A, S: (A * np.nan, S), "flanges must be finite"),
        (lambda A, S: (A, 2.0 * S), r"sensed\[0\] is no pose"),
        (lambda A, S: (A, S * np.array([1.0, 1.0, -1.0, 1.0])), r"sensed\[0\] is no pose"),
        (lambda A, S: (A, S.swapaxes(1, 2)), r"sensed\[0\] is no pose: it is transposed"),
    ],
    ids=["few", "unpaired", "shape", "nan", "scaled", "mirrored", "transposed"],
)
def test_what_is_no_pair_of_poses_is_refused(change, says: str):
    there = scene(np.random.default_rng(9), "eye_in_hand")
    with pytest.raises(InvalidInput, match=says):
        solve(*change(there.flanges, there.sensed))
    with pytest.raises(InvalidInput, match="eye_in_hand"):
        solve(there.flanges, there.sensed, setup="hand_in_eye")  # pyright: ignore[reportArgumentType]
