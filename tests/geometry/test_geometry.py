"""Laws of rotations, poses and registration, over random and near-singular samples."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from handeye.errors import InvalidInput
from handeye.geometry import (
    invert,
    make_pose,
    matrix_from_wxyz,
    nearest_rotation,
    rigid_transform,
    transform,
    wxyz_from_matrix,
)

# No turn, turns too small to see, and turns next to the half turn where w changes its sign.
ANGLES = [0.0, 1e-12, 1e-7, 1e-3, 1.0, np.pi - 1e-3, np.pi - 1e-7, np.pi]


def rotations(rng: np.random.Generator) -> np.ndarray:
    axes = rng.normal(size=(len(ANGLES), 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    near_singular = Rotation.from_rotvec(axes * np.array(ANGLES)[:, None])
    return np.concatenate([near_singular.as_matrix(), Rotation.random(20, rng=rng).as_matrix()])


def poses(rng: np.random.Generator) -> np.ndarray:
    R = rotations(rng)
    return make_pose(R, rng.normal(size=(len(R), 3)))


seeds = st.integers(0, 2**32 - 1).map(np.random.default_rng)


@given(seeds)
def test_quaternion_and_matrix_are_inverse_to_each_other(rng):
    R = rotations(rng)
    wxyz = wxyz_from_matrix(R)
    np.testing.assert_allclose(matrix_from_wxyz(wxyz), R, atol=1e-14)
    np.testing.assert_allclose(matrix_from_wxyz(-3.0 * wxyz), R, atol=1e-14)
    np.testing.assert_allclose(np.linalg.norm(wxyz, axis=1), 1.0, rtol=1e-14)
    assert np.all(wxyz[:, 0] >= 0.0)


def test_quaternion_of_a_quarter_turn_has_w_first():
    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    half = np.sqrt(0.5)
    np.testing.assert_allclose(wxyz_from_matrix(quarter), [half, 0.0, 0.0, half], atol=1e-15)
    np.testing.assert_allclose(matrix_from_wxyz([half, 0.0, 0.0, half]), quarter, atol=1e-15)


def test_leading_axes_are_kept():
    R = np.broadcast_to(np.eye(3), (2, 5, 3, 3))
    assert wxyz_from_matrix(R).shape == (2, 5, 4)
    assert matrix_from_wxyz(wxyz_from_matrix(R)).shape == (2, 5, 3, 3)
    assert make_pose(R, np.zeros(3)).shape == (2, 5, 4, 4)
    assert transform(np.eye(4), np.zeros((7, 3))).shape == (7, 3)


@given(seeds)
def test_inverse_undoes_a_pose_and_composition_is_the_matrix_product(rng):
    T_a_b, T_b_c = poses(rng), poses(rng)
    points = rng.normal(size=(len(T_a_b), 3))
    np.testing.assert_allclose(invert(T_a_b) @ T_a_b, np.eye(4) + 0 * T_a_b, atol=1e-13)
    np.testing.assert_allclose(
        transform(invert(T_a_b), transform(T_a_b, points)), points, atol=1e-13
    )
    np.testing.assert_allclose(
        transform(T_a_b @ T_b_c, points), transform(T_a_b, transform(T_b_c, points)), atol=1e-13
    )
    np.testing.assert_allclose(
        transform(T_a_b, points),
        np.einsum("nij,nj->ni", T_a_b[:, :3, :3], points) + T_a_b[:, :3, 3],
    )


@given(seeds)
def test_nearest_rotation_beats_every_other_and_keeps_rotations(rng):
    R = rotations(rng)
    np.testing.assert_allclose(nearest_rotation(R), R, atol=1e-13)
    M = rng.normal(size=(3, 3))
    nearest = nearest_rotation(M)
    np.testing.assert_allclose(np.linalg.det(nearest), 1.0, rtol=1e-12)
    distance = np.linalg.norm(M - nearest)
    small = Rotation.from_rotvec(0.01 * rng.normal(size=(20, 3))).as_matrix()
    for other in [*R, *(small @ nearest)]:
        assert np.linalg.norm(M - other) >= distance - 1e-12


@given(
    rng=seeds,
    n=st.integers(3, 30),
    flatness=st.sampled_from([1.0, 1e-3, 0.0]),
    width=st.sampled_from([1.0, 1e-2, 1e-4]),
)
def test_registration_recovers_an_exact_motion(rng, n, flatness, width):
    body = np.array([[1.0, 0.3, 0.2], [-1.0, 0.1, 0.0], [0.1, 1.0, -0.3]])
    a = np.concatenate([body, rng.uniform(-1.0, 1.0, (n - 3, 3))]) * [1.0, width, flatness * width]
    a = a @ Rotation.random(rng=rng).as_matrix().T + rng.normal(size=3)
    for T in poses(rng):
        # Rounding is amplified where the points nearly lie on a line.
        np.testing.assert_allclose(
            rigid_transform(a, transform(T, a)), T, atol=1e-13 + 1e-14 / width**2
        )


@given(seeds)
def test_registration_minimises_the_sum_of_squares(rng):
    a = rng.normal(size=(10, 3))
    b = transform(poses(rng)[-1], a) + 0.1 * rng.normal(size=(10, 3))
    best = rigid_transform(a, b)
    least = np.sum((b - transform(best, a)) ** 2)
    for twist in 1e-3 * np.eye(6):
        for sign in (1.0, -1.0):
            nudge = make_pose(Rotation.from_rotvec(sign * twist[:3]).as_matrix(), sign * twist[3:])
            assert np.sum((b - transform(nudge @ best, a)) ** 2) > least


@pytest.mark.parametrize(
    ("points", "message"),
    [
        (np.eye(3)[:2], "at least 3 pairs"),
        (np.outer(np.arange(5.0), [1.0, 2.0, 3.0]), "lie on one line"),
        (np.ones((4, 3)), "lie on one line"),
        (np.zeros((4, 2)), "shape"),
        (np.full((4, 3), np.nan), "finite"),
    ],
)
def test_registration_refuses_what_does_not_fix_a_motion(points, message):
    with pytest.raises(InvalidInput, match=message):
        rigid_transform(points, points)


def test_registration_refuses_a_set_that_collapsed():
    a = np.random.default_rng(0).normal(size=(5, 3))
    with pytest.raises(InvalidInput, match="points b lie on one line"):
        rigid_transform(a, a * [1.0, 0.0, 0.0])
    with pytest.raises(InvalidInput, match="pair up"):
        rigid_transform(a, a[:4])


def test_wrong_shapes_and_matrices_that_are_no_rotation_are_refused():
    refused = [
        (matrix_from_wxyz, [0.0, 0.0, 0.0, 0.0]),
        (matrix_from_wxyz, [1.0, 0.0, 0.0]),
        (wxyz_from_matrix, np.diag([1.0, 1.0, -1.0])),
        (wxyz_from_matrix, 2.0 * np.eye(3)),
        (wxyz_from_matrix, np.eye(4)),
        (nearest_rotation, np.eye(2)),
        (make_pose, np.eye(4), np.zeros(3)),
        (make_pose, np.zeros((2, 3, 3)), np.zeros((3, 3))),
        (invert, np.eye(3)),
        (transform, np.eye(4), np.zeros(2)),
    ]
    for function, *arguments in refused:
        with pytest.raises(InvalidInput):
            function(*arguments)
