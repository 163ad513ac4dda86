import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from tests.calibration.arm.measured import inverse, looking, pose

from handeye.arrays import Array
from handeye.calibration.arm.measurements.lens import lens, project, straightened
from handeye.calibration.arm.measurements.resection import resection
from handeye.errors import InvalidInput

NUMBERS = np.array([900.0, 910.0, 640.0, 360.0, -0.2, 0.05, 1e-3, -2e-3, 0.01])


def test_pixels_and_their_derivatives_equal_opencv():
    cv2 = pytest.importorskip("cv2", reason="OpenCV comes with the extra bench")
    rng = np.random.default_rng(0)
    s = np.column_stack([rng.uniform(-0.5, 0.5, (50, 2)), rng.uniform(0.8, 2.0, 50)])
    K = np.array([[NUMBERS[0], 0, NUMBERS[2]], [0, NUMBERS[1], NUMBERS[3]], [0, 0, 1.0]])
    uv, J = cv2.projectPoints(s, np.zeros(3), np.zeros(3), K, NUMBERS[4:])
    mine, by_s, by_numbers = project(NUMBERS, s)
    np.testing.assert_allclose(mine, uv[:, 0], rtol=1e-12)
    theirs = J.reshape(50, 2, -1)
    np.testing.assert_allclose(by_s, theirs[:, :, 3:6], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(by_numbers, theirs[:, :, 6:15], rtol=1e-9, atol=1e-9)


@given(arrays(np.float64, (5, 2), elements=st.floats(-0.6, 0.6)))
def test_straightening_undoes_distortion(ab: Array):
    uv, _, _ = project(NUMBERS, np.column_stack([ab, np.ones(5)]))
    np.testing.assert_allclose(straightened(NUMBERS, uv), ab, atol=1e-9)


def test_points_behind_the_camera_are_far_off_the_picture_and_finite():
    s = np.array([[0.1, 0.1, 0.5], [0.1, 0.1, -0.5], [0.1, 0.1, 0.0]])
    uv, by_s, by_numbers = project(np.append(NUMBERS[:4], np.zeros(5)), s)
    assert np.isfinite(by_s).all()
    assert np.isfinite(by_numbers).all()
    assert (np.abs(uv[1:]) > 1e4).all()
    np.testing.assert_array_equal(by_s[1:, :, 2], 0.0)


@pytest.mark.parametrize("flat", [True, False])
@pytest.mark.parametrize("seed", range(5))
def test_a_camera_is_where_it_sees_points(flat: bool, seed: int):
    rng = np.random.default_rng(seed)
    points = rng.uniform(-0.2, 0.2, (8, 3)) * ([1.0, 1.0, 0.0] if flat else 1.0)
    where = pose(rng)
    points = points @ where[:3, :3].T
    T = inverse(looking(rng))
    s = points @ T[:3, :3].T + T[:3, 3]
    np.testing.assert_allclose(resection(points, s[:, :2] / s[:, 2:]), T, atol=1e-8)


def test_points_on_a_line_place_no_camera():
    line = np.linspace(0.0, 1.0, 9)[:, np.newaxis] * [1.0, 2.0, 3.0]
    with pytest.raises(InvalidInput, match="not on one line"):
        resection(line, line[:, :2])
    with pytest.raises(InvalidInput, match="at least 6 points, or 4 of a plane"):
        resection(np.random.default_rng(0).standard_normal((5, 3)), np.zeros((5, 2)))


def test_a_lens_is_known_or_within_its_tolerance():
    known = lens("eye", (900.0, 900.0, 320.0, 240.0), (-0.1, 0.02))
    assert known.block is None
    np.testing.assert_array_equal(known.reference[4:], [-0.1, 0.02, 0.0, 0.0, 0.0])
    free = lens("eye", (900.0, 900.0, 320.0, 240.0), tolerance=2.0)
    assert free.block is not None
    assert free.block.names[:2] == ("eye fx", "eye fy")
    assert free.block.units == ("px",) * 4 + ("",) * 5
    assert free.block.tolerance[0] == 10.0


def test_lenses_that_are_none_are_refused():
    with pytest.raises(InvalidInput, match="focal lengths must be positive"):
        lens("eye", (-900.0, 900.0, 320.0, 240.0))
    with pytest.raises(InvalidInput, match="k1, k2, p1, p2, k3, got 8 numbers"):
        lens("eye", (900.0, 900.0, 320.0, 240.0), np.zeros(8).tolist())
