"""What learning reports."""

from typing import NamedTuple

from handeye.arrays import Array, Booleans
from handeye.errors import HandeyeError


class Learned(NamedTuple):
    """What one sample taught.

    error      target - output before learning, (m,)
    allocated  whether a neuron was added for it
    """

    error: Array
    allocated: bool


class LearnedMany(NamedTuple):
    """The same for N samples in order: error (N, m), allocated (N,)."""

    error: Array
    allocated: Booleans


class LearningDiverged(HandeyeError):
    """The adaptation rule drove the output out of all bounds; the learning rate is too large."""
