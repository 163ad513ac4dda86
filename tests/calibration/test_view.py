"""What a camera sees of a marker, and poses to add that it sees."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from tests.calibration.cases import CASES, sightings

from handeye.calibration.combined import Combined
from handeye.calibration.models import PlanarModel
from handeye.calibration.placed_arm import PlacedArm
from handeye.calibration.placement import Placement
from handeye.calibration.suggesting import suggest_poses
from handeye.calibration.view import View
from handeye.errors import InvalidInput
from handeye.geometry import make_pose
from handeye.robots.planar import TwoLinkArm
from handeye.thesis.plants import NOMINAL

JOINTS = np.random.default_rng(0).uniform([-2.0, 0.4], [2.0, 2.2], (300, 2))


def placed(tilt=0.4, marker=(0.3, -0.5, 2.0), turn_std: float | None = 1e-3) -> Any:
    """Two links that a camera sees from 2 m above, tilted."""
    base = make_pose(Rotation.from_euler("xy", [np.pi + tilt, 0.2]).as_matrix(), [0.1, 0.2, 2.0])
    turned = make_pose(Rotation.from_rotvec(marker).as_matrix(), [0.03, 0.05, 0.12])
    low, high = np.array([-2.0, 0.4]), np.array([2.0, 2.2])
    return PlacedArm(
        TwoLinkArm(1.0, 0.8), Placement(base, turned), low, high, turn_std=turn_std
    )  # fmt: skip


def poses(model):
    placement = model.placement
    return placement.T_sensor_base @ model.arm.poses(JOINTS) @ placement.T_flange_marker


@settings(max_examples=30)
@given(angle=st.floats(0.05, 3.1), near=st.floats(0.0, 2.0), span=st.floats(0.1, 2.0))
def test_a_marker_is_seen_within_a_cone_and_a_range(angle, near, span):
    model = placed()
    x, y, z = poses(model)[:, :3, 3].T
    off, away = np.arctan2(np.hypot(x, y), z), np.sqrt(x**2 + y**2 + z**2)
    expected = (off <= angle) & (near <= away) & (away <= near + span)
    seen = View(half_angle=angle, near=near, far=near + span).sees(model, JOINTS)
    clear = (np.abs(off - angle) > 1e-9) & (np.abs(away - near - span) > 1e-9)
    np.testing.assert_array_equal(seen[clear], expected[clear])


def test_without_any_bound_everything_is_seen():
    assert View().sees(placed(), JOINTS).all()
    assert View().sees(placed(turn_std=None), JOINTS).all()


@pytest.mark.parametrize("angle", [0.3, 0.8, 1.4])
def test_a_marker_faces_the_camera_whichever_way_its_axis_points(angle):
    model = placed(marker=(2.6, 0.0, 0.0))
    pose = poses(model)
    sight = pose[:, :3, 3] / np.linalg.norm(pose[:, :3, 3], axis=1, keepdims=True)
    away = np.arccos(np.sum(-sight * pose[:, :3, 2], axis=1))
    away = np.minimum(away, np.pi - away) if np.median(away) > np.pi / 2 else away
    seen = View(facing=angle).sees(model, JOINTS)
    np.testing.assert_array_equal(seen, away <= angle)
    assert seen.any() or angle < 0.5
    flip = make_pose(np.diag([1.0, -1.0, -1.0]), np.zeros(3))
    other = replace(model.placement, T_flange_marker=model.placement.T_flange_marker @ flip)
    np.testing.assert_array_equal(
        View(facing=angle).sees(replace(model, placement=other), JOINTS), seen
    )


def test_which_way_it_faces_must_have_been_measured():
    with pytest.raises(InvalidInput, match="no orientations were measured"):
        View(facing=1.0).sees(placed(turn_std=None), JOINTS)


@pytest.mark.parametrize(
    "wrong",
    [
        {"half_angle": 0.0},
        {"half_angle": 3.2},
        {"facing": 3.2},
        {"facing": -1.0},
        {"near": -0.1},
        {"near": 2.0, "far": 2.0},
        {"far": np.nan},
    ],
)
def test_a_view_that_makes_no_sense_is_refused(wrong):
    with pytest.raises(InvalidInput, match="view: "):
        View(**wrong)


@pytest.fixture(scope="module")
def learned() -> Combined:
    """A UR10 that was observed 60 times."""
    pytest.importorskip("pinocchio")
    case = next(case for case in CASES if case.name == "ur10")
    calibrator = Combined(case.model)
    calibrator.observe_many(case.seen)
    return calibrator


@pytest.mark.parametrize("wider", [False, True])
def test_suggested_poses_stay_in_view_and_within_limits(learned, wider):
    model: Any = learned.model
    free = suggest_poses(learned, 4, wider=wider)
    joints = np.random.default_rng(4).uniform(model.low, model.high, (200, 6))
    first, *there = (
        np.linalg.norm(model.placement.predict(model.arm, q), axis=1) for q in (free.joints, joints)
    )
    middle = float(np.median(there))
    # A view that the first choice, at least, is not in.
    view = View(near=middle) if first[0] < middle else View(far=middle)
    found = suggest_poses(learned, 4, wider=wider, view=view)
    assert view.sees(model, found.joints).all()
    assert not view.sees(model, free.joints).all()
    assert np.all((found.joints >= model.arm.lower) & (found.joints <= model.arm.upper))
    worked = np.all((found.joints >= model.low) & (found.joints <= model.high), axis=1)
    assert worked.all() != wider
    assert found.after[-1] < found.before


def test_a_view_in_which_nothing_is_says_what_to_do(learned):
    with pytest.raises(InvalidInput, match=r"none of .* in view; .*--wider"):
        suggest_poses(learned, 1, view=View(near=50.0))
    with pytest.raises(InvalidInput, match=r"looks along its z axis$"):
        suggest_poses(learned, 1, wider=True, view=View(near=50.0))


def test_the_planar_robot_has_no_such_view():
    calibrator = Combined(PlanarModel(NOMINAL))
    calibrator.observe_many(sightings(n=20))
    with pytest.raises(InvalidInput, match="planar robot's eye turns"):
        suggest_poses(calibrator, 1, view=View(near=0.1))
