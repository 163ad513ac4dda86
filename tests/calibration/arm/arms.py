"""Simulated arms with errors in every stage, and what a sensor sees of them."""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation
from tests.robots.made import TORSO, palletiser, redundant

from handeye.calibration.arm.description import describe, seen_rows
from handeye.calibration.arm.kernels import SerialArm, pose_many
from handeye.calibration.arm.sheet import ArmSheet, CurveTerms
from handeye.calibration.combined import Combined
from handeye.calibration.placed_arm import PlacedArm
from handeye.calibration.placement import Placement
from handeye.geometry import make_pose
from handeye.observations import PointObservation
from handeye.robots.urdf import UrdfArm

PLACEMENT = Placement(
    make_pose(Rotation.from_rotvec([0.3, -0.5, 2.0]).as_matrix(), [1.5, 0.4, 0.3]),
    make_pose(Rotation.from_rotvec([-0.4, 0.2, 0.9]).as_matrix(), [0.03, 0.05, 0.12]),
)
SHEET = ArmSheet(curves=CurveTerms(4, 1))
NOISE, TURN_NOISE = 5e-5, 2e-4


@cache
def arm(name="ur10"):
    match name:
        case "torso":  # a hand seen by a head that pans and tilts
            return UrdfArm.from_text(TORSO, "left_hand", name, "camera")
        case "palletiser":  # two of its joints follow a third
            return UrdfArm.from_text(palletiser(), None, name)
        case "redundant":  # eight joints
            return UrdfArm.from_text(redundant(), None, name)
    return UrdfArm.shipped(name)


def model(name="ur10", turn_std: float | None = TURN_NOISE, **options) -> Any:
    n = len(arm(name).joint_names)
    low = np.maximum(arm(name).lower, -2.5)
    high = np.minimum(arm(name).upper, 2.5)
    assert n == len(low)
    return PlacedArm(arm(name), PLACEMENT, low, high, 1e-4, turn_std, **options)


def kernel_of(placed, sheet=SHEET) -> SerialArm:
    return describe(
        placed.arm, placed.placement, sheet.curves.table(placed.arm.stages().slides),
        turn_std=placed.turn_std, compliant=sheet.compliance > 0.0,
    )  # fmt: skip


def errors_of(placed, seed=0, sheet=SHEET, size=1.0):
    """Unknowns as the tolerances of a sheet allow; the placement is right to a millimetre."""
    kernel = kernel_of(placed, sheet)
    std = sheet.tolerances(kernel)
    std[: 6 + kernel.n_marker] = 1e-3
    return size * std * np.random.default_rng((seed, 17)).normal(size=len(std))


def poses_of(placed, x, joints, sheet=SHEET):
    """Where the marker really is, (N, 3, 4)."""
    full = replace(placed, turn_std=TURN_NOISE)
    kernel = kernel_of(full, sheet)
    if placed.turn_std is None:
        x = np.concatenate([x[:9], np.zeros(3), x[9:]])
    nothing = PointObservation(
        np.zeros(len(joints)), joints, np.zeros((len(joints), 3)),
        np.tile([1.0, 0.0, 0.0, 0.0], (len(joints), 1)),
    )  # fmt: skip
    poses = np.empty((len(joints), 3, 4))
    pose_many(kernel, x, seen_rows(kernel, placed.arm, nothing), poses)
    return poses


def sightings(placed, x, n, seed=0, sheet=SHEET, noise=1.0, joints=None) -> Any:
    """Of an arm with unknowns x at random joints (or given ones, (n, q))."""
    rng = np.random.default_rng((seed, 5))
    if joints is None:
        joints = rng.uniform(placed.low, placed.high, (n, len(placed.low)))
    poses = poses_of(placed, x, joints, sheet)
    turns = Rotation.from_rotvec(rng.normal(scale=noise * TURN_NOISE + 1e-12, size=(n, 3)))
    wxyz = (turns * Rotation.from_matrix(poses[:, :, :3])).as_quat(scalar_first=True)
    position = poses[:, :, 3] + rng.normal(scale=noise * NOISE + 1e-15, size=(n, 3))
    return PointObservation(np.arange(float(n)), joints, position, wxyz, np.full((n, 3), NOISE))


@cache
def taught(n=120, seed=0) -> Any:
    """A calibrator that has seen n sightings of an arm with errors of `errors_of`; copy it."""
    placed = model()
    combined = Combined(placed, SHEET)
    combined.observe_many(sightings(placed, errors_of(placed, seed), n, seed))
    return combined
