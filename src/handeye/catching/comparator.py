"""Surprise: how far what was observed is from what was predicted (section 4.4.1, Comparators)."""

from dataclasses import dataclass

import numpy as np

from handeye.arrays import Array, count, finite
from handeye.errors import InvalidInput


@dataclass(frozen=True)
class Comparator:
    """Compares predicted with observed signatures over the latest ticks.

    The discrepancy of one tick is the root mean square over the channels of
    (predicted - observed) / threshold; surprise is its root mean square over the latest ticks. A
    surprise of 1 means that, on average, predictions miss by their thresholds: from there on the
    streams are taken not to agree.

    thresholds  per channel, in the units of that channel (the thesis states none, note E10)
    window      ticks looked back at; ten in the thesis
    fewest      comparisons that count as enough data

    Raises:
        InvalidInput: a threshold that is not positive, or a window shorter than `fewest`.
    """

    thresholds: tuple[float, ...]
    window: int = 10
    fewest: int = 3

    def __post_init__(self) -> None:
        if not np.all(finite(self.thresholds, "thresholds") > 0.0):
            raise InvalidInput(f"thresholds must be positive, got {self.thresholds}")
        if count(self.window, "window") < count(self.fewest, "fewest"):
            raise InvalidInput(f"window must hold at least {self.fewest} ticks, got {self.window}")

    def discrepancy(self, predicted: Array, observed: Array) -> Array:
        """Of one tick, (N,), from channels (N, m); NaN where there was no prediction."""
        scaled = (predicted - observed) / np.asarray(self.thresholds)
        return np.sqrt(np.mean(scaled * scaled, axis=1))

    def surprise(self, discrepancies: Array) -> Array:
        """Over the latest ticks, (N,), from discrepancies (window, N); NaN without enough data."""
        compared = ~np.isnan(discrepancies)
        number = compared.sum(axis=0)
        # Row by row, so that a trial's sum does not depend on how many trials there are.
        total = np.zeros(discrepancies.shape[1])
        for row in np.where(compared, discrepancies, 0.0):
            total += row * row
        mean = total / np.maximum(number, 1)
        return np.where(number >= self.fewest, np.sqrt(mean), np.nan)
