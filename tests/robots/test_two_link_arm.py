"""The planar arm: eq 3.6, 3.7, 3.13 to 3.17, and its derivative."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from handeye.errors import InvalidInput
from handeye.robots.planar import TwoLinkArm

angles = st.floats(-np.pi, np.pi)
lengths = st.floats(0.2, 3.0)
elbows = st.sampled_from([-1.0, 1.0])


def oracle_tip(a, b, alpha, beta):
    """Eq 3.6, 3.7 with complex numbers."""
    tip = a * np.exp(1j * alpha) + b * np.exp(1j * (alpha + beta))
    return np.array([tip.real, tip.imag])


@given(lengths, lengths, angles, angles)
def test_forward_equals_eq_3_6_and_3_7(a, b, alpha, beta):
    tip = TwoLinkArm(a, b).tips(np.array([alpha, beta]))
    np.testing.assert_allclose(tip, oracle_tip(a, b, alpha, beta), atol=1e-14)


@given(lengths, lengths, angles, st.floats(1e-3, np.pi - 1e-3), elbows)
def test_inverse_undoes_forward_for_both_elbows(a, b, alpha, bend, elbow):
    arm, joints = TwoLinkArm(a, b), np.array([alpha, elbow * bend])
    tip = arm.tips(joints)
    assume(np.hypot(*tip) > 1e-3)
    found = arm.inverse(tip, np.array(elbow))
    np.testing.assert_allclose(np.exp(1j * found), np.exp(1j * joints), atol=1e-9)
    assert np.all((found > -np.pi) & (found <= np.pi))


@given(lengths, lengths, angles, st.floats(0.0, 1.0), elbows)
def test_forward_undoes_inverse_wherever_the_arm_reaches(a, b, direction, share, elbow):
    # From the inner to the outer limit of reach, both singular.
    r = abs(a - b) + share * (a + b - abs(a - b))
    tip = r * np.array([np.cos(direction), np.sin(direction)])
    arm = TwoLinkArm(a, b)
    found = arm.inverse(tip, np.array(elbow))
    np.testing.assert_allclose(arm.tips(found), tip, atol=1e-7)
    assert elbow * found[1] >= 0.0


@given(lengths, lengths, angles, st.floats(1e-6, 5.0), elbows)
def test_a_point_out_of_reach_is_answered_by_the_nearest_posture(a, b, direction, beyond, elbow):
    arm, heading = TwoLinkArm(a, b), np.array([np.cos(direction), np.sin(direction)])
    stretched = arm.inverse((a + b + beyond) * heading, np.array(elbow))
    np.testing.assert_allclose(arm.tips(stretched), (a + b) * heading, atol=1e-7)
    inner = abs(a - b) - beyond
    assume(inner > 1e-9)
    folded = arm.inverse(inner * heading, np.array(elbow))
    np.testing.assert_allclose(arm.tips(folded), abs(a - b) * heading, atol=1e-6)


@given(elbows, st.floats(0.3, 3.0))
def test_the_base_itself_is_reached_by_a_folded_arm(elbow, a):
    arm = TwoLinkArm(a, a)
    found = arm.inverse(np.zeros(2), np.array(elbow))
    assert np.all(np.isfinite(found))
    np.testing.assert_allclose(arm.tips(found), 0.0, atol=1e-15)


def test_elbow_left_is_a_positive_beta_on_the_right_of_the_line_to_the_tip():
    # Eq 3.16: sgn(phi) = -sgn(beta); a right angle in a 1-1 arm.
    found = TwoLinkArm().inverse(np.array([[1.0, 1.0], [1.0, 1.0]]), np.array([1.0, -1.0]))
    np.testing.assert_allclose(found, [[0.0, np.pi / 2], [np.pi / 2, -np.pi / 2]], atol=1e-15)


@given(lengths, lengths, st.integers(0, 2**32 - 1))
def test_jacobian_equals_central_differences(a, b, seed):
    arm, step = TwoLinkArm(a, b), 1e-6
    joints = np.random.default_rng(seed).uniform(-np.pi, np.pi, (5, 2))
    jacobians = arm.jacobians(joints)
    assert jacobians.shape == (5, 6, 2)
    for k in range(2):
        shift = step * np.eye(2)[k]
        ahead, behind = arm.poses(joints + shift), arm.poses(joints - shift)
        rate = (ahead - behind) / (2.0 * step)
        np.testing.assert_allclose(jacobians[:, :3, k], rate[:, :3, 3], atol=1e-8)
        spin = rate[:, :3, :3] @ arm.poses(joints)[:, :3, :3].transpose(0, 2, 1)
        vector = np.stack([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]], axis=-1)
        np.testing.assert_allclose(jacobians[:, 3:, k], vector, atol=1e-8)


def test_poses_are_rigid_and_end_at_the_tip():
    arm, joints = TwoLinkArm(1.2, 0.7), np.array([[0.3, -1.1], [2.0, 0.4]])
    poses = arm.poses(joints)
    R = poses[:, :3, :3]
    np.testing.assert_allclose(R @ R.transpose(0, 2, 1), np.tile(np.eye(3), (2, 1, 1)), atol=1e-15)
    np.testing.assert_allclose(np.linalg.det(R), 1.0)
    np.testing.assert_allclose(poses[:, :2, 3], arm.tips(joints))
    np.testing.assert_array_equal(poses[:, 2, 3], 0.0)
    # x runs along the second link, from the elbow to the tip.
    elbow = 1.2 * np.stack([np.cos(joints[:, 0]), np.sin(joints[:, 0])], axis=-1)
    np.testing.assert_allclose(poses[:, :2, 0], (arm.tips(joints) - elbow) / 0.7, atol=1e-15)


def test_an_arm_that_expands_gives_row_by_row_what_rigid_arms_give():
    rng = np.random.default_rng(0)
    a, b = rng.uniform(0.5, 1.5, (2, 6))
    joints, elbow = rng.uniform(-2.0, 2.0, (6, 2)), np.array([1.0, -1.0] * 3)
    arm, rows = TwoLinkArm(a, b), [TwoLinkArm(*ab) for ab in zip(a, b, strict=True)]
    tips = arm.tips(joints)
    for i, row in enumerate(rows):
        np.testing.assert_array_equal(tips[i], row.tips(joints[i]))
        np.testing.assert_array_equal(arm.inverse(tips, elbow)[i], row.inverse(tips[i], elbow[i]))
        np.testing.assert_array_equal(arm.jacobians(joints)[i], row.jacobians(joints[[i]])[0])
    assert arm.reach == max(row.reach for row in rows)


@pytest.mark.parametrize("length", [0.0, -1.0, np.nan, np.inf, "1", np.array([1.0, 0.0])])
def test_a_link_needs_a_length(length):
    with pytest.raises(InvalidInput, match=r"link b must have a positive length|b must be"):
        TwoLinkArm(1.0, length)
