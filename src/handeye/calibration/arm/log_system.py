"""All observations of a log as one system of equations, for a marker seen by a fixed sensor."""

from collections.abc import Iterator

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array
from handeye.calibration.arm.evidence import Rows
from handeye.calibration.arm.groups import prior_groups
from handeye.calibration.arm.kernels import SerialArm, joint_at
from handeye.calibration.arm.residuals import measured_at, misfit

_CHUNK = 256


class LogSystem:
    """A `System` with the unknowns of the kernel, in its order.

    Positions are one channel, and orientations, where they are seen, another. How wide the priors
    of base and marker are is not in question.

    Args:
        kernel: the arm.
        tolerance: (n_x,) of its unknowns.
        seen: (N, w) observations as the kernel reads them.
    """

    def __init__(self, kernel: SerialArm, tolerance: Array, seen: Array) -> None:
        self.kernel, self.tolerance, self.seen = kernel, tolerance, seen
        frames = np.full(joint_at(kernel, 0), -1)
        self.groups = np.concatenate([frames, prior_groups(kernel)])
        self.n_rows = len(seen)
        self.n_channels = 2 if kernel.oriented else 1

    def rows(self, x: Array, *, slopes: bool = True) -> Iterator[Rows]:
        """All equations at x (n_x,), some rows at a time; without `slopes` these are empty."""
        k, at = 3 * self.n_channels, measured_at(self.kernel) + 3
        channels = np.arange(k) // 3
        for first in range(0, self.n_rows, _CHUNK):
            some = self.seen[first : first + _CHUNK]
            values = np.empty((len(some), k))
            by = np.empty((len(some) if slopes else 1, k, len(x)))
            misfits(self.kernel, x, some, values, by)
            std = np.zeros_like(values)
            std[:, :3] = some[:, at : at + 3]
            yield Rows(values, by if slopes else by[:0], std, channels, first)


@compiled
def misfits(kernel: SerialArm, x: Array, seen: Array, values: Array, slopes: Array) -> None:
    """`misfit` for rows seen (N, w): values (N, k) and slopes (N, k, n_x), overwritten.

    slopes may hold one row only, which is then overwritten by each.
    """
    for i in range(len(seen)):
        misfit(kernel, x, seen[i], values[i], slopes[min(i, len(slopes) - 1)])
