"""How near X could be found by a solver that is told how large every error is.

kinhec draws the errors of camera and arm from normal distributions that it knows: turns and shifts
of each pose, readings of joints, DH numbers of the arm. The solution of generalised least squares
with all these covariances is the best that can be expected of any solver. What stays is noise, and
errors of the last link, which look like another place of the camera.
"""

from dataclasses import replace
from typing import Any

import numpy as np
from kinhec.kinematics import forward_kinematics_batch
from kinhec.robots import get_robot

from handeye.arrays import Array, Integers
from handeye.calibration.hand_eye import noise
from handeye.calibration.hand_eye.model import Guess, Model
from handeye.calibration.hand_eye.samples import Samples
from handeye.calibration.hand_eye.turns import turned_by
from handeye.robots.arm import Arm

LENGTHS, ANGLES = ("a", "d"), ("alpha", "theta_offset")
STEP, ROUNDS, LEAST = 1e-6, 4, 1e-14


def known_noise(sequence: Any, row: Any, chosen: Integers, arm: Arm) -> Array | None:
    """X (4, 4) by all true covariances, from the samples that are right.

    None where errors are not normal, not independent, or the clocks of arm and camera differ.
    """
    camera, of_arm = sequence.config.camera_noise, sequence.config.robot_noise
    normal = camera["model"] == "se3_gaussian" and of_arm["student_t_dof"] is None
    normal &= camera["student_t_dof"] is None
    if not normal or not sequence.synchronous or row.scale != 1.0:
        return None
    A, S, valid = sequence.paired_measurements()
    A, S = A[valid], S[valid]
    keep = chosen[~sequence.camera.outlier[valid][chosen]]
    of_joints = sequence.robot.q_meas
    joints = np.empty((0, 0)) if of_joints is None else of_joints[valid][keep]
    model = Model(Samples.of(A[keep], S[keep], row.configuration, in_order=True))
    # The fit ends in the same place wherever it starts nearby.
    in_hand = row.configuration == "eye_in_hand"
    pair = (sequence.X, sequence.Y) if in_hand else (sequence.Y, sequence.X)
    guess = Guess(*pair, 1.0, np.zeros((0, 4, 4)))
    variances = np.zeros(8)
    variances[:3] = np.square(camera["rot_std_rad"])
    variances[3:6] = np.square(camera["trans_std_m"])
    if "se3_gaussian" in of_arm["models"]:
        variances[6:] = of_arm["rot_std_rad"] ** 2, of_arm["trans_std_m"] ** 2
    for _ in range(ROUNDS):
        by_flange = model.by_flange(guess)
        each = noise.covariances(variances, noise.carriers(by_flange, None)) + LEAST * np.eye(6)
        if "joint_gaussian" in of_arm["models"]:
            by_joints = by_flange @ arm.jacobians(joints)[:, [3, 4, 5, 0, 1, 2]]
            each += of_arm["joint_std_rad"] ** 2 * by_joints @ by_joints.swapaxes(1, 2)
        n = each.shape[0]
        C = np.zeros((n, 6, n, 6))
        C[np.arange(n), :, np.arange(n)] = each
        C = C.reshape(6 * n, 6 * n)
        if "dh_error" in of_arm["models"]:
            by_numbers = (by_flange @ _by_numbers(row.robot, joints)).reshape(6 * n, -1)
            stds = np.repeat([of_arm["dh_len_std_m"], of_arm["dh_ang_std_rad"]], 2 * row.dof)
            C += (by_numbers * stds**2) @ by_numbers.T
        root = np.linalg.cholesky(C)
        J = np.linalg.solve(root, model.jacobian(guess).reshape(6 * n, -1))
        r = np.linalg.solve(root, model.residuals(guess).reshape(-1))
        step = np.asarray(np.linalg.lstsq(J, r)[0], np.float64)
        guess = guess.moved(-step)
    return guess.camera if in_hand else guess.target


def _by_numbers(robot: str, joints: Array) -> Array:
    """Turn and shift (N, 6, 4 n) of the flange, in axes of the base, per change of a DH number."""
    nominal = get_robot(robot)
    here = forward_kinematics_batch(nominal, joints)
    columns: list[Array] = []
    for name in (*LENGTHS, *ANGLES):
        for k in range(nominal.dof):
            numbers = list(getattr(nominal, name))
            numbers[k] += STEP
            there = forward_kinematics_batch(replace(nominal, **{name: numbers}), joints)
            turn = turned_by(there[:, :3, :3] @ here[:, :3, :3].swapaxes(1, 2))
            columns.append(np.hstack([turn, there[:, :3, 3] - here[:, :3, 3]]) / STEP)
    return np.stack(columns, axis=-1)
