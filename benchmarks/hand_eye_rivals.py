"""What the hand-eye benchmark compares with beside kinhec's own solvers, and its robots."""

from collections.abc import Callable, Iterator

import cv2
import numpy as np
from kinhec.kinematics import forward_kinematics_batch, geometric_jacobian
from kinhec.robots import get_robot

from handeye.geometry import invert, make_pose


class Arm:
    """A robot of kinhec as an `handeye.robots.arm.Arm`."""

    reach = 1.0

    def __init__(self, name: str) -> None:
        self.name = name
        self.robot = get_robot(name)
        self.joint_names = tuple(f"q{i + 1}" for i in range(self.robot.dof))
        self.lower, self.upper = np.array(self.robot.q_min), np.array(self.robot.q_max)
        self.held = np.zeros(self.robot.dof, np.bool_)

    def poses(self, joints: np.ndarray) -> np.ndarray:
        """As `handeye.robots.arm.Arm`."""
        return forward_kinematics_batch(self.robot, joints)

    def jacobians(self, joints: np.ndarray) -> np.ndarray:
        """As `handeye.robots.arm.Arm`."""
        return np.stack([geometric_jacobian(self.robot, q) for q in joints])


def opencv(A: np.ndarray, B: np.ndarray) -> Iterator[tuple[str, Callable[[], np.ndarray]]]:
    """OpenCV's solvers of A X = Z B, all as eye in hand: A X B^-1 = Z."""
    seen = invert(B)

    def of_hand_eye(method: int) -> np.ndarray:
        R, t = cv2.calibrateHandEye(
            list(A[:, :3, :3]),
            list(A[:, :3, 3]),
            list(seen[:, :3, :3]),
            list(seen[:, :3, 3]),
            method=method,
        )
        return make_pose(R, np.ravel(t))

    def of_robot_world(method: int) -> np.ndarray:
        back = invert(A)
        *_, R, t = cv2.calibrateRobotWorldHandEye(
            list(seen[:, :3, :3]),
            list(seen[:, :3, 3]),
            list(back[:, :3, :3]),
            list(back[:, :3, 3]),
            method=method,
        )
        return invert(make_pose(R, np.ravel(t)))

    for name in ("TSAI", "PARK", "HORAUD", "ANDREFF", "DANIILIDIS"):
        method = getattr(cv2, f"CALIB_HAND_EYE_{name}")
        yield f"OpenCV {name}", lambda method=method: of_hand_eye(method)
    for name in ("SHAH", "LI"):
        method = getattr(cv2, f"CALIB_ROBOT_WORLD_HAND_EYE_{name}")
        yield f"OpenCV {name}", lambda method=method: of_robot_world(method)
