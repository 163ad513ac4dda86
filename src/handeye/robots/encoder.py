"""A joint's encoder: what it reads against where the axis really is."""

from dataclasses import dataclass

import numpy as np

from handeye.arrays import Array


@dataclass(frozen=True)
class AxisEncoder:
    """An offset, and a periodic error that grows with the angle as in gears and traction drives.

    The error at angle q is `amplitude q sin(frequency q + phase)` (eq 3.33, 3.35, 3.36).
    offset, phase [rad]; amplitude and frequency are numbers. The offset may be an array (N,), one
    for each of N trials of a drifting axis.
    """

    offset: float | Array = 0.0
    amplitude: float = 0.0
    frequency: float = 1.0
    phase: float = 0.0

    def error(self, angle: Array) -> Array:
        """The periodic error [rad] at angle [rad]."""
        return self.amplitude * angle * np.sin(self.frequency * angle + self.phase)

    def actual(self, reading: Array) -> Array:
        """Where the axis is at a reading, which also sets the error (eq 3.37, 3.38)."""
        return reading + self.offset + self.error(reading)

    def reading(self, actual: Array) -> Array:
        """What is read with the axis at `actual`, which also sets the error (eq 3.34)."""
        return actual - self.offset + self.error(actual)
