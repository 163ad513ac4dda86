"""Any arm whose hand is located in space by a camera or tracker that stands still."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from handeye.arrays import Array, shaped
from handeye.calibration.models import Correct
from handeye.calibration.placement import Placement
from handeye.errors import InvalidInput
from handeye.geometry import matrix_from_wxyz
from handeye.networks.inputs import InputSpace
from handeye.observations import PointObservation, PointTarget
from handeye.robots.arm import Arm

_ITERATIONS = 200
_ARRIVED = 1e-7  # [m], far below what any sensor resolves
_REACHED = 1e-5  # [m], still below it: good enough where the arm is nearly stretched
_DAMPING = 1e-3  # of the reach: limits the step near singular postures
_LARGEST_STEP = 0.3  # [rad], so that the arm stays on the side of its posture


@dataclass(frozen=True, eq=False)
class PlacedArm:
    """Nominal kinematics of an arm between a placed sensor and a placed marker.

    Inputs of the correction: the joint angles. Corrections: displacement of the marker from where
    the model puts it, in the sensor's frame, measured minus predicted [m].

    low, high   the joint angles in which the robot works, (n,) [rad]: the box of the inputs
    resolution  errors below this are not worth learning [m]
    turn_std    standard deviation of measured orientations [rad]; None where none are measured
    noise       standard deviation of measured positions that state none [m]
    """

    arm: Arm
    placement: Placement
    low: Array
    high: Array
    resolution: float = 1e-4
    turn_std: float | None = None
    noise: float = 0.0

    @property
    def space(self) -> InputSpace:
        """The working range of the joints; distances in radians."""
        return InputSpace.box(self.low, self.high)

    @property
    def n_outputs(self) -> int:
        """x, y and z."""
        return 3

    def features(self, observations: PointObservation) -> Array:
        """Joint angles (N, n)."""
        return observations.joints

    def needed(self, observations: PointObservation) -> Array:
        """Measured minus predicted positions (N, 3)."""
        return observations.position - self.placement.predict(self.arm, observations.joints)

    def displacement(self, observations: PointObservation, errors: Array) -> Array:  # noqa: ARG002
        """The errors themselves (N, 3)."""
        return errors

    def turn_errors(self, observations: PointObservation) -> Array | None:
        """Rotation vectors (N, 3) from predicted to measured orientations, in the marker's frame.

        None where none was measured.
        """
        if observations.orientation is None:
            return None
        measured = Rotation.from_matrix(matrix_from_wxyz(observations.orientation))
        base, marker = self.placement.T_sensor_base, self.placement.T_flange_marker
        predicted = base @ self.arm.poses(observations.joints) @ marker
        return (Rotation.from_matrix(predicted[:, :3, :3]).inv() * measured).as_rotvec()

    def command(self, targets: PointTarget, correct: Correct) -> Array:
        """Joints (N, n), near each target's posture, whose corrected prediction is the target.

        Damped Gauss-Newton, `dq = J^T (J J^T + damping^2 I)^-1 e`, with the Jacobian of the model
        (the correction is small and smooth) and the joints kept within their limits.

        Raises:
            InvalidInput: naming the targets that cannot be reached from their postures.
        """
        posture = shaped(targets.posture, (None, len(self.arm.joint_names)), "posture")
        held = self.arm.held
        low, high = np.where(held, -np.inf, self.arm.lower), np.where(held, np.inf, self.arm.upper)
        joints = np.clip(posture, low, high)
        missed = np.full(len(joints), np.inf)
        for _ in range(_ITERATIONS):
            predicted = self.placement.predict(self.arm, joints) + correct(joints)
            error = targets.position - predicted
            missed = np.linalg.norm(error, axis=1)
            going = missed > _ARRIVED
            if not going.any():
                return joints
            step = self._step(joints[going], error[going])
            joints[going] = np.clip(joints[going] + step, low, high)
        far = np.flatnonzero(missed > _REACHED)
        if far.size:
            listed = ", ".join(f"{i + 1} (by {missed[i]:.3g} m)" for i in far[:5])
            more = f" and {far.size - 5} more" if far.size > 5 else ""
            raise InvalidInput(
                f"{self.arm.name} cannot bring the marker to target {listed}{more}: it is out of "
                "reach or beyond a joint limit; give a position in reach or a posture nearer to it"
            )
        return joints

    def _step(self, joints: Array, error: Array) -> Array:
        """Change of joints (N, n) that reduces position errors (N, 3) in the sensor's frame."""
        poses, jacobians = self.arm.poses(joints), self.arm.jacobians(joints)
        lever = poses[:, :3, :3] @ self.placement.T_flange_marker[:3, 3]
        moved = jacobians[:, :3] + np.cross(
            jacobians[:, 3:], lever[:, :, np.newaxis], axisa=1, axisb=1, axisc=1
        )
        J = self.placement.T_sensor_base[:3, :3] @ moved
        J[:, :, self.arm.held] = 0.0
        damping = (_DAMPING * self.arm.reach) ** 2
        solved = np.linalg.solve(
            J @ J.transpose(0, 2, 1) + damping * np.eye(3), error[:, :, np.newaxis]
        )
        step = (J.transpose(0, 2, 1) @ solved)[:, :, 0]
        largest = np.abs(step).max(axis=1, keepdims=True)
        return step * np.minimum(1.0, _LARGEST_STEP / np.maximum(largest, _LARGEST_STEP))
