"""What a fit knows, kept as arrays; and a fit to rows without any noise."""

import numpy as np
import pytest
from tests.calibration.arm.test_evidence import made

from handeye.calibration.arm.evidence import solve
from handeye.calibration.arm.lines import root_of
from handeye.calibration.arm.posterior import Posterior
from handeye.errors import InvalidInput


def test_it_comes_back_from_its_arrays_to_the_bit():
    system, _ = made(channels=(0, 1))
    found = solve(system)
    back = Posterior.restored(system, found.arrays())
    for name, array in found.arrays().items():
        np.testing.assert_array_equal(getattr(back, name, array), array)
    np.testing.assert_array_equal(back.root, found.root)
    np.testing.assert_array_equal(back.leverage, found.leverage)
    assert back.used.dtype == found.used.dtype == np.bool_
    assert back.errors.values.tolist() == [1, 1]


@pytest.mark.parametrize("name", ["x", "widths", "used", "squares", "noise", "values", "told"])
def test_arrays_of_another_system_are_refused(name: str):
    system, _ = made(channels=(0, 1))
    arrays = solve(system).arrays()
    with pytest.raises(InvalidInput, match=f"{name} must have shape"):
        Posterior.restored(system, arrays | {name: arrays[name][1:]})


def test_rows_without_noise_are_fitted_like_any():
    """Where information is so great that rounding hides the prior."""
    system, x = made(n=400, noise=0.0)
    system.by[:, :, 1] = system.by[:, :, 0]  # which of the two it is, no row tells
    system.values[:] = system.by @ x
    found = solve(system)
    np.testing.assert_allclose(system.by @ found.x, system.values, atol=1e-6)
    told = np.sum((system.by * system.tolerance) ** 2, axis=(0, 1)).max()
    assert 0.999 < found.noise[0] / np.sqrt(told / 1e13) < 1.001
    assert np.isfinite(found.root).all()
    assert np.isfinite(found.leverage).all()


def test_roots_are_those_of_information_and_prior():
    rng = np.random.default_rng(2)
    J, width = rng.normal(size=(9, 4)), np.array([0.5, 1.0, 2.0, 3.0])
    root = root_of(J.T @ J, width)
    np.testing.assert_allclose(root @ root.T, J.T @ J + np.diag(width**-2.0))
    hidden = 1e18 * np.ones((4, 4)) - np.diag([0.0, 0.0, 0.0, 256.0])
    there = root_of(hidden, width)
    np.testing.assert_allclose(there @ there.T, hidden, rtol=1e-12)
