"""Angles on the circle."""

import numpy as np

from handeye.arrays import Array


def wrap(radians: Array) -> Array:
    """The same angle in (-pi, pi] (note E2), elementwise."""
    return np.pi - np.mod(np.pi - radians, 2.0 * np.pi)
