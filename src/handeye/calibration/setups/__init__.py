"""Set-ups that a YAML file describes: an arm and every instrument around it, in one fit."""

from handeye.calibration.setups.description import load_description as load_description
from handeye.calibration.setups.fit import fit_measurements as fit_measurements
