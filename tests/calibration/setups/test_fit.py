"""An arm with errors, seen by a tracker and a camera, and measured by a wire and a height gauge."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from tests.calibration.arm.arms import arm
from tests.calibration.arm.measured import looking

from handeye.arrays import Array
from handeye.calibration.arm.measurements import (
    Distances,
    Frame,
    Instrument,
    PixelSightings,
    PlaneContacts,
    Points,
    PointSightings,
    Sight,
    agreeing,
    lens,
)
from handeye.calibration.arm.problem import ArmProblem
from handeye.calibration.arm.sheet import ArmSheet, CurveTerms
from handeye.calibration.setups.fit import MixedFit, fit_measurements
from handeye.calibration.setups.left_out import left_out
from handeye.errors import InvalidInput
from handeye.geometry import invert, make_pose, transform
from handeye.robots.urdf import UrdfArm

SHEET = replace(ArmSheet(), compliance=0.0, curves=CurveTerms(2, 1))
CAMERA = lens("eye", (1200.0, 1200.0, 960.0, 600.0), (-0.1, 0.02))
MARKER, REEL, TABLE = np.array([0.05, -0.03, 0.1]), np.array([1.5, 0.4, 0.2]), 0.1
TRACKER, EYE = (looking(np.random.default_rng(seed), 3.5) for seed in (1, 2))
NOISE, PIXEL = 1e-4, 0.2
WRONG = [3, 11]
FEW, MANY = 20, 60


@cache
def errors() -> tuple[ArmProblem, Array]:
    """The arm, and its errors."""
    plane = Frame.near("plane", np.eye(4))
    sight = Sight("eye_to_hand", plane, Frame.known(), Points.known(), np.zeros(1, np.int64))
    any_row = PlaneContacts(joints=np.zeros((1, 6)), measured=np.zeros((1, 1)), sight=sight)
    problem = ArmProblem(arm(), [any_row], SHEET, SHEET.curves)
    n = len(problem.tolerance)
    return problem, problem.tolerance * np.random.default_rng(7).standard_normal(n)


def marker(joints: Array) -> Array:
    """Where it really is, (N, 3)."""
    problem, x = errors()
    return transform(problem.flanges(x, joints), MARKER)


def pixels(s: Array) -> Array:
    a, b = s[:, 0] / s[:, 2], s[:, 1] / s[:, 2]
    r = a**2 + b**2
    g = 1.0 - 0.1 * r + 0.02 * r**2
    return np.column_stack([1200.0 * a * g + 960.0, 1200.0 * b * g + 600.0])


@cache
def measured() -> tuple[Instrument, ...]:
    """Tracker, wire, gauge and camera, each at poses of its own."""
    rng = np.random.default_rng(0)
    q = [rng.uniform(-2.0, 2.0, (n, 6)) for n in (FEW, MANY, MANY, MANY)]
    p, flanges = [marker(joints) for joints in q], [arm().poses(joints) for joints in q]
    seen = transform(invert(TRACKER), p[0]) + NOISE * rng.standard_normal((FEW, 3))
    seen[WRONG] += [0.03, -0.02, 0.01]
    length = np.linalg.norm(p[1] - REEL, axis=1) + NOISE * rng.standard_normal(MANY)
    height = p[2][:, 2:] - TABLE + NOISE * rng.standard_normal((MANY, 1))
    uv = pixels(transform(invert(EYE), p[3])) + PIXEL * rng.standard_normal((MANY, 2))
    tip = Points.near("marker")
    level = Frame("table", np.array([0, 0, 0.02, 0.02, 0.02, 0]), make_pose(np.eye(3), [0, 0, 0.1]))
    first = np.zeros(MANY, np.int64)
    return tuple(
        agreeing(
            [
                PointSightings.start(q[0], flanges[0], seen, name="tracker", sensor="tracker"),
                Distances.start(q[1], flanges[1], length, tip=tip, anchor="reel"),
                PlaneContacts(
                    joints=q[2], measured=height,
                    sight=Sight("eye_to_hand", level, Frame.known(), tip, first),
                ),
                PixelSightings.start(q[3], flanges[3], uv, camera=CAMERA),
            ],
            flanges,
        )
    )  # fmt: skip


def off(tracker: Instrument, flanges: Array, joints: Array) -> float:
    """Mean distance [m] of the marker in the tracker's frame from where it is."""
    assert isinstance(tracker, PointSightings)
    sight = replace(tracker.sight, which=np.zeros(len(joints), np.int64))
    zeros = [np.zeros(len(u.tolerance)) for u in sight.unknowns]
    truth = transform(invert(TRACKER), marker(joints))
    return float(np.linalg.norm(sight.look(flanges, *zeros).s - truth, axis=1).mean())


FRESH = np.random.default_rng(99).uniform(-2.0, 2.0, (200, 6))


def test_all_instruments_together_find_the_errors_of_the_arm():
    instruments = measured()
    alone, together = (
        fit_measurements(arm(), some, SHEET) for some in (instruments[:1], instruments)
    )
    nominal = off(instruments[0], arm().poses(FRESH), FRESH)
    one, all_four = (
        off(fit.measurements[0], fit.flanges(FRESH), FRESH) for fit in (alone, together)
    )
    assert nominal > 3e-3
    assert all_four < 0.75 * one < 0.75 * 0.6 * nominal
    assert all_four < 3e-4


def test_what_each_instrument_errs_is_found_and_who_is_wrong():
    fit = fit_measurements(arm(), measured(), SHEET)
    assert set(fit.noise) == {"position of tracker", "distance", "height", "pixels"}
    for channel, noise in (("distance", NOISE), ("height", NOISE), ("pixels", PIXEL)):
        assert 0.6 * noise < fit.noise[channel] < 1.5 * noise, channel
    tracker, *others = fit.doubtful()
    assert tracker.tolist() == WRONG
    assert sum(map(len, others)) <= 3


def test_frames_and_points_are_found_within_what_is_said_of_them():
    fit = fit_measurements(arm(), measured(), SHEET)
    reel, ball = fit.unknowns["reel"], fit.unknowns["marker"]
    assert isinstance(reel, Frame)
    assert isinstance(ball, Points)
    assert np.all(np.abs(reel.reference[:3, 3] - REEL) < 4.0 * fit.std("reel") + 2e-3)
    assert np.all(fit.std("marker") > 0.0)
    assert np.all(fit.std("marker") < 5e-3)
    with pytest.raises(InvalidInput, match="nothing was not fitted; there are tracker, marker"):
        fit.std("nothing")


def test_errors_are_judged_on_rows_that_were_left_out():
    wire = measured()[1]
    one = left_out(arm(), [wire, measured()[3]], SHEET, folds=3)
    assert {channel: len(pair.after) for channel, pair in one.items()} == {
        "distance": MANY,
        "pixels": MANY,
    }
    for pair in one.values():
        before, after = pair.summaries()
        assert after.mean < 0.6 * before.mean
    flanges = arm().poses(wire.joints)
    nominal = wire.equations(flanges, tuple(np.zeros(len(b.names)) for b in wire.blocks)).residuals
    np.testing.assert_allclose(one["distance"].before, nominal)
    assert one["distance"].row.tolist() == list(range(MANY))
    assert one["distance"].block.tolist() == sorted([0, 1, 2] * (MANY // 3))
    assert set(one["pixels"].measurement.tolist()) == {1}
    assert (one["distance"].unit, one["pixels"].unit) == ("m", "px")
    for pair in one.values():
        assert 0.7 < np.median(pair.times) < 1.6


def test_rows_that_are_judged_were_not_fitted(monkeypatch: pytest.MonkeyPatch):
    wire = measured()[1]
    fits: list[Array] = []

    def noted(robot: UrdfArm, kept: list[Instrument], sheet: ArmSheet | None = None) -> MixedFit:
        fits.append(kept[0].joints)
        return fit_measurements(robot, kept, sheet)

    monkeypatch.setattr("handeye.calibration.setups.left_out.fit_measurements", noted)
    left_out(arm(), [wire], replace(SHEET, curves=CurveTerms(0, 0)), folds=3)
    rows = [{row.tobytes() for row in joints} for joints in (*fits, wire.joints)]
    assert [len(some) for some in rows] == [40, 40, 40, MANY]
    assert set.union(*rows) == rows[-1]
    assert not set.intersection(*rows[:-1])


def test_too_many_folds_are_refused():
    with pytest.raises(
        InvalidInput, match="each of 25 blocks, and tracker has poses in 20: measure"
    ):
        left_out(arm(), measured()[:1], SHEET, folds=25)


def test_what_has_one_name_has_one_place():
    tracker, wire, gauge, camera = measured()
    for one in (wire, gauge, camera):
        (point,) = [u for u in one.unknowns if u.name == "marker"]
        (same,) = [u for u in tracker.unknowns if u.name == "marker"]
        assert isinstance(point, Points)
        assert isinstance(same, Points)
        np.testing.assert_array_equal(point.reference, same.reference)
        np.testing.assert_array_equal(point.tolerance, same.tolerance)


def test_what_is_shared_is_placed_by_all_rows():
    """And not by the first table, of an arm with errors that are larger than any noise."""
    q = np.random.default_rng(3).uniform(-2.0, 2.0, (100, 6))
    A, s = arm().poses(q), transform(invert(TRACKER), marker(q))
    parts = [slice(0, 15), slice(15, 100)]
    each = [PointSightings.start(q[some], A[some], s[some]) for some in parts]
    first, second = agreeing(each, [A[some] for some in parts])
    whole = PointSightings.start(q, A, s)
    sensor, alone, all_rows = (one.sight.sensor.reference for one in (second, each[0], whole))
    np.testing.assert_array_equal(sensor, first.sight.sensor.reference)
    apart = np.linalg.norm(sensor[:3, 3] - all_rows[:3, 3])
    assert apart < 0.3 * np.linalg.norm(alone[:3, 3] - all_rows[:3, 3])


def test_two_things_of_one_name_are_refused():
    tracker, wire, *_ = measured()
    assert isinstance(wire, Distances)
    frame = Frame.near("marker", np.eye(4))
    wrong = replace(wire, sight=replace(wire.sight, sensor=frame, points=Points.known()))
    with pytest.raises(InvalidInput, match="marker is used as two things"):
        agreeing([tracker, wrong], [arm().poses(one.joints) for one in (tracker, wrong)])
