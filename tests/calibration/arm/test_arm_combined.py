"""The combined calibrator on simulated arms: what it learns, commands, says and refuses."""

from copy import deepcopy
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tests.calibration.arm.arms import (
    NOISE,
    PLACEMENT,
    SHEET,
    arm,
    errors_of,
    model,
    poses_of,
    sightings,
    taught,
)

from handeye.calibration.arm.sheet import ArmSheet, CurveTerms
from handeye.calibration.calibrators import Nominal
from handeye.calibration.combined import Combined, DataSheet, Settings
from handeye.calibration.models import PlanarModel
from handeye.calibration.placed_arm import PlacedArm
from handeye.calibration.storage import load_model, save_model
from handeye.errors import InvalidInput
from handeye.observations import PointTarget
from handeye.robots.planar import TwoLinkArm
from handeye.thesis.plants import NOMINAL


def mean(errors):
    return float(np.linalg.norm(errors, axis=1).mean())


def fresh(n=60, seed=0, **options):
    placed = model(**options)
    return sightings(placed, errors_of(placed, seed), n, seed + 100, noise=0.0)


@pytest.mark.parametrize("seed", [0, 1])
def test_a_hundred_sightings_leave_a_tenth_of_the_error(seed):
    combined = taught(seed=seed)
    nominal, learned = Nominal(model()).errors(fresh(seed=seed)), combined.errors(fresh(seed=seed))
    assert mean(nominal) > 5e-3
    assert mean(learned) < 2e-4
    assert not [event for event in combined.events if event.kind == "change"]


def test_errors_are_as_large_as_the_covariance_says():
    seen, normal = fresh(), []
    combined = taught()
    covariance = combined.covariance(seen.target)
    for error, C in zip(combined.errors(seen), covariance, strict=True):
        normal.append(error @ np.linalg.solve(C, error))
    # Chi-square of three degrees, over poses that share what is wrong.
    assert 1.0 < np.mean(normal) < 7.0
    single = combined.covariance(seen[0].target)
    np.testing.assert_allclose(single, covariance[0])
    noisy = combined.covariance(seen[0].target, noise=True)
    assert np.linalg.eigvalsh(noisy - single).min() > 0.0


def test_an_arm_as_drawn_is_left_as_it_is():
    placed = model()
    combined = Combined(placed, SHEET)
    drawn = np.zeros_like(errors_of(placed))
    combined.observe_many(sightings(placed, drawn, 40, noise=1.0))
    seen = sightings(placed, drawn, 60, 100, noise=0.0)
    assert mean(combined.errors(seen)) < 1.5 * NOISE


def test_positions_alone_teach_an_arm_whose_last_joint_slides_or_turns():
    placed = model("tiago_no_hand", None)
    sheet = ArmSheet(curves=CurveTerms(2, 0))
    x = errors_of(placed, 3, sheet)
    combined = Combined(placed, sheet)
    combined.observe_many(replace(sightings(placed, x, 150, 3, sheet), orientation=None))
    seen = replace(sightings(placed, x, 60, 100, sheet, 0.0), orientation=None)
    assert mean(combined.errors(seen)) < 0.1 * mean(Nominal(placed).errors(seen))


def test_commands_bring_the_marker_to_the_target():
    placed, combined = model(), taught()
    x = errors_of(placed)
    goals = fresh(20)
    target = PointTarget(goals.position, goals.joints + 0.05)
    joints = combined.command(target)
    reached = poses_of(placed, x, joints)[:, :, 3]
    assert mean(reached - goals.position) < 3e-4
    assert (joints >= arm().lower).all()
    assert (joints <= arm().upper).all()
    np.testing.assert_allclose(combined.command(target[3]), joints[3], atol=1e-9)
    # What it predicts there is the target, to the last digit that counts.
    there = replace(goals, joints=joints)
    np.testing.assert_allclose(combined.errors(there), 0.0, atol=2e-7)
    assert np.abs(joints - target.posture).max() < 0.5


def test_targets_out_of_reach_are_named():
    combined, goals = taught(), fresh(3)
    far = goals.position.copy()
    far[1] += 5.0
    with pytest.raises(InvalidInput, match=r"ur10 cannot bring the marker to target 2 \(by \d"):
        combined.command(PointTarget(far, goals.joints))


def test_corrections_never_leave_the_envelope():
    combined, goals = deepcopy(taught()), fresh(30)
    combined.engine.x = 30.0 * combined.engine.x
    combined.settings = replace(combined.settings, envelope=0.004)
    nominal = Nominal(model())
    change = combined.errors(goals) - nominal.errors(goals)
    np.testing.assert_allclose(np.linalg.norm(change, axis=1), 0.004, rtol=1e-9)
    joints = combined.command(goals.target)
    off = np.linalg.norm(nominal.errors(replace(goals, joints=joints)), axis=1)
    assert off.max() < 0.004 + 1e-6
    combined.engine.x = np.full_like(combined.engine.x, np.nan)
    np.testing.assert_allclose(combined.errors(goals), nominal.errors(goals), atol=1e-12)


def test_one_by_one_is_as_all_at_once_and_a_saved_one_goes_on(tmp_path):
    placed = model()
    seen = sightings(placed, errors_of(placed), 40)
    together, apart = Combined(placed, SHEET), Combined(placed, SHEET)
    errors = together.observe_many(seen).error
    for i in range(30):
        np.testing.assert_array_equal(apart.observe(seen[i]).error, errors[i])
    save_model(tmp_path / "arm.safetensors", apart, 30)
    again: Any = load_model(tmp_path / "arm.safetensors").calibrator
    assert again.model.turn_std == placed.turn_std
    assert again.sheet == SHEET
    np.testing.assert_array_equal(again.observe_many(seen[30:]).error, errors[30:])
    np.testing.assert_array_equal(again.engine.x, together.engine.x)


def test_suggested_poses_teach_more_than_most():
    combined = deepcopy(taught(20))
    pose = combined.suggest(candidates=60)
    assert pose.after < pose.before
    assert pose.gains[pose.best] > 1.5 * np.median(pose.gains)
    assert (pose.joints >= model().low).all()
    assert (pose.joints <= model().high).all()
    visible = fresh(5).joints
    chosen = combined.suggest(visible, fresh(3, 1).target)
    np.testing.assert_array_equal(chosen.joints, visible[chosen.best])
    nothing = PointTarget(np.empty((0, 3)), np.empty((0, 6)))
    with pytest.raises(InvalidInput, match="working point"):
        combined.suggest(working_points=nothing)
    with pytest.raises(InvalidInput, match="region"):
        combined.suggest(np.zeros((2, 5)))


def test_the_corrected_arm_has_the_learned_constants():
    placed = replace(model(), turn_std=1e-4)
    sheet = ArmSheet(curves=CurveTerms(0, 0), compliance=0.0)
    x = errors_of(placed, 0, sheet)
    combined = Combined(placed, sheet)
    combined.engine.x = x
    corrected = combined.plant
    joints = fresh(10).joints
    scaled = corrected.stages.poses(joints * corrected.scales)
    place = corrected.placement
    poses = place.T_sensor_base @ scaled @ place.T_flange_marker
    np.testing.assert_allclose(poses[:, :3], poses_of(placed, x, joints, sheet), atol=1e-12)
    np.testing.assert_array_equal(corrected.compliances, 0.0)
    np.testing.assert_array_equal(combined.parameters, x)
    np.testing.assert_array_equal(corrected.stages.axes, arm().stages().axes)
    nominal = Combined(placed, sheet).plant.placement
    np.testing.assert_allclose(nominal.T_sensor_base, PLACEMENT.T_sensor_base, atol=1e-15)


def test_what_is_said_of_an_arm():
    known = taught().knowledge()
    words = {part.words: part for part in known.parts}
    assert words["base of the sensor"].known > 0.8 > words["scale of joint elbow_joint"].known
    assert words["encoder offset of joint elbow_joint"].unknown == "elbow_joint zero"
    assert words["encoder offset of joint elbow_joint"].unit == "rad"
    assert len(words) == 2 + 6 * 5
    assert known.undetermined  # a base and a first link that lies wrong look alike
    assert "120 observations" in taught().health()


def test_what_it_cannot_learn_is_refused():
    seen = fresh(2)
    with pytest.raises(InvalidInput, match="orientations"):
        taught().observe(replace(seen[0], orientation=None))
    with pytest.raises(InvalidInput, match="ArmSheet, got a DataSheet"):
        Combined(model(), DataSheet())
    with pytest.raises(InvalidInput, match="DataSheet, got an ArmSheet"):
        Combined(PlanarModel(NOMINAL), ArmSheet())
    links = TwoLinkArm(1.0, 0.8)
    placed = PlacedArm(links, PLACEMENT, np.zeros(2), np.ones(2))
    with pytest.raises(InvalidInput, match="PlacedArm of a UrdfArm"):
        Combined(placed)
    with pytest.raises(InvalidInput, match="patience"):
        Settings(patience=1)
    with pytest.raises(InvalidInput, match="one observation"):
        taught().observe(seen)
