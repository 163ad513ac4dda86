"""Joint angles at the moments of measurements."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from handeye.arrays import Array, Booleans
from handeye.io.bags.tracks import Track, seconds

# Stamps are exact to the nanosecond; a tolerance that is one is met by a gap that is as long.
_ROUNDING = 1e-9


class Matched(NamedTuple):
    """Joint angles at N moments.

    angles        (N, n), NaN where there are none
    interpolated  (N,) between two samples within the tolerance
    nearest       (N,) from a single sample within the tolerance
    gap           (N,) time between the samples on both sides [s], inf before and after all
    """

    angles: Array
    interpolated: Booleans
    nearest: Booleans
    gap: Array

    @property
    def usable(self) -> Booleans:
        """Which moments have angles (N,)."""
        return self.interpolated | self.nearest


class JointSamples:
    """The angles of joints that are reported together, at M times [s] that increase.

    times   (M,)
    angles  (M, n) [rad] or [m]

    Where samples follow each other within the tolerance, angles between them are interpolated
    linearly; an angle that jumps by more than pi has gone round and is taken the short way.
    Where most do not, the poses were recorded one by one, and a sample itself counts for what
    was measured within the tolerance of it.
    """

    def __init__(self, times: Array, angles: Array, tolerance: float) -> None:
        self.times, self.angles = times, angles
        self.tolerance = tolerance + _ROUNDING
        gaps = np.diff(times)
        self.one_by_one = not len(gaps) or float(np.median(gaps)) > self.tolerance

    def at(self, moments: Array) -> Matched:
        """Angles (N, n) at moments (N,) [s]."""
        after = np.searchsorted(self.times, moments, side="left")
        last = len(self.times) - 1
        high = np.minimum(after, last)
        exact = self.times[high] == moments
        low = np.where(exact, high, np.clip(after - 1, 0, last))
        inside = exact | ((after > 0) & (after <= last))
        gap = np.where(inside, self.times[high] - self.times[low], np.inf)
        interpolated = gap <= self.tolerance
        to_low, to_high = moments - self.times[low], self.times[high] - moments
        close = np.where(np.abs(to_low) <= np.abs(to_high), low, high)
        near = np.abs(self.times[close] - moments) <= self.tolerance
        nearest = near & ~interpolated & self.one_by_one

        angles = np.full((len(moments), self.angles.shape[1]), np.nan)
        angles[nearest] = self.angles[close[nearest]]
        between = interpolated & ~exact
        share = to_low[between] / gap[between]
        angles[interpolated & exact] = self.angles[high[interpolated & exact]]
        angles[between] = _between(
            self.angles[low[between]], self.angles[high[between]], share[:, None]
        )
        return Matched(angles, interpolated, nearest, gap)

    def covers(self, start: Array, end: Array) -> Booleans:
        """Which spans from start to end (N,) [s] have no gap beyond the tolerance."""
        wide = np.concatenate([[0], np.cumsum(np.diff(self.times) > self.tolerance)])
        low = np.searchsorted(self.times, start, side="right") - 1
        high = np.searchsorted(self.times, end, side="left")
        inside = (low >= 0) & (high < len(self.times))
        return inside & (wide[np.clip(high, 0, len(wide) - 1)] == wide[np.maximum(low, 0)])


class JointMotion:
    """All joints of interest, in the order of `names`, at any moment."""

    def __init__(
        self,
        names: Sequence[str],
        tracks: Sequence[tuple[tuple[str, ...], Track]],
        start: int,
        tolerance: float,
    ) -> None:
        self._parts = [
            JointSamples(seconds(track.stamps, start), track.values, tolerance)
            for _, track in tracks
        ]
        together = [name for joints, _ in tracks for name in joints]
        self._order = [together.index(name) for name in names]
        travel = np.hstack([np.ptp(part.angles, axis=0) for part in self._parts])
        self.travel: Array = travel[self._order]

    @property
    def one_by_one(self) -> bool:
        """Whether joints were recorded pose by pose, not as a motion."""
        return any(part.one_by_one for part in self._parts)

    def at(self, moments: Array) -> Matched:
        """The angles of all joints at moments (N,) [s]."""
        parts = [part.at(moments) for part in self._parts]
        usable = np.all([part.usable for part in parts], axis=0)
        interpolated = usable & np.all([part.interpolated for part in parts], axis=0)
        return Matched(
            np.hstack([part.angles for part in parts])[:, self._order],
            interpolated,
            usable & ~interpolated,
            np.max([part.gap for part in parts], axis=0),
        )

    def covers(self, start: Array, end: Array) -> Booleans:
        """Which spans from start to end (N,) [s] have all joints interpolated throughout."""
        return np.all([part.covers(start, end) for part in self._parts], axis=0)


def _between(low: Array, high: Array, share: Array) -> Array:
    """(1 - s) low + s high; past a jump of a turn the short way, ending in (-pi, pi]."""
    step = high - low
    jumps = np.abs(step) > np.pi
    short = step - 2.0 * np.pi * np.round(step / (2.0 * np.pi))
    straight = low + share * np.where(jumps, short, step)
    wrapped = np.pi - np.mod(np.pi - straight, 2.0 * np.pi)
    return np.where(jumps, wrapped, straight)
