"""An arm and its observations in the form that the compiled loops read."""

import numpy as np

from handeye.arrays import Array, Integers
from handeye.calibration.arm.kernels import SerialArm, pose_many
from handeye.calibration.placement import Placement
from handeye.geometry import wxyz_from_matrix
from handeye.observations import PointObservation, PointTarget
from handeye.robots.urdf import UrdfArm


def describe(
    arm: UrdfArm,
    placement: Placement,
    terms: Integers,
    *,
    turn_std: float | None,
    compliant: bool,
    ends: Array | None = None,
) -> SerialArm:
    """An arm between a placed sensor and a placed marker, with curves of `terms` (T, 3).

    turn_std: standard deviation of measured orientations [rad]; None where none are measured. The
    first harmonic of a sliding joint is half a wave over its travel. ends (2, n): where curves are
    held; nowhere by default.
    """
    stages, readings = arm.stages().upright(), arm.readings
    low, high = [[-np.inf], [np.inf]] * np.ones(len(stages.slides)) if ends is None else ends
    return SerialArm(
        placements=stages.placements,
        slides=stages.slides,
        n_readings=len(readings.names),
        of=readings.of,
        gains=readings.gains,
        offsets=readings.offsets,
        rates=np.where(stages.slides, np.pi / arm.travel, 1.0),
        T_sensor_base=np.ascontiguousarray(placement.T_sensor_base),
        T_flange_marker=np.ascontiguousarray(placement.T_flange_marker),
        n_marker=3 if turn_std is None else 6,
        compliant=compliant,
        oriented=turn_std is not None,
        terms=np.ascontiguousarray(terms, np.int64).reshape(-1, 3),
        low=low.copy(),
        high=high.copy(),
        turn_std=0.0 if turn_std is None else turn_std,
        lever=arm.reach / 3.0,
    )


def ends_of(kernel: SerialArm, rows: Array) -> Array:
    """Least and largest place (2, n) of every joint in N rows (N, w)."""
    stood = kernel.gains * rows[:, kernel.of] + kernel.offsets
    return np.stack([stood.min(axis=0), stood.max(axis=0)])


def seen_rows(kernel: SerialArm, arm: UrdfArm, observations: PointObservation) -> Array:
    """N observations (N, w), or one (w,), as the kernels read them.

    A measurement that states no standard deviation has 0: what is not known of it is in the doubt.
    """
    o = observations
    parts = [*_joints(kernel, arm, o.joints), o.position]
    parts.append(np.zeros_like(o.position) if o.position_std is None else o.position_std)
    if kernel.oriented:
        assert o.orientation is not None
        parts.append(o.orientation / np.linalg.norm(o.orientation, axis=-1, keepdims=True))
    return np.concatenate(parts, axis=-1)


def target_rows(kernel: SerialArm, arm: UrdfArm, target: PointTarget) -> Array:
    """The same of targets, near whose postures joints are sought; no orientation is asked for."""
    parts = [*_joints(kernel, arm, target.posture), target.position, np.zeros_like(target.position)]
    if kernel.oriented:
        parts.append(np.broadcast_to([1.0, 0.0, 0.0, 0.0], (*target.position.shape[:-1], 4)))
    return np.concatenate(parts, axis=-1)


def expected_rows(kernel: SerialArm, arm: UrdfArm, x: Array, joints: Array) -> Array:
    """What would be seen at joints (N, n) of an arm with unknowns x, without noise, (N, w)."""
    nowhere = np.zeros((len(joints), 3))
    rows = target_rows(kernel, arm, PointTarget(nowhere, joints))
    poses = np.empty((len(joints), 3, 4))
    pose_many(kernel, x, rows, poses)
    width = 10 if kernel.oriented else 6
    rows[:, -width : rows.shape[1] - width + 3] = poses[:, :, 3]
    if kernel.oriented:
        rows[:, -4:] = wxyz_from_matrix(poses[:, :, :3])
    return rows


def _joints(kernel: SerialArm, arm: UrdfArm, joints: Array) -> list[Array]:
    if not kernel.compliant:
        return [joints]
    loads = arm.loads(joints.reshape(-1, joints.shape[-1]))
    return [joints, loads.reshape(*joints.shape[:-1], loads.shape[1])]
