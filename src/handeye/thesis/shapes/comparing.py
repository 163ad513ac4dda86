"""What predicates compare: levels of learning curves, paired over replicates that share a world."""

import math

import numpy as np
from scipy.special import stdtrit

from handeye.arrays import Array
from handeye.thesis.records import Records

MARKS = 10
"""A level is the mean over so many marks at the end: a single one has the chance of its tests."""


def plateau(records: Records, path: str) -> Array:
    """The level that a curve ends with, (replicates,)."""
    _, values = records.curve(path)
    return values[:, -MARKS:].mean(axis=1)


def growth(records: Records, path: str) -> Array:
    """How many times its lowest point after the first mark a curve ends at, (replicates,)."""
    _, values = records.curve(path)
    return plateau(records, path) / values[:, 1:].min(axis=1)


def clearly_below(low: Array, high: Array) -> bool:
    """Whether low is below high, both (replicates,), by more than chance gives.

    Of the differences in each replicate the whole 95 % interval must be below zero; a single
    replicate has no interval, and its sign decides.
    """
    difference = low - high
    n = len(difference)
    if n < 2:
        return bool(difference[0] < 0.0)
    half = float(stdtrit(n - 1, 0.975)) * float(difference.std(ddof=1)) / math.sqrt(n)
    return bool(difference.mean() + half < 0.0)


def spread(levels: list[Array]) -> tuple[float, Array]:
    """Largest over smallest of several levels (replicates,), less one: of means and in each."""
    table = np.array(levels)
    means = table.mean(axis=1)
    each = table.max(axis=0) / table.min(axis=0) - 1.0
    return float(means.max() / means.min() - 1.0), each
