"""A serial chain with small errors in every joint, the way NumPy has it: arrays (N, 4, 4)."""

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from handeye.arrays import Array
from handeye.calibration.placement import Placement
from handeye.geometry import make_pose
from handeye.robots.stages import Stages

_JOINT = 7  # shift and turn of its placement, and its scale


class PlainChain:
    """Positions (N, 3) of a marker at joints (N, n) as a function of unknowns (9 + 7 n,).

    Unknowns are shift and turn of the base, the marker's shift, and of each joint shift and turn
    of its placement and its scale, as the compiled chain orders them.
    """

    def __init__(self, stages: Stages, placement: Placement, joints: Array) -> None:
        self.stages, self.placement, self.joints = stages.upright(), placement, joints

    def __call__(self, x: Array) -> Array:
        """Positions (N, 3) in the sensor's frame [m]."""
        n = self.joints.shape[1]
        T: Any = self.placement.T_sensor_base @ _small(x[:6])
        for j in range(n):
            own = x[9 + _JOINT * j : 9 + _JOINT * (j + 1)]
            T = T @ (self.stages.placements[j] @ _small(own[:6])) @ self._moved(j, 1.0 + own[6])
        lever = self.placement.T_flange_marker[:3, 3] + x[6:9]
        return (T @ self.stages.placements[n])[:, :3] @ np.append(lever, 1.0)

    def screws(self) -> Array:
        """Axes of the joints at rest in the sensor's frame, (n, 6): moment, then direction."""
        T, out = self.placement.T_sensor_base, np.empty((self.joints.shape[1], 6))
        for j, screw in enumerate(out):
            T = T @ self.stages.placements[j]
            screw[:3], screw[3:] = np.cross(T[:3, 3], T[:3, 2]), T[:3, 2]
        return out

    def rest(self) -> Array:
        """The marker (4, 4) in the sensor's frame with all joints at zero."""
        ways = [self.placement.T_sensor_base, *self.stages.placements]
        return np.linalg.multi_dot([*ways, self.placement.T_flange_marker])

    def _moved(self, j: int, scale: float) -> Array:
        """Turn or slide along z (N, 4, 4)."""
        q = scale * self.joints[:, j]
        out = np.tile(np.eye(4), (len(q), 1, 1))
        if self.stages.slides[j]:
            out[:, 2, 3] = q
        else:
            out[:, 0, 0] = out[:, 1, 1] = np.cos(q)
            out[:, 1, 0] = np.sin(q)
            out[:, 0, 1] = -out[:, 1, 0]
        return out


def _small(twist: Array) -> Array:
    return make_pose(Rotation.from_rotvec(twist[3:]).as_matrix(), twist[:3])
