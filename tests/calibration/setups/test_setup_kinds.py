"""Every kind of observation from its description to what is found, against what is true."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.calibration.setups.setups import CASES, described

from handeye.arrays import Array
from handeye.calibration.arm.measurements import Frame, Numbers, Points
from handeye.calibration.setups.description import load_description
from handeye.calibration.setups.fit import MixedFit, fit_measurements

SEEDS = 2


def found(folder: Path) -> MixedFit:
    setup = load_description(folder / "setup.yaml")
    return fit_measurements(setup.arm, setup.measurements, setup.sheet)


def off(fit: MixedFit, name: str, true: Array) -> Array:
    """Free components of the change from what was found to what is true."""
    unknown = fit.unknowns[name]
    if isinstance(unknown, Frame):
        if true.shape == (3,):
            return (true - unknown.reference[:3, 3])[unknown.free[:3]]
        E = np.linalg.inv(unknown.reference) @ true
        if not unknown.free[0]:
            # Of a plane only its height and tilt count, of either side.
            n = E[:3, 2] * np.sign(E[2, 2])
            return np.array([n @ E[:3, 3] / n[2], -n[1], n[0]])
        turn = Rotation.from_matrix(E[:3, :3]).as_rotvec()
        return np.concatenate([E[:3, 3], turn])[unknown.free]
    assert isinstance(unknown, Points | Numbers)
    return (true - unknown.reference.reshape(true.shape)).reshape(-1)[unknown.free]


@pytest.mark.parametrize("case", CASES)
def test_what_is_found_is_true_within_its_standard_deviations(case: str, tmp_path: Path):
    normalised: list[Array] = []
    for seed in range(SEEDS):
        truth = described(case, tmp_path, seed)
        fit = found(tmp_path)
        for name, true in truth.of.items():
            normalised.append(off(fit, name, true) / fit.std(name))
    z = np.concatenate(normalised)
    assert np.abs(z).max() < 4.5, case
    assert 0.3 < np.sqrt(np.mean(z**2)) < 1.7, case
