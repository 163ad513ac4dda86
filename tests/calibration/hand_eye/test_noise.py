"""How large the noise is found to be, against formulas."""

import numpy as np
import pytest
from tests.calibration.hand_eye.arms import Wrist
from tests.calibration.hand_eye.scenes import noisy, random_poses, seen

from handeye.calibration.hand_eye import solve_arm
from handeye.calibration.hand_eye.noise import LEAST, improved


def test_unknowns_cost_degrees_of_freedom():
    """One unknown mean for each of the six residuals of N samples leaves N - 1 of them."""
    rng = np.random.default_rng(0)
    n, sizes = 6, np.repeat([2e-3, 1e-3], 3)
    r = rng.normal(size=(n, 1))
    r = (r - r.mean()) * sizes
    V = np.zeros((8, n, 6, 6))
    for k in range(6):
        V[k, :, k, k] = 1.0
    J, every = np.tile(np.eye(6), (n, 1, 1)), np.ones(n)
    v = np.full(8, 1e-5)
    for _ in range(30):
        v, spread = improved(v, V, r, J, np.zeros((6, 6)), every, every)
    right = np.sum(r**2, axis=0) / (n - 1)
    np.testing.assert_allclose(v[:6], right, rtol=1e-4)
    # Nothing of the arm can be seen here; a mean of N is known N times better than one of them.
    np.testing.assert_array_equal(v[6:], LEAST**2)
    np.testing.assert_allclose(np.diag(spread), right / n, rtol=1e-4)


def test_errors_of_the_readings_are_told_from_those_of_the_camera():
    rng = np.random.default_rng(1)
    arm, q = Wrist(), rng.uniform(-1.5, 1.5, (60, 4))
    X, Z = random_poses(rng, 2, 0.1)
    sensed = noisy(rng, seen(arm.poses(q), X, Z, "eye_in_hand"), 1e-3, 5e-4)
    fit = solve_arm(arm, q + rng.normal(0.0, 3e-3, q.shape), sensed)
    assert fit.noise.joints == pytest.approx(3e-3, rel=0.25)
    np.testing.assert_allclose(fit.noise.camera_turn, 1e-3, rtol=0.5)
