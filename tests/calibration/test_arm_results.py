"""What is written and suggested of an arm in space: files, poses to add, parts, parameters."""

from copy import deepcopy
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import yaml
from scipy.spatial.transform import Rotation
from tests.calibration.cases import CASES, sightings

from handeye.calibration.calibrators import NetworkCorrection, Nominal
from handeye.calibration.combined import Combined
from handeye.calibration.estimation import NAMES, ParameterEstimator
from handeye.calibration.exporting import (
    calibrated_joints_yaml,
    calibrated_urdf,
    not_in_urdf,
)
from handeye.calibration.learned import parameters_of, parts_of, undetermined_of
from handeye.calibration.models import PlanarModel
from handeye.calibration.suggesting import suggest_poses
from handeye.errors import InvalidInput
from handeye.geometry import make_pose
from handeye.thesis.plants import NOMINAL

pytest.importorskip("pinocchio")
UR10 = next(case for case in CASES if case.name == "ur10")
ARM: Any = UR10.model.arm


@pytest.fixture(scope="module")
def learned() -> Combined:
    """A UR10 that was observed 60 times."""
    calibrator = Combined(UR10.model)
    calibrator.observe_many(UR10.seen)
    return calibrator


@pytest.fixture(scope="module")
def planar() -> Combined:
    calibrator = Combined(PlanarModel(NOMINAL))
    calibrator.observe_many(sightings(n=40))
    return calibrator


def with_unknowns(calibrator: Combined, wanted) -> Combined:
    """The same with random unknowns of the names that `wanted` picks, all others 0."""
    other, rng = deepcopy(calibrator), np.random.default_rng(3)
    chain = other.engine.chain
    chosen = np.array([wanted(name) for name in chain.names]) & ~chain.curved
    other.engine.x[:] = np.where(chosen, rng.normal(size=len(chosen)) * chain.tolerance, 0.0)
    other.falling_back = False
    return other


def constant(name: str) -> bool:
    return not name.endswith(("scale", "compliance"))


def test_the_written_urdf_is_the_arm_as_it_was_learned(learned):
    calibrator = with_unknowns(learned, constant)
    urdf = calibrated_urdf(calibrator)
    written = type(ARM).from_text(urdf, ARM.tip, "ur10")
    seen = UR10.seen
    predicted = seen.position - calibrator.errors(seen)
    placed = calibrator.plant.placement.predict(written, seen.joints)
    np.testing.assert_allclose(placed, predicted, atol=1e-9)
    nominal = UR10.model.placement.predict(ARM, seen.joints)
    assert np.abs(placed - nominal).max() > 1e-3
    assert not_in_urdf(calibrator) == ("error curves of the joints",)


def test_what_a_urdf_cannot_say_is_named(learned):
    calibrator = with_unknowns(learned, lambda name: name == "elbow_joint scale")
    (scale, _) = not_in_urdf(calibrator)
    change = calibrator.engine.x[calibrator.engine.chain.names.index("elbow_joint scale")]
    assert scale == f"elbow_joint: scale {1.0 + change:.6f}"


def test_the_yaml_for_xacro_has_the_same_places(learned):
    calibrator = with_unknowns(learned, constant)
    joints = yaml.safe_load(calibrated_joints_yaml(calibrator))["kinematics"]
    assert list(joints) == list(ARM.joint_names)
    text = calibrated_urdf(calibrator)
    for name, at in joints.items():
        T = make_pose(
            Rotation.from_euler("xyz", [at[k] for k in ("roll", "pitch", "yaw")]).as_matrix(),
            [at[k] for k in "xyz"],
        )
        assert " ".join(repr(v) for v in T[:3, 3].tolist()) in text, name


def test_only_learned_arms_have_corrected_joints(planar):
    for calibrator in (planar, Nominal(UR10.model), NetworkCorrection(UR10.model)):
        with pytest.raises(InvalidInput, match="method combined"):
            calibrated_urdf(calibrator)


@pytest.mark.parametrize("wider", [False, True])
def test_suggested_poses_keep_limits_and_reduce_what_is_unknown(learned, wider):
    before = learned.engine.x.copy()
    found = suggest_poses(learned, 3, wider=wider)
    assert found.joints.shape == (3, 6)
    assert np.all((found.joints >= ARM.lower) & (found.joints <= ARM.upper))
    known = [found.before, *found.after]
    assert np.all(np.diff(known) < 0.0)
    # A copy was asked: the calibrator itself has seen nothing new.
    np.testing.assert_array_equal(learned.engine.x, before)
    assert learned.n_observations == 60
    model = UR10.model
    inside = np.all((found.joints >= model.low) & (found.joints <= model.high), axis=1)
    if not wider:
        assert inside.all()
        return
    assert not inside.all()
    worked = np.random.default_rng(0).uniform(model.low, model.high, (5000, 6))
    seen = model.placement.predict(ARM, worked)
    places = model.placement.predict(ARM, found.joints)
    assert np.all((places > seen.min(axis=0)) & (places < seen.max(axis=0)))


def test_the_first_suggestion_is_the_calibrators_own(planar):
    best = planar.suggest()
    found = suggest_poses(planar, 1)
    np.testing.assert_array_equal(found.joints[0], best.joints)
    assert (found.before, found.after[0], found.eccentricity[0]) == (
        best.before,
        best.after,
        best.eccentricity,
    )
    with pytest.raises(InvalidInput, match="n must be a whole number"):
        suggest_poses(planar, 0)


def test_poses_that_were_added_teach_what_was_promised(planar):
    found = suggest_poses(planar, 2)
    shown = deepcopy(planar)
    for i, pose in enumerate(np.column_stack([found.joints, found.eccentricity])):
        poses, rows = shown.robot.candidates(shown.engine.x, None, 400)
        (at,) = np.flatnonzero(np.all(poses == pose, axis=1))
        shown.engine.learn(rows[at])
        assert shown.suggest().before == pytest.approx(found.after[i], rel=0.02)


def test_parts_are_sorted_by_how_far_they_move_the_hand(learned):
    name = "elbow_joint zero"
    calibrator = with_unknowns(learned, lambda n: n == name)
    parts = parts_of(calibrator, UR10.seen)
    assert parts[0].unknown == name
    assert [part.moves for part in parts[1:]] == [0.0] * (len(parts) - 1)
    change = calibrator.engine.x[calibrator.engine.chain.names.index(name)]
    # By hand: the marker moves by the error of the elbow times its lever.
    turned = UR10.seen.joints + change * np.eye(6)[2]
    predict = UR10.model.placement.predict
    apart = predict(ARM, turned) - predict(ARM, UR10.seen.joints)
    moved = np.sqrt(np.mean(np.sum(apart**2, axis=1)))
    assert parts[0].moves == pytest.approx(moved, rel=1e-2)
    assert parts[0].change == change
    assert parts_of(Nominal(UR10.model), UR10.seen) == ()


def test_parameters_have_names_units_and_deviations(planar, learned):
    found = {p.name: p for p in parameters_of(planar, sightings(n=40))}
    assert list(found) == list(NAMES)
    for name, value in zip(NAMES, planar.parameters, strict=True):
        assert found[name].value == pytest.approx(value)
    assert found["a"].nominal == NOMINAL.arm.a
    arm = parameters_of(learned, UR10.seen)
    assert len(arm) == np.count_nonzero(~learned.engine.chain.curved)
    assert all(p.std is not None and p.std > 0.0 for p in arm)
    assert undetermined_of(learned) == learned.knowledge().undetermined
    estimator = ParameterEstimator(PlanarModel(NOMINAL))
    estimator.observe_many(sightings(n=40))
    assert [p.name for p in parameters_of(estimator, sightings(n=40))] == list(NAMES)


def test_frames_have_the_spread_that_noise_gives_them():
    seen = UR10.exact[1]
    rng, sigma = np.random.default_rng(8), 1e-3
    noisy = replace(seen, position=seen.position + sigma * rng.normal(size=(60, 3)))
    found = parameters_of(Nominal(UR10.model), noisy)
    assert [p.name for p in found] == [f"{f} {a}" for f in ("base", "marker") for a in "xyz"]
    # By hand, from the covariance of least squares with numerical derivatives.
    columns = []
    for k in range(9):
        moved = []
        for sign in (1.0, -1.0):
            step = sign * 1e-6 * np.eye(9)[k]
            T = UR10.model.placement.T_sensor_base.copy()
            T[:3, :3] = Rotation.from_rotvec(step[:3]).as_matrix() @ T[:3, :3]
            T[:3, 3] += step[3:6]
            M = UR10.model.placement.T_flange_marker.copy()
            M[:3, 3] += step[6:]
            moved.append(replace(UR10.model.placement, T_sensor_base=T, T_flange_marker=M))
        apart = moved[0].predict(ARM, seen.joints) - moved[1].predict(ARM, seen.joints)
        columns.append(apart.reshape(-1) / 2e-6)
    J = np.transpose(columns)
    expected = sigma * np.sqrt(np.diag(np.linalg.inv(J.T @ J)))[3:]
    # The size of the noise is found from 60 rows.
    np.testing.assert_allclose([p.std or 0.0 for p in found], expected, rtol=0.25)
