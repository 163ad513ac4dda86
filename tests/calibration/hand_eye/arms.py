"""A small arm of four joints, as it should be and as it was built."""

import numpy as np
from scipy.spatial.transform import Rotation

from handeye.arrays import Array
from handeye.geometry import make_pose

_AXES = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
_STEPS = np.array([[0.0, 0.0, 0.3], [0.0, 0.05, 0.4], [0.1, 0.0, 0.3], [0.0, 0.02, 0.1]])


class Wrist:
    """Joints turn about z, y, x and y; links of 0.1 to 0.4 m, and what `errors` (4, 6) add to each.

    errors: rotation vector [rad] and shift [m] of each link, in the frame behind its joint
    """

    name = "wrist"
    joint_names = ("a", "b", "c", "d")
    lower = np.full(4, -np.pi)
    upper = np.full(4, np.pi)
    reach = 1.1
    held = np.zeros(4, np.bool_)

    def __init__(self, errors: Array | None = None) -> None:
        self.errors = np.zeros((4, 6)) if errors is None else errors

    def poses(self, joints: Array) -> Array:
        return self._frames(joints)[-1]

    def jacobians(self, joints: Array) -> Array:
        frames = self._frames(joints)
        out = np.empty((len(joints), 6, 4))
        for i in range(4):
            axis = frames[i][:, :3, :3] @ _AXES[i]
            out[:, 3:, i] = axis
            out[:, :3, i] = np.cross(axis, frames[-1][:, :3, 3] - frames[i][:, :3, 3])
        return out

    def _frames(self, joints: Array) -> list[Array]:
        frames = [np.tile(np.eye(4), (len(joints), 1, 1))]
        for i in range(4):
            turn = Rotation.from_rotvec(joints[:, i, None] * _AXES[i]).as_matrix()
            bent = Rotation.from_rotvec(self.errors[i, :3]).as_matrix()
            link = make_pose(bent, bent @ _STEPS[i] + self.errors[i, 3:])
            frames.append(frames[-1] @ make_pose(turn, np.zeros(3)) @ link)
        return frames
