"""The compiled arm against the formula written out, and its derivatives against differences."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from tests.calibration.arm.arms import PLACEMENT, arm, errors_of, kernel_of, model, sightings

from handeye.calibration.arm.description import expected_rows, seen_rows, target_rows
from handeye.calibration.arm.kernels import n_unknowns, pose, pose_many, pose_slopes
from handeye.calibration.arm.residuals import arm_residuals, misfit
from handeye.calibration.arm.rotations import turn_between, turned
from handeye.observations import PointTarget

NAMES = ("ur10", "tiago_no_hand", "torso", "palletiser")
# Each seen with and without orientations, or one of both.
SIGHTS = [
    ("ur10", None),
    ("ur10", 1e-4),
    ("tiago_no_hand", None),
    ("torso", 1e-4),
    ("palletiser", None),
]
SEEDS = st.integers(0, 2**32 - 1)


def shifted(e):
    """E(t, r)."""
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = Rotation.from_rotvec(e[3:]).as_matrix(), e[:3]
    return T


def written_out(placed, x, readings, loads):
    """The product of the module's docstring, stage by stage."""
    kernel = kernel_of(placed)
    q = placed.arm.readings.positions(readings[np.newaxis])[0]
    n, m = len(q), kernel.n_marker
    stages = placed.arm.stages().upright()
    T = placed.placement.T_sensor_base @ shifted(x[:6])
    for j in range(n):
        at = 6 + m + 8 * j
        xi, scale, compliance = x[at : at + 6].copy(), x[at + 6], x[at + 7]
        for i, (joint, component, harmonic) in enumerate(kernel.terms):
            if joint == j:
                phi = q[j] * kernel.rates[j]
                a, b = x[6 + m + 8 * n + 2 * i :][:2]
                xi[component] += a * np.cos(harmonic * phi) + b * np.sin(harmonic * phi)
        amount = (1.0 + scale) * q[j] + compliance * loads[j]
        moved = [0.0, 0.0, amount, 0.0, 0.0, 0.0] if stages.slides[j] else [0.0] * 5 + [amount]
        T = T @ stages.placements[j] @ shifted(xi) @ shifted(np.array(moved))
    marker = np.zeros(6)
    marker[:m] = x[6 : 6 + m]
    return T @ stages.placements[n] @ shifted(marker) @ placed.placement.T_flange_marker


def large(placed, seed):
    """Errors of degrees and centimetres in everything, so that second order counts."""
    n = n_unknowns(kernel_of(placed))
    return 0.035 * np.random.default_rng(seed).normal(size=n)


@pytest.mark.parametrize(("name", "turn_std"), SIGHTS)
@given(seed=SEEDS)
def test_the_pose_is_the_product_of_all_stages(name, turn_std, seed):
    placed = model(name, turn_std)
    kernel, x = kernel_of(placed), 0.1 * large(placed, seed)
    seen = sightings(placed, errors_of(placed), 2, seed)
    rows = seen_rows(kernel, placed.arm, seen)
    T = np.empty((2, 3, 4))
    pose_many(kernel, x, rows, T)
    loads = placed.arm.loads(seen.joints)
    for i in range(2):
        expected = written_out(placed, x, seen.joints[i], loads[i])
        np.testing.assert_allclose(T[i], expected[:3], atol=1e-12)


@pytest.mark.parametrize("name", NAMES)
def test_without_errors_it_is_the_placed_nominal_arm(name):
    placed = model(name)
    kernel = kernel_of(placed)
    seen = sightings(placed, errors_of(placed), 5)
    T = np.empty((5, 3, 4))
    pose_many(kernel, np.zeros(n_unknowns(kernel)), seen_rows(kernel, placed.arm, seen), T)
    expected = PLACEMENT.T_sensor_base @ placed.arm.poses(seen.joints) @ PLACEMENT.T_flange_marker
    np.testing.assert_allclose(T, expected[:, :3], atol=1e-12)


@pytest.mark.parametrize(("name", "turn_std"), SIGHTS)
@given(seed=SEEDS)
def test_derivatives_are_those_of_differences(name, turn_std, seed):
    placed = model(name, turn_std)
    kernel, x = kernel_of(placed), large(placed, seed)
    row = seen_rows(kernel, placed.arm, sightings(placed, errors_of(placed), 1, seed))[0]
    n, k, step = len(x), 6 if turn_std else 3, 1e-6
    T, slopes = np.empty((3, 4)), np.empty((6, n))
    pose_slopes(kernel, x, row, T, slopes)
    values, by = np.empty(k), np.empty((k, n))
    arm_residuals(kernel, x, row, 1e-3, values, by)
    sample = np.random.default_rng(seed).permutation(n)[:12]
    for i in sample:
        ends = []
        for sign in (1.0, -1.0):
            moved, pose_there, there = x.copy(), np.empty((3, 4)), np.empty(k)
            moved[i] += sign * step
            pose(kernel, moved, row, pose_there)
            arm_residuals(kernel, moved, row, 1e-3, there, np.empty((k, n)))
            ends.append((pose_there, there))
        (ahead, v_ahead), (behind, v_behind) = ends
        shift = (ahead[:, 3] - behind[:, 3]) / (2.0 * step)
        turn = Rotation.from_matrix(ahead[:, :3] @ behind[:, :3].T).as_rotvec() / (2.0 * step)
        size = 1e-7 * max(1.0, np.abs(slopes[:, i]).max())
        np.testing.assert_allclose(slopes[:, i], [*shift, *turn], atol=size)
        if abs(values[3:]).max(initial=0.0) * 1e-3 < 2.0:
            difference = (v_ahead - v_behind) / (2.0 * step)
            np.testing.assert_allclose(by[:, i], difference, atol=1e4 * size, rtol=1e-4)


@given(seed=SEEDS, angle=st.floats(0.0, np.pi - 1e-6))
def test_turns_between_orientations(seed, angle):
    rng = np.random.default_rng(seed)
    axis = rng.normal(size=3)
    wanted = angle * axis / np.linalg.norm(axis)
    start = Rotation.random(random_state=seed % 1000).as_matrix()
    v, K, R, L = np.empty(3), np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    turn_between(start, Rotation.from_rotvec(wanted).as_matrix() @ start, v, K)
    np.testing.assert_allclose(v, wanted, atol=1e-9)
    turned(wanted, R, L)
    np.testing.assert_allclose(R, Rotation.from_rotvec(wanted).as_matrix(), atol=1e-12)
    d = 1e-6 * rng.normal(size=3)
    ahead = Rotation.from_rotvec(wanted + d) * Rotation.from_rotvec(wanted).inv()
    np.testing.assert_allclose(L @ d, ahead.as_rotvec(), atol=1e-10)
    back = Rotation.from_rotvec(wanted) * Rotation.from_rotvec(d).inv()
    if angle < 3.0:
        np.testing.assert_allclose(wanted - K @ d, back.as_rotvec(), atol=1e-9)


def test_residuals_are_measured_minus_predicted_over_their_deviations():
    placed = model()
    kernel, x = kernel_of(placed), errors_of(placed)
    seen = sightings(placed, x, 1, noise=3.0)
    row = seen_rows(kernel, placed.arm, seen)[0]
    values, slopes, plain = np.empty(6), np.empty((6, len(x))), np.empty(6)
    arm_residuals(kernel, x, row, 1e-4, values, slopes)
    misfit(kernel, x, row, plain, slopes)
    T = np.empty((3, 4))
    pose(kernel, x, row, T)
    measured = Rotation.from_quat(seen.orientation[0], scalar_first=True)
    turn = (measured * Rotation.from_matrix(T[:, :3]).inv()).as_rotvec()
    np.testing.assert_allclose(plain, [*(seen.position[0] - T[:, 3]), *turn], atol=1e-12)
    std = np.repeat([np.hypot(5e-5, 1e-4), np.hypot(2e-4, 1e-4 / kernel.lever)], 3)
    np.testing.assert_allclose(values, plain / std, rtol=1e-9)


def test_rows_hold_what_the_kernels_need():
    placed = model()
    kernel, x = kernel_of(placed), errors_of(placed)
    seen = sightings(placed, x, 3, noise=0.0)
    rows = seen_rows(kernel, placed.arm, seen)
    np.testing.assert_array_equal(rows[:, :6], seen.joints)
    np.testing.assert_array_equal(rows[:, 6:12], placed.arm.loads(seen.joints))
    np.testing.assert_array_equal(seen_rows(kernel, placed.arm, seen[1]), rows[1])
    expected = expected_rows(kernel, placed.arm, x, seen.joints)
    np.testing.assert_allclose(expected[:, :15], rows[:, :15], atol=1e-9)
    same = np.abs(np.sum(expected[:, 18:] * rows[:, 18:], axis=1))
    np.testing.assert_allclose(same, 1.0, atol=1e-9)
    target = PointTarget(seen.position, seen.joints)
    np.testing.assert_array_equal(target_rows(kernel, placed.arm, target)[:, :15], rows[:, :15])


def test_curves_of_a_sliding_joint_span_its_travel():
    kernel = kernel_of(model("tiago_no_hand"))
    slider = int(np.flatnonzero(kernel.slides)[0])
    travel = arm("tiago_no_hand").upper[slider] - arm("tiago_no_hand").lower[slider]
    np.testing.assert_allclose(kernel.rates[slider] * travel, np.pi)
    np.testing.assert_array_equal(kernel.rates[~kernel.slides], 1.0)
    own = [row for row in kernel.terms.tolist() if row[2] == kernel.terms[:, 2].max()]
    assert {(j, c) for j, c, _ in own} == {
        (j, 2 if slides else 5) for j, slides in enumerate(kernel.slides)
    }
