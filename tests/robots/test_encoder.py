"""Encoders: eq 3.33 to 3.38."""

import numpy as np

from handeye.robots.encoder import AxisEncoder

ANGLES = np.linspace(-0.8 * np.pi, 0.8 * np.pi, 101)


def test_pointing_encoder_equals_eq_3_33_and_3_34():
    nu, offset = 0.002, 0.035
    encoder = AxisEncoder(offset, amplitude=nu, frequency=3.0, phase=0.7)
    error = nu * ANGLES * np.sin(3.0 * ANGLES + 0.7)
    np.testing.assert_allclose(encoder.error(ANGLES), error, rtol=1e-14)
    np.testing.assert_allclose(encoder.reading(ANGLES), ANGLES + error - offset, rtol=1e-14)


def test_arm_encoders_equal_eq_3_35_to_3_38():
    xi, kappa, offset = -0.0017, 0.0018, 0.018
    alpha = AxisEncoder(0.0, amplitude=xi, phase=2.0)
    beta = AxisEncoder(offset, amplitude=kappa, phase=-1.0)
    np.testing.assert_allclose(
        alpha.actual(ANGLES), ANGLES + xi * ANGLES * np.sin(ANGLES + 2.0), rtol=1e-14
    )
    np.testing.assert_allclose(
        beta.actual(ANGLES), ANGLES + kappa * ANGLES * np.sin(ANGLES - 1.0) + offset, rtol=1e-14
    )


def test_the_default_encoder_tells_the_truth():
    np.testing.assert_array_equal(AxisEncoder().actual(ANGLES), ANGLES)
    np.testing.assert_array_equal(AxisEncoder().reading(ANGLES), ANGLES)


def test_each_trial_may_have_an_offset_of_its_own():
    offsets = np.linspace(-0.1, 0.1, len(ANGLES))
    drifting = AxisEncoder(offsets, amplitude=0.01, frequency=2.0, phase=0.3)
    rows = [AxisEncoder(o, 0.01, 2.0, 0.3) for o in offsets.tolist()]
    for one_axis in ("actual", "reading"):
        alone = [getattr(e, one_axis)(q) for e, q in zip(rows, ANGLES, strict=True)]
        np.testing.assert_array_equal(getattr(drifting, one_axis)(ANGLES), alone)
