"""The arm's side of a problem of mixed measurements."""

from dataclasses import replace

import numpy as np
import pytest
from tests.calibration.arm.arms import NOISE, SHEET, arm, errors_of, model, poses_of, sightings

from handeye.calibration.arm.evidence import solve
from handeye.calibration.arm.measurement import Block
from handeye.calibration.arm.measurements import Frame, Points, PoseSightings, Sight
from handeye.calibration.arm.problem import ArmProblem
from handeye.calibration.arm.sheet import CurveTerms
from handeye.errors import InvalidInput
from handeye.geometry import make_pose, matrix_from_wxyz

STIFF = replace(SHEET, compliance=0.0, curves=CurveTerms(2, 0))
JOINTS = np.random.default_rng(4).uniform(-2.0, 2.0, (5, 6))


def posed(n=100, seed=0):
    """Sightings of a marker whose frames are known to a millimetre or so, and the truth."""
    placed = model()
    x = errors_of(placed, seed, STIFF)
    seen = sightings(placed, x, n, seed, STIFF)
    S = make_pose(matrix_from_wxyz(seen.orientation), seen.position)
    sensor = Frame.near("tracker", np.linalg.inv(placed.placement.T_sensor_base))
    target = Frame.near("marker", placed.placement.T_flange_marker)
    first = np.zeros(n, np.int64)
    sight = Sight("eye_to_hand", sensor, target, Points.known(), first)
    measured = PoseSightings(joints=seen.joints, measured=S, sight=sight)
    return measured, x


def test_without_errors_flanges_are_those_of_the_arm():
    problem = ArmProblem(arm(), [posed()[0]], STIFF, STIFF.curves)
    still = problem.flanges(np.zeros(len(problem.tolerance)), JOINTS)
    np.testing.assert_allclose(still, arm().poses(JOINTS), atol=1e-12)


def test_slopes_of_all_equations_are_their_derivatives():
    measured, x = posed(3)
    problem = ArmProblem(arm(), [measured], SHEET, CurveTerms(2, 1))
    at = problem.tolerance * np.random.default_rng(0).normal(size=len(problem.tolerance))
    (rows,) = problem.rows(at)
    for i in np.random.default_rng(1).choice(len(at), 40, replace=False):
        step = np.zeros(len(at))
        step[i] = 1e-5
        ahead, behind = (next(problem.rows(at + s)).residuals for s in (step, -step))
        np.testing.assert_allclose(
            rows.slopes[:, :, i], (ahead - behind) / 2e-5, rtol=1e-5, atol=1e-7
        )
    assert len(x) > 0


def test_two_measurements_of_one_marker_share_its_frame():
    measured, _ = posed()
    both = ArmProblem(arm(), [measured, measured], STIFF, STIFF.curves)
    one = ArmProblem(arm(), [measured], STIFF, STIFF.curves)
    assert len(both.tolerance) == len(one.tolerance)
    assert both.n_rows == 2 * one.n_rows
    assert [rows.first for rows in both.rows(np.zeros(len(both.tolerance)))] == [0, 100]


def test_the_arm_is_recovered():
    measured, x = posed()
    problem = ArmProblem(arm(), [measured], STIFF, STIFF.curves)
    found = solve(problem)
    fresh = np.random.default_rng(7).uniform(-2.0, 2.0, (200, 6))
    predicted = measured.poses(problem.flanges(found.x, fresh), problem.own(measured, found.x))
    off = predicted[:, :3, 3] - poses_of(model(), x, fresh, STIFF)[:, :, 3]
    assert np.linalg.norm(off, axis=1).mean() < 1.5 * NOISE


def test_it_refuses_what_does_not_fit():
    measured, _ = posed()
    with pytest.raises(InvalidInput, match="no measurements"):
        ArmProblem(arm(), [], STIFF, STIFF.curves)
    with pytest.raises(InvalidInput, match="has 7 joints"):
        ArmProblem(arm("xarm7"), [measured], STIFF, STIFF.curves)
    loose = replace(measured.sight.sensor, tolerance=np.full(6, 0.5))
    other = replace(measured, sight=replace(measured.sight, sensor=loose))
    with pytest.raises(InvalidInput, match="describe tracker differently"):
        ArmProblem(arm(), [measured, other], STIFF, STIFF.curves)


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        ({"names": ("a",)}, "as many"),
        ({"tolerance": np.array([1.0, 0.0])}, "above 0"),
        ({"tolerance": np.array([1.0, np.nan])}, "tolerance of thing"),
    ],
)
def test_a_block_says_what_is_wrong_with_it(parts, message):
    good = {"name": "thing", "names": ("a", "b"), "units": ("m", "m"), "tolerance": np.ones(2)}
    with pytest.raises(InvalidInput, match=message):
        Block(**(good | parts))
