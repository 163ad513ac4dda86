"""Which unknowns of an arm share the width of their prior, and which can be seen at all."""

import numpy as np

from handeye.arrays import Array, Booleans, Integers
from handeye.calibration.arm.kernels import SerialArm, joint_width

# Harmonics up to each of these share it.
_BANDS = (1, 2, 4, 8, 16, 24, 32, 48, 64, 96, 128)

# Numbers that were measured for each unknown of a curve, at least; and of so many harmonics of a
# joint one is offered across its axis, in each of five components.
_NUMBERS, _FOR_OTHERS = 3, 10


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


def shown_by(kernel: SerialArm, numbers: int) -> Booleans:
    """Unknowns of an arm, base and marker left out, that so many measured numbers can show.

    As `shown_of`, where every number depends on every joint.
    """
    n = len(kernel.slides)
    return shown_of(kernel, np.full(n, numbers / max(n, 1)))


def shown_of(kernel: SerialArm, numbers: Array) -> Booleans:
    """The same with each joint's share (n,) of the measured numbers.

    Constants, and as many harmonics as there are numbers for: finer waves would run through any
    few. Those along or about a joint's own axis come first.
    """
    waves = numbers // (2 * _NUMBERS)
    others = waves // _FOR_OTHERS
    joint, component, harmonic = kernel.terms.T
    along = component == np.where(kernel.slides[joint], 2, 5)
    # What the components across leave unused is for the one along.
    offered = int(harmonic[~along].max(initial=0))
    used = np.minimum(others, offered)
    most = np.where(along, (waves - 5 * used)[joint], others[joint])
    constants = len(kernel.slides) * joint_width(kernel)
    return np.concatenate([np.ones(constants, np.bool_), np.repeat(harmonic <= most, 2)])
