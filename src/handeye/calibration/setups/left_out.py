"""How well measurements of any kinds are predicted that had no part in a fit."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, Self

import numpy as np

from handeye.arrays import Array, Booleans, Integers, count
from handeye.calibration.arm.measurements import Instrument
from handeye.calibration.arm.sheet import ArmSheet
from handeye.calibration.results import ErrorSummary
from handeye.calibration.setups.fit import MixedFit, fit_measurements, residuals
from handeye.errors import InvalidInput
from handeye.robots.urdf import UrdfArm

FOLDS = 5
"""Blocks of rows, each left out once."""

# Median length of a normally distributed k-vector whose components have standard deviation 1.
_MEDIAN_LENGTH = {1: 0.674, 2: 1.177, 3: 1.538}
# So much of an ordinary error, at least, is none of the instrument's: no row is exact.
_OWN, _SMALLEST = 0.3, 1e-12


class ChannelErrors(NamedTuple):
    """What the values of one channel are off, in its unit, in N rows of all measurements.

    before, after    (N, k) measured minus predicted, of the arm as its model says, and as fitted
    measurement, row (N,) which measurement, and which of its rows
    block            (N,) rows of the same block were left out together
    times            (N,) the length of `after` over what is ordinary, 1
    unit             of the values
    """

    before: Array
    after: Array
    measurement: Integers
    row: Integers
    block: Integers
    times: Array
    unit: str

    def medians(self) -> tuple[float, float]:
        """Middle lengths before and after, in the unit: a wild row does not count in them."""
        before, after = (np.linalg.norm(one, axis=1) for one in (self.before, self.after))
        return float(np.median(before)), float(np.median(after))

    def only(self, which: Booleans) -> Self:
        """Some of the rows (N,)."""
        columns: list[Any] = [column[which] for column in self[:-1]]
        return self._replace(**dict(zip(self._fields[:-1], columns, strict=True)))

    def summaries(self) -> tuple[ErrorSummary, ErrorSummary]:
        """Statistics of the lengths before and after, in the unit."""
        return ErrorSummary.of(self.before, self.block), ErrorSummary.of(self.after, self.block)


def left_out(
    arm: UrdfArm,
    measurements: Sequence[Instrument],
    sheet: ArmSheet | None = None,
    folds: int = FOLDS,
    *,
    placed: Sequence[Instrument] | None = None,
    after_each: Callable[[int, int], None] | None = None,
) -> dict[str, ChannelErrors]:
    """By channel, errors on each of several blocks of rows when the others are fitted.

    placed: the measurements with frames and points where the errors of the nominal arm are taken,
    by default where they have them: placed by all rows.
    after_each(block, folds) is called after each block.

    Raises:
        InvalidInput: fewer than two folds, or so few rows that one is empty.
    """
    n = count(folds, "folds", least=2)
    numbers = [one.folds(n) for one in measurements]
    for one, number in zip(measurements, numbers, strict=True):
        if set(number.tolist()) != set(range(n)):
            raise InvalidInput(
                f"every measurement needs rows in each of {n} blocks, and {one.what} has poses in "
                f"{len(set(number.tolist()))}: measure more, or hold fewer out, or none"
            )
    parts: dict[str, list[ChannelErrors]] = {}
    for fold in range(n):
        held = [np.flatnonzero(number == fold) for number in numbers]
        kept = [
            one.only(np.flatnonzero(number != fold))
            for one, number in zip(measurements, numbers, strict=True)
        ]
        fit = fit_measurements(arm, kept, sheet)
        for channel, part in _judged(fit, placed or measurements, held, fold).items():
            parts.setdefault(channel, []).extend(part)
        if after_each is not None:
            after_each(fold + 1, n)
    return _together(parts)


def fitted(fit: MixedFit, placed: Sequence[Instrument] | None = None) -> dict[str, ChannelErrors]:
    """The same on all rows, which had a part in the fit: smaller than on others."""
    every = [np.arange(len(one.joints)) for one in fit.given]
    return _together(_judged(fit, placed or fit.given, every, 0))


def _judged(
    fit: MixedFit, placed: Sequence[Instrument], rows: Sequence[Integers], block: int
) -> dict[str, list[ChannelErrors]]:
    """Errors on some rows of each measurement, by channel."""
    out: dict[str, list[ChannelErrors]] = {}
    held = [one.only(some) for one, some in zip(placed, rows, strict=True)]
    found = fit.unknowns
    for i, one in enumerate(held):
        there = one.given({u.name: found[u.name] for u in one.unknowns if u.name in found})
        nominal = fit.problem.arm.between(one.link, one.base)
        before = residuals(one, nominal.poses(one.joints))
        after = residuals(there, fit.flanges_of(one))
        channels = np.array(one.channels)
        for channel, errors in after.items():
            n, stated = len(errors), one.std[:, channels == channel]
            out.setdefault(channel, []).append(
                ChannelErrors(
                    before[channel], errors, np.full(n, i), rows[i], np.full(n, block),
                    np.sqrt(np.mean(stated**2, axis=1)), one.units[one.channels.index(channel)],
                )
            )  # fmt: skip
    return out


def _together(parts: dict[str, list[ChannelErrors]]) -> dict[str, ChannelErrors]:
    """The parts of each channel as one, by measurement and row; `times` was what rows state."""
    out: dict[str, ChannelErrors] = {}
    for channel, some in parts.items():
        columns: list[Any] = [np.concatenate(c) for c in list(zip(*some, strict=True))[:-1]]
        order = np.lexsort([columns[3], columns[2]])
        before, after, measurement, row, block, stated = (column[order] for column in columns)
        whole = ChannelErrors(before, after, measurement, row, block, stated, some[0].unit)
        out[channel] = whole._replace(times=_times(after, stated))
    return out


def _times(errors: Array, stated: Array) -> Array:
    """Lengths (N,) of errors (N, k) over what is ordinary: their median, where all state the same.

    The ordinary variance is what is stated and as much more as the median length shows.
    """
    lengths, middle = np.linalg.norm(errors, axis=1), _MEDIAN_LENGTH[errors.shape[1]]
    seen = float(np.median(lengths)) / middle
    beyond = max(seen**2 - float(np.median(stated)) ** 2, (_OWN * seen) ** 2)
    return lengths / np.maximum(middle * np.sqrt(beyond + stated**2), _SMALLEST)
