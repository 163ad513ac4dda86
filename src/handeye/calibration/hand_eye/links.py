"""An arm whose links are not quite what its model says.

Every link may be bent and stretched a little: with K_i(q) a frame that is fixed to link i at its
joint, the flange stands at

    A = K_1 D_1 K_1^-1  K_2 D_2 K_2^-1 ... K_m D_m K_m^-1  A_model(q)

where D_i is the small constant pose by which link i departs from the model. It holds all geometric
errors of a serial arm: joint offsets, lengths, and tilted axes. The last link is left out, for it
cannot be told from where camera or target sit on the flange, and neither can the base.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np

from handeye.arrays import Array
from handeye.calibration.hand_eye.turns import cross_matrix
from handeye.geometry import invert, make_pose
from handeye.robots.arm import Arm

# A joint whose turn is below this moves no orientation: it slides [rad/rad].
_SLIDES = 1e-9


@dataclass(frozen=True, eq=False)
class Links:
    """The links of an arm in N configurations.

    frames         K_i (m, N, 4, 4)
    inverses       K_i^-1 (m, N, 4, 4)
    model_flanges  A_model (N, 4, 4)
    by_joints      (N, 6, n) the flange's turn and shift, in axes of the base, per turn of a joint
    """

    frames: Array
    inverses: Array
    model_flanges: Array
    by_joints: Array

    @classmethod
    def of(cls, arm: Arm, joints: Array) -> Self:
        """The links of an arm at joints (N, n), from its poses and Jacobians alone.

        With the joints beyond the i-th at zero, the pose of the flange is a frame fixed to link i.
        Its origin goes to the point of joint i's axis that is next to it.
        """
        n = joints.shape[1]
        rest = arm.jacobians(np.zeros((1, n)))[0]
        at_rest = arm.poses(np.zeros((1, n)))[0]
        frames = np.empty((n - 1, len(joints), 4, 4))
        for i in range(n - 1):
            held = joints.copy()
            held[:, i + 1 :] = 0.0
            shift, axis = rest[:3, i], rest[3:, i]
            size = float(axis @ axis)
            to_axis = np.cross(axis, shift) / size if size > _SLIDES else np.zeros(3)
            frames[i] = arm.poses(held) @ make_pose(np.eye(3), at_rest[:3, :3].T @ to_axis)
        by_joints = arm.jacobians(joints)[:, [3, 4, 5, 0, 1, 2]]
        return cls(frames, invert(frames), arm.poses(joints), by_joints)

    @property
    def count(self) -> int:
        """m, one less than the joints."""
        return len(self.frames)

    def flanges(self, departures: Array) -> Array:
        """A (N, 4, 4) for departures D (m, 4, 4)."""
        flanges = self.model_flanges
        for i in reversed(range(self.count)):
            flanges = self._bend(i, departures) @ flanges
        return flanges

    def jacobian(self, departures: Array) -> Array:
        """Turn and shift (N, 6, 6 m) of the flange in axes of the base.

        Per turn D <- (exp(d) R, b) and shift D <- (R, b + d) of each departure.
        """
        m = self.count
        out = np.empty((len(self.model_flanges), 6, 6 * m))
        beyond = [self.model_flanges]
        for i in range(m - 1, 0, -1):
            beyond.append(self._bend(i, departures) @ beyond[-1])
        before = np.broadcast_to(np.eye(4), self.model_flanges.shape)
        for i in range(m):
            lead = before @ self.frames[i]
            arm = (self.inverses[i] @ beyond[m - 1 - i])[:, :3, 3] @ departures[i, :3, :3].T
            R = lead[:, :3, :3]
            block = out[:, :, 6 * i : 6 * i + 6]
            block[:, :3, :3] = R
            block[:, 3:, :3] = -R @ cross_matrix(arm)
            block[:, :3, 3:] = 0.0
            block[:, 3:, 3:] = R
            before = before @ self._bend(i, departures)
        return out

    def _bend(self, i: int, departures: Array) -> Array:
        """K_i D_i K_i^-1 (N, 4, 4)."""
        return self.frames[i] @ departures[i] @ self.inverses[i]
