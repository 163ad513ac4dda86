"""Arms in space: predictions, corrections, and commands that reach their targets."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.calibration.cases import CASES, PLACEMENT

from handeye.calibration.calibrators import NetworkCorrection, Nominal
from handeye.calibration.placed_arm import PlacedArm
from handeye.errors import InvalidInput
from handeye.geometry import transform
from handeye.observations import PointTarget
from handeye.robots.planar import TwoLinkArm

PLACED = [case for case in CASES if isinstance(case.model, PlacedArm)]
EACH = pytest.mark.parametrize("case", PLACED, ids=str)


def marker(model, joints):
    """Where the marker of an uncorrected arm is, frame by frame."""
    on_flange = model.placement.T_flange_marker[:3, 3]
    in_base = transform(model.arm.poses(joints), np.tile(on_flange, (len(joints), 1)))
    return transform(model.placement.T_sensor_base, in_base)


@EACH
def test_the_needed_correction_is_measured_minus_predicted_in_the_sensor_frame(case):
    expected = case.seen.position - marker(case.model, case.seen.joints)
    np.testing.assert_allclose(case.model.needed(case.seen), expected, atol=1e-14)
    np.testing.assert_array_equal(case.model.features(case.seen), case.seen.joints)
    errors = np.random.default_rng(0).normal(size=(60, 3))
    np.testing.assert_array_equal(case.model.displacement(case.seen, errors), errors)


@EACH
@settings(max_examples=25)
@given(seed=st.integers(0, 2**32 - 1), away=st.floats(0.0, 0.4))
def test_commands_reach_their_targets_from_a_posture_nearby(case, seed, away):
    model, rng = case.model, np.random.default_rng(seed)
    joints = rng.uniform(model.low, model.high, (3, len(model.low)))
    target = marker(model, joints)
    # Inside the working range: stretching it does not bring another solution nearer.
    posture = np.clip(joints + rng.uniform(-away, away, joints.shape), model.low, model.high)
    command = Nominal(model).command(PointTarget(target, posture))
    np.testing.assert_allclose(marker(model, command), target, atol=1.1e-5)
    assert np.all((command >= model.arm.lower) & (command <= model.arm.upper))


@EACH
def test_corrected_commands_reach_where_the_corrected_model_says(case):
    learner = NetworkCorrection(case.model)
    learner.observe_many(case.noise_free)
    target = case.noise_free.target
    nudged = PointTarget(target.position, target.posture + 0.02)
    command = learner.command(nudged)
    reached = marker(case.model, command) + learner.network.predict_many(command)
    np.testing.assert_allclose(reached, target.position, atol=1e-6)


def test_far_targets_are_reached_without_changing_the_side_of_the_elbow():
    rng = np.random.default_rng(0)
    model = PlacedArm(TwoLinkArm(), PLACEMENT, np.full(2, -2.0), np.full(2, 2.0))
    joints, posture = rng.uniform([-1.0, 0.1], [1.0, 2.2], (2, 60, 2))
    command = Nominal(model).command(PointTarget(marker(model, joints), posture))
    np.testing.assert_allclose(command, joints, atol=1e-4)


@EACH
def test_a_target_at_its_posture_needs_no_step(case):
    joints = case.exact[1].joints
    target = PointTarget(marker(case.model, joints), joints)
    np.testing.assert_array_equal(Nominal(case.model).command(target), joints)


@EACH
def test_targets_out_of_reach_are_named_and_the_first_five_listed(case):
    joints = case.exact[1].joints[:9]
    position = marker(case.model, joints)
    position[2] += 50.0
    with pytest.raises(InvalidInput) as caught:
        Nominal(case.model).command(PointTarget(position, joints))
    message = str(caught.value)
    assert message.startswith(f"{case.model.arm.name} cannot bring the marker to target 3 (by ")
    assert " m): it is out of reach or beyond a joint limit" in message
    far = np.full((9, 3), 50.0)
    with pytest.raises(InvalidInput, match=r"target 1 \(.*2 \(.*3 \(.*4 \(.*5 \(by .* and 4 more:"):
        Nominal(case.model).command(PointTarget(far, joints))
    with pytest.raises(InvalidInput, match=r"target 1 \(by"):
        Nominal(case.model).command(PointTarget(far, joints)[0])


class Limited(TwoLinkArm):
    """Two links that fold only so far."""

    lower = np.array([-0.5, 0.2])
    upper = np.array([0.5, 1.0])


def limited_model():
    return PlacedArm(Limited(), PLACEMENT, Limited.lower, Limited.upper)


def test_commands_respect_joint_limits():
    model = limited_model()
    inside, outside = np.array([[0.4, 0.9]]), np.array([[0.4, 1.4]])
    reachable = PointTarget(marker(model, inside), np.array([[-0.4, 0.3]]))
    np.testing.assert_allclose(Nominal(model).command(reachable), inside, atol=1e-5)
    with pytest.raises(InvalidInput, match="joint limit"):
        Nominal(model).command(PointTarget(marker(model, outside), inside))


def test_a_posture_beyond_the_limits_is_not_commanded():
    model = limited_model()
    beyond = np.array([[0.4, 1.4]])
    with pytest.raises(InvalidInput, match="joint limit"):
        Nominal(model).command(PointTarget(marker(model, beyond), beyond))


def test_the_posture_chooses_the_solution():
    model = PlacedArm(TwoLinkArm(), PLACEMENT, np.full(2, -2.0), np.full(2, 2.0))
    left = np.array([[0.3, 0.9]])
    on_axis = replace(PLACEMENT, T_flange_marker=np.eye(4))
    model = replace(model, placement=on_axis)
    position = marker(model, left)
    right = np.array([[0.3 + 0.9, -0.9]])
    for solution in (left, right):
        found = Nominal(model).command(PointTarget(position, solution + 0.1))
        np.testing.assert_allclose(found, solution, atol=1e-5)
