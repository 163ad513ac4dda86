"""All observations of a log as one system of equations, for a marker seen by a fixed sensor."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array
from handeye.calibration.arm.groups import prior_groups, shown_by
from handeye.calibration.arm.kernels import SerialArm, joint_at, pose
from handeye.calibration.arm.residuals import matrix_of, measured_at, misfit
from handeye.calibration.arm.rotations import turn_between
from handeye.calibration.arm.system import Rows

_CHUNK = 256
JUMP = 30.0
"""A part that changed may be so much farther from where it was than it can be from nominal."""


class Jump(NamedTuple):
    """Unknowns at `places` that were others before row `at`."""

    at: int
    places: tuple[int, ...]


class LogSystem:
    """A `System` with the unknowns of the kernel, in its order, then those of the jumps.

    Positions are one channel, and orientations, where they are seen, another. How wide the priors
    of base and marker are is not in question. A jump's unknowns are how much farther its part was
    from nominal before: so rows from before a change tell everything but what has changed.

    Args:
        kernel: the arm.
        tolerance: (n_x,) of its unknowns.
        seen: (N, w) observations as the kernel reads them.
        jumps: in the order of time.
    """

    def __init__(
        self, kernel: SerialArm, tolerance: Array, seen: Array, jumps: Sequence[Jump] = ()
    ) -> None:
        self.kernel = kernel
        self.jumps = tuple(jumps)
        self.n_arm = len(tolerance)
        frames = np.full(joint_at(kernel, 0), -1)
        changed = np.array([p for jump in jumps for p in jump.places], np.int64)
        self.groups = np.concatenate([frames, prior_groups(kernel), np.full(len(changed), -1)])
        of_arm = shown_by(kernel, len(seen) * (6 if kernel.oriented else 3))
        self.shown = np.concatenate([frames < 0, of_arm, np.ones(len(changed), np.bool_)])
        self.tolerance = np.concatenate([tolerance, JUMP * tolerance[changed]])
        self.n_rows = len(seen)
        self.n_channels = 2 if kernel.oriented else 1
        self._ends = [0, *(jump.at for jump in jumps), len(seen)]
        self.seen = seen

    def rows(self, x: Array, *, slopes: bool = True) -> Iterator[Rows]:
        """All equations at x (n,), some rows at a time; without `slopes` these are empty."""
        k, at = 3 * self.n_channels, measured_at(self.kernel) + 3
        channels = np.arange(k) // 3
        for epoch, (start, end) in enumerate(pairwise(self._ends)):
            here, doubled = self._in_epoch(x, epoch)
            for first in range(start, end, _CHUNK):
                some = self.seen[first : min(first + _CHUNK, end)]
                values = np.empty((len(some), k))
                by = np.zeros((len(some), k, len(x) if slopes else 0))
                if slopes:
                    misfits(self.kernel, here, some, values, by)
                    for column, place in doubled:
                        by[:, :, column] = by[:, :, place]
                else:
                    offsets(self.kernel, here, some, values)
                std = np.zeros_like(values)
                std[:, :3] = some[:, at : at + 3]
                yield Rows(values, by, std, channels, first)

    def _in_epoch(self, x: Array, epoch: int) -> tuple[Array, list[tuple[int, int]]]:
        """The arm's unknowns after so many jumps, and which column equals that of which place."""
        here, column = x[: self.n_arm].copy(), self.n_arm
        doubled: list[tuple[int, int]] = []
        for number, jump in enumerate(self.jumps):
            for place in jump.places:
                if number >= epoch:
                    here[place] += x[column]
                    doubled.append((column, place))
                column += 1
        return here, doubled


@compiled
def misfits(kernel: SerialArm, x: Array, seen: Array, values: Array, slopes: Array) -> None:
    """`misfit` for rows seen (N, w): values (N, k) and slopes (N, k, n_x or more), overwritten."""
    for i in range(len(seen)):
        misfit(kernel, x, seen[i], values[i], slopes[i])


@compiled
def offsets(kernel: SerialArm, x: Array, seen: Array, values: Array) -> None:
    """The same values (N, k) alone."""
    at = measured_at(kernel)
    T, R, K = np.empty((3, 4)), np.empty((3, 3)), np.empty((3, 3))
    for i in range(len(seen)):
        pose(kernel, x, seen[i], T)
        for c in range(3):
            values[i, c] = seen[i, at + c] - T[c, 3]
        if kernel.oriented:
            matrix_of(seen[i, at + 6 :], R)
            turn_between(T[:, :3], R, values[i, 3:], K)
