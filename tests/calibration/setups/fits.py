"""Described set-ups as they are fitted, and where what is seen is before a sensor."""

from pathlib import Path

from tests.calibration.setups.setups import described
from tests.calibration.setups.two_arms import TwoArms, described_torso

from handeye.arrays import Array
from handeye.calibration.arm.measurements import Instrument
from handeye.calibration.arm.sheet import ArmSheet, CurveTerms
from handeye.calibration.setups.description import Description, load_description
from handeye.calibration.setups.fit import MixedFit, fit_measurements
from handeye.geometry import invert, transform

PLAIN = ArmSheet(compliance=0.0, curves=CurveTerms(0, 0))
END = "arm: {compliance: 0}\ncurves: {own: 0, others: 0}\n"


def fitted(setup: Description) -> MixedFit:
    return fit_measurements(setup.arm, setup.measurements, setup.sheet)


def of_case(case: str, folder: Path) -> tuple[Description, MixedFit]:
    described(case, folder, 5)
    setup = load_description(folder / "setup.yaml")
    return setup, fitted(setup)


def described_few(folder: Path) -> Description:
    """Two arms, one of them at a few poses alone."""
    rows = {"left": 12, "right": 30, "sees left": 30}
    return load_description(described_torso(folder, TwoArms(0, PLAIN), rows, END))


def places(fit: MixedFit, one: Instrument, joints: Array) -> Array:
    """Where the first of the points is before the sensor, (N, 3)."""
    sight, A = one.sight, fit.flanges(joints, one.link, one.base)
    before = A if sight.setup == "eye_to_hand" else invert(A)
    T = invert(sight.sensor.reference) @ before @ sight.target.reference
    return transform(T, sight.points.reference[0])
