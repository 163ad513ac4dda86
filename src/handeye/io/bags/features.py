"""Numbers of which the position of what is seen is a linear function."""

from collections.abc import Callable
from typing import Protocol

import numpy as np

from handeye.arrays import Array, Integers

Features = Callable[[Array], Array]
"""Joint angles (N, n) to features (N, k)."""

KINEMATIC = 16


class Kinematics(Protocol):
    """What is needed of an arm."""

    @property
    def joint_names(self) -> tuple[str, ...]:
        """In the order of joint arrays."""
        ...

    def poses(self, joints: Array) -> Array:
        """T_base_flange (N, 4, 4) at joints (N, n)."""
        ...


def kinematic(arm: Kinematics) -> Features:
    """(t, R, R^T t, 1) of T_base_flange = (R, t), 16 numbers.

    For a sensor that stands still the marker on the hand is at R_x (R m + t) + t_x; for a sensor
    on the hand a marker that stands still is at R_x (R^T (m - t)) + t_x. Both are linear in these,
    whatever the frames.
    """

    def features(angles: Array) -> Array:
        poses = arm.poses(angles)
        R, t = poses[:, :3, :3], poses[:, :3, 3]
        back = np.einsum("nij,ni->nj", R, t)
        return np.hstack([t, R.reshape(-1, 9), back, np.ones((len(t), 1))])

    return features


def harmonic(joints: Integers, *, products: bool) -> Features:
    """1 and the cosines and sines of the joints of these indices, without knowing the arm.

    With `products` also those of two different joints. The position of a marker moved by turning
    joints is a sum of such products of up to n of them; these are its first terms.
    """

    def features(angles: Array) -> Array:
        waves = np.stack([np.cos(angles[:, joints]), np.sin(angles[:, joints])], axis=2)
        rows, n = len(angles), len(joints)
        columns = [np.ones((rows, 1)), waves.reshape(rows, -1)]
        if products:
            columns += [
                np.einsum("ni,nj->nij", waves[:, a], waves[:, b]).reshape(rows, -1)
                for a in range(n)
                for b in range(a + 1, n)
            ]
        return np.hstack(columns)

    return features
