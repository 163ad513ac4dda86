"""What a motion leaves open is named, and the rest is given."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.calibration.hand_eye.scenes import (
    SETUPS,
    Scene,
    apart,
    noisy,
    scene,
    seen,
    turned_about,
)

from handeye.arrays import Array
from handeye.calibration.hand_eye import Mounting, solve
from handeye.calibration.hand_eye.samples import Setup
from handeye.errors import InvalidInput
from handeye.geometry import invert, make_pose

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


def turning(angles: Array, axis: Array) -> Array:
    return Rotation.from_rotvec(angles[:, None] * axis).as_matrix()


def motions(rng: np.random.Generator, n: int) -> dict[str, Array]:
    """Poses of flanges that move in ways that are not enough, each n times."""
    axis, angles = DIAGONAL, rng.uniform(-1.2, 1.2, n)
    across = np.linalg.svd(axis[None])[2][1:]
    elbow = make_pose(np.eye(3), [0.2, -0.1, 0.3])
    start = make_pose(Rotation.from_rotvec([0.3, -0.4, 0.5]).as_matrix(), [0.1, 0.3, 0.2])
    nowhere = np.zeros((n, 3))
    # Parallel joints, as shoulder and elbow: shifts stay in the plane across the axis.
    in_plane = make_pose(turning(angles, axis), rng.normal(size=(n, 2)) * 0.2 @ across)
    return {
        "parallel joints": in_plane @ start,
        "one joint": elbow @ make_pose(turning(angles, axis), nowhere) @ invert(elbow) @ start,
        "a slide that turns": make_pose(turning(angles, axis), np.outer(rng.normal(size=n), axis)),
        "a slide": make_pose(np.eye(3), np.outer(rng.normal(size=n) * 0.2, axis)) @ start,
        "a cross slide": make_pose(np.eye(3), rng.normal(size=(n, 3)) * 0.2) @ start,
        "nothing": np.tile(start, (n, 1, 1)),
    }


LEFT_OPEN = {
    "parallel joints": ("translation of the {} along",),
    "one joint": ("orientation of the {} about", "translation of the {} along"),
    "a slide that turns": ("orientation of the {} about", "translation of the {} along"),
    "a slide": ("orientation of the {} about", "translation of the {} in any direction"),
    "a cross slide": ("translation of the {} in any direction",),
    "nothing": ("orientation of the {} in every way", "translation of the {} in any direction"),
}


def open_ways(there: Scene, setup: Setup) -> int:
    """In how many ways X can change, with some Z, while nothing looks different."""
    columns: list[Array] = []
    for k in range(12):
        step = np.zeros((2, 6))
        step.flat[k] = 1e-6
        X, Z = (
            make_pose(Rotation.from_rotvec(d[:3]).as_matrix() @ T[:3, :3], T[:3, 3] + d[3:])
            for d, T in zip(step, (there.X, there.Z), strict=True)
        )
        changed = seen(there.flanges, X, Z, setup) - there.sensed
        columns.append(changed[:, :3].reshape(-1) / 1e-6)
    _, sizes, right = np.linalg.svd(np.array(columns).T)
    return int(np.linalg.matrix_rank(right[sizes < 1e-4 * sizes[0], :6], tol=1e-3))


@NOISE
@pytest.mark.parametrize("motion", LEFT_OPEN)
def test_what_a_motion_leaves_open_is_named_and_the_rest_is_given(noise: float, motion: str):
    setup = SETUPS[(len(motion) + int(noise)) % 2]
    rng = np.random.default_rng(11)
    there = scene(rng, setup, motions(rng, 15)[motion])
    A = noisy(rng, there.flanges, noise * 2e-4, noise * 1e-4)
    fit = solve(A, noisy(rng, there.sensed, noise * 1e-3, noise * 5e-4), setup=setup)
    name = "camera" if setup == "eye_in_hand" else "target"
    assert len(fit.undetermined) == len(LEFT_OPEN[motion])
    for said, expected in zip(fit.undetermined, LEFT_OPEN[motion], strict=True):
        assert said.startswith(expected.format(name))
    turns = motion not in {"a slide", "a cross slide", "nothing"}
    assert (
        "the flange turns about its axis" if turns else "the flange does not turn"
    ) in fit.status
    # As many ways are open as there are, and the axis is the one of the flange.
    stds = np.sqrt(np.linalg.eigvalsh(fit.covariance[:6, :6]))
    assert np.sum(stds > 0.1) == open_ways(there, setup)
    own = there.flanges[0, :3, :3].T @ DIAGONAL
    own = own * np.sign(own[np.argmax(np.abs(own))])
    for said in fit.undetermined:
        if said.endswith("of the flange"):
            named = [float(c) for c in said[said.index("(") + 1 : said.index(")")].split(",")]
            np.testing.assert_allclose(named, own, atol=0.006 + 0.02 * noise)
    # Whatever moves so, the camera sees what is predicted, for the open ways make no difference.
    others = motions(np.random.default_rng(12), 15)[motion]
    right = seen(others, there.X, there.Z, setup)
    np.testing.assert_allclose(fit.predict(others), right, atol=1e-5 + 8e-3 * noise)


def test_turns_that_only_the_noise_reports_tell_nothing():
    # A solver that takes them for turns about other axes finds the shift, and is sure of it.
    rng = np.random.default_rng(0)
    there = scene(rng, "eye_in_hand", turned_about(rng, 60, np.array([0.0, 0.0, 1.0])))
    reported = noisy(rng, there.flanges, 5e-3, 1e-5)
    fit = solve(reported, noisy(rng, there.sensed, 1e-3, 2e-4))
    assert fit.undetermined == ("translation of the camera along (0.00, 0.00, 1.00) of the flange",)


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
