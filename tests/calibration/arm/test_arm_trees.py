"""Hands seen by heads, cameras on flanges and joints that follow others, calibrated."""

from copy import deepcopy
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from tests.calibration.arm.arms import (
    SHEET,
    arm,
    errors_of,
    kernel_of,
    model,
    poses_of,
    sightings,
)

from handeye.calibration.arm.kernels import TWIST, joint_at
from handeye.calibration.arm.sheet import CurveTerms
from handeye.calibration.calibrators import Nominal
from handeye.calibration.combined import Combined
from handeye.calibration.exporting import calibrated_urdf
from handeye.calibration.storage import load_model, save_model
from handeye.errors import InvalidInput
from handeye.observations import PointTarget
from handeye.robots.urdf import UrdfArm

NO_CURVES = replace(SHEET, curves=CurveTerms(0, 0), compliance=0.0)
STIFF = replace(SHEET, curves=CurveTerms(2, 1))


@cache
def taught(name, seed=0, sheet=STIFF, n=150) -> Any:
    """A calibrator after n sightings of an arm whose errors a data sheet allows; copy it."""
    placed = model(name)
    combined = Combined(placed, sheet)
    combined.observe_many(sightings(placed, errors_of(placed, seed, sheet), n, seed, sheet))
    return combined


def fresh(name, seed=0, sheet=STIFF, n=60):
    placed = model(name)
    return sightings(placed, errors_of(placed, seed, sheet), n, seed + 100, sheet, 0.0)


def deviations(combined):
    return np.sqrt(np.diag(combined.engine.covariance()))


def mean(errors):
    return float(np.linalg.norm(errors, axis=1).mean())


@pytest.mark.parametrize("name", ["torso", "palletiser"])
def test_what_was_wrong_is_found_within_its_standard_deviations(name):
    combined = taught(name)
    true = errors_of(model(name), 0, STIFF)
    off, n = combined.engine.x - true, len(true)
    assert np.abs(off / deviations(combined)).max() < 5.0
    # Along every direction of the covariance, the well known ones too: chi-square of n degrees.
    C = combined.engine.covariance()
    unit = np.outer(combined.robot.chain.tolerance, combined.robot.chain.tolerance)
    scaled = off / combined.robot.chain.tolerance
    assert 0.6 * n < scaled @ np.linalg.solve(C / unit, scaled) < 1.5 * n
    assert np.linalg.eigvalsh(C / unit).min() < 1e-3


@pytest.mark.parametrize("name", ["torso", "palletiser"])
def test_the_hand_is_then_where_it_is_said_to_be(name):
    combined, seen = taught(name), fresh(name)
    nominal = Nominal(model(name)).errors(seen)
    assert mean(nominal) > 3e-3
    assert mean(combined.errors(seen)) < 0.05 * mean(nominal)


def test_joints_are_called_by_their_own_names():
    combined = taught("palletiser")
    groups = {group.words for group in combined.robot.chain.groups}
    assert {"encoder offset of joint shoulder", "encoder offset of joint level"} <= groups
    assert "placement of joint out" in groups
    assert arm("palletiser").joint_names == ("turn", "shoulder")


def test_the_reaching_arm_is_commanded_for_where_the_head_looks():
    placed, combined = model("torso"), taught("torso")
    goals = fresh("torso", n=20)
    posture = goals.joints.copy()
    posture[:, 2:] += 0.03
    joints = combined.command(PointTarget(goals.position, posture))
    np.testing.assert_array_equal(joints[:, :2], goals.joints[:, :2])
    reached = poses_of(placed, errors_of(placed, 0, STIFF), joints, STIFF)[:, :, 3]
    assert mean(reached - goals.position) < 5e-4
    # A head that looks elsewhere sees the same place of its own view elsewhere in the world.
    posture[:, 0] += 0.4
    turned = combined.command(PointTarget(goals.position[:1], posture[:1]))
    assert turned[0, 0] == posture[0, 0]
    assert np.abs(turned[0, 2:] - joints[0, 2:]).max() > 0.05


def test_a_place_that_only_the_head_could_bring_nearer_is_refused():
    combined, goals = taught("torso"), fresh("torso", n=1)
    away = goals.position + 5.0
    with pytest.raises(InvalidInput, match="cannot bring the marker to target 1"):
        combined.command(PointTarget(away, goals.joints))


def test_one_reading_is_commanded_for_all_joints_that_follow_it():
    placed, combined = model("palletiser"), taught("palletiser")
    goals = fresh("palletiser", n=20)
    x = errors_of(placed, 0, STIFF)
    # Two readings reach a surface only, that of the arm as learned.
    reachable = goals.position - combined.errors(goals)
    joints = combined.command(PointTarget(reachable, goals.joints + 0.02))
    np.testing.assert_allclose(joints, goals.joints, atol=1e-3)
    assert mean(poses_of(placed, x, joints, STIFF)[:, :, 3] - goals.position) < 5e-4


def test_an_arm_with_joints_to_spare_is_learned_and_commanded_near_its_posture():
    placed, combined = model("redundant"), taught("redundant")
    assert len(arm("redundant").joint_names) == 8
    goals = fresh("redundant", n=20)
    assert mean(combined.errors(goals)) < 0.05 * mean(Nominal(placed).errors(goals))
    posture = np.clip(goals.joints + 0.03, placed.low, placed.high)
    joints = combined.command(PointTarget(goals.position, posture))
    x = errors_of(placed, 0, STIFF)
    reached = poses_of(placed, x, joints, STIFF)[:, :, 3]
    assert mean(reached - goals.position) < 5e-4
    assert np.abs(joints - posture).max() < 0.15


@pytest.mark.parametrize("name", ["torso", "palletiser"])
def test_the_file_written_has_the_joints_where_they_were_found(name):
    sheet = replace(NO_CURVES, scale=1e-9)
    combined = taught(name, sheet=sheet)
    seen = fresh(name, sheet=sheet)
    nominal = arm(name)
    written = UrdfArm.from_text(calibrated_urdf(combined), nominal.tip, name, nominal.eye)
    assert written.joint_names == nominal.joint_names
    plant = combined.plant
    predicted = plant.placement.predict(written, seen.joints)
    np.testing.assert_allclose(seen.position - predicted, combined.errors(seen), atol=1e-6)


def test_a_model_on_disk_knows_its_eye(tmp_path):
    combined = deepcopy(taught("torso"))
    save_model(tmp_path / "head.safetensors", combined, 150)
    restored: Any = load_model(tmp_path / "head.safetensors").calibrator
    assert (restored.model.arm.eye, restored.model.arm.tip) == ("camera", "left_hand")
    seen = fresh("torso", n=5)
    np.testing.assert_array_equal(restored.errors(seen), combined.errors(seen))


def test_a_joint_that_moves_nothing_seen_stays_as_stated_and_says_so():
    # Every reading of the head is the same: its own zeros cannot be told from how it is mounted.
    placed: Any = model("torso")
    low = placed.low.copy()
    low[:2] = placed.high[:2]
    still = replace(placed, low=low)
    sheet = NO_CURVES
    combined = Combined(placed, sheet)
    combined.observe_many(sightings(still, errors_of(placed, 1, sheet), 120, 1, sheet))
    kernel = kernel_of(placed, sheet)
    scale = joint_at(kernel, 0) + TWIST
    std, tolerance = deviations(combined), combined.robot.chain.tolerance
    assert std[scale] > 0.9 * tolerance[scale]
    assert abs(combined.engine.x[scale]) < 0.5 * tolerance[scale]
    moving = joint_at(kernel, 2) + TWIST
    assert std[moving] < 0.9 * tolerance[moving]
