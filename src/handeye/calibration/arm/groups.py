"""Which unknowns of an arm share the width of their prior."""

import numpy as np

from handeye.arrays import Integers
from handeye.calibration.arm.kernels import SerialArm

# Harmonics up to each of these share it.
_BANDS = (1, 2, 4, 8, 16, 24, 32, 48, 64, 96, 128)


def prior_groups(kernel: SerialArm) -> Integers:
    """Numbers of the groups of an arm's unknowns, those of its base and marker left out.

    Lengths, directions, zeros, scales and compliances of all joints are a group each; so is each
    band of harmonics of one joint's error along or about its own axis, or across it.
    """
    keys: list[tuple[object, ...]] = []
    for slides in kernel.slides.tolist():
        zero = "lengths" if slides else "zeros"
        keys += [("lengths",)] * 3 + [("directions",)] * 2 + [(zero,), ("scales",)]
        keys += [("compliances",)] * kernel.compliant
    terms: list[list[int]] = kernel.terms.tolist()
    for joint, component, harmonic in terms:
        turns, along = divmod(component, 3)
        band = int(np.searchsorted(_BANDS, harmonic))
        keys += [(joint, turns, along == 2, band)] * 2
    numbers = {key: i for i, key in enumerate(dict.fromkeys(keys))}
    return np.array([numbers[key] for key in keys], np.int64)
