"""Where instruments of a set-up could measure: limits, where they worked, and what they see."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.calibration.setups.fits import described_few, fitted, of_case, places
from tests.calibration.setups.setup_seen import in_picture
from tests.calibration.setups.setup_world import pixels

from handeye.arrays import Array
from handeye.calibration.arm.measurements import PixelSightings, StereoSightings
from handeye.calibration.setups.description import Description
from handeye.calibration.setups.fit import MixedFit
from handeye.calibration.setups.free_poses import FreePoses, title
from handeye.calibration.setups.suggesting import suggest_rows
from handeye.calibration.view import View
from handeye.geometry import invert, transform
from handeye.geometry.angles import wrap


@pytest.fixture(scope="module")
def torso(tmp_path_factory: pytest.TempPathFactory) -> Description:
    return described_few(tmp_path_factory.mktemp("torso"))


@pytest.fixture(scope="module")
def fit(torso: Description) -> MixedFit:
    return fitted(torso)


def test_wider_goes_beyond_where_what_is_seen_comes_to_where_it_was(fit: MixedFit):
    one = fit.measurements[0]
    arm = fit.problem.arm.between(one.link, one.base)
    rng = np.random.default_rng(0)
    joints, _ = FreePoses(fit, one, None, {}).draw(200, rng, wider=True)
    assert np.all((joints >= arm.lower) & (joints <= arm.upper))
    assert np.any(joints < one.joints.min(axis=0) - 0.3, axis=0).any()
    s, seen = (places(fit, one, q) for q in (joints, one.joints))
    assert np.all((s >= seen.min(axis=0)) & (s <= seen.max(axis=0)))
    # What a sensor sees, as it is said, counts in the place of where that was seen.
    for wider in (False, True):
        joints, _ = FreePoses(fit, one, View(near=0.4, far=2.7), {}).draw(50, rng, wider=wider)
        s = places(fit, one, joints)
        away = np.linalg.norm(s, axis=1)
        assert np.all((away >= 0.4) & (away <= 2.7))
    assert np.any((s < seen.min(axis=0)) | (s > seen.max(axis=0)))
    (row,) = suggest_rows(fit, 1, wider=True).rows
    worked = next(one.joints for one in fit.given if title(one) == row.measurement)
    assert np.any((row.joints < worked.min(axis=0)) | (row.joints > worked.max(axis=0)))


def test_points_stay_in_the_picture_and_ahead(torso: Description, fit: MixedFit):
    one = fit.measurements[2]
    assert isinstance(one, PixelSightings)
    rng = np.random.default_rng(0)
    for wider in (False, True):
        joints, _ = FreePoses(fit, one, None, torso.sizes).draw(100, rng, wider=wider)
        s = places(fit, one, joints)
        assert np.all(s[:, 2] > 0.0)
        uv = pixels(s, np.zeros(5))
        assert in_picture(uv).mean() > 0.98
        assert np.any((uv < one.measured.min(axis=0) - 5) | (uv > one.measured.max(axis=0) + 5))
    # Without a size, among the pixels that were seen.
    uv = pixels(places(fit, one, FreePoses(fit, one, None, {}).draw(100, rng)[0]), np.zeros(5))
    assert np.all((uv > one.measured.min(axis=0) - 0.1) & (uv < one.measured.max(axis=0) + 0.1))
    # A lens that bends what is far aside back into the picture does not show it.
    bent = np.array([0, 0, 0, 0, -0.3, 0, 0, 0, 0])
    camera = replace(one.camera, reference=one.camera.reference + bent)
    bowed = replace(one, camera=camera)
    s = places(fit, one, FreePoses(fit, bowed, None, torso.sizes).draw(300, rng)[0])
    assert np.linalg.norm(s[:, :2] / s[:, 2:], axis=1).max() < 1.06


@pytest.mark.parametrize("setup", ["eye to hand", "eye in hand"])
def test_a_whole_board_is_seen_and_from_its_front(setup: str, tmp_path: Path):
    described, fit = of_case(f"pixels of a board, {setup}", tmp_path)
    one = fit.measurements[0]

    def before(joints: Array) -> Array:
        """T_camera_board."""
        A = fit.flanges(joints)
        over = A if setup == "eye to hand" else invert(A)
        return invert(one.sight.sensor.reference) @ over @ one.sight.target.reference

    def ahead(joints: Array) -> Array:
        """How far the board's z axis points away from the camera, -1 to 1."""
        T = before(joints)
        return np.sum(T[:, :3, 2] * T[:, :3, 3], axis=1) / np.linalg.norm(T[:, :3, 3], axis=1)

    # The camera of this world sees a board through its back, too.
    for side in (-1.0, 1.0):
        some = one.only(np.flatnonzero(side * ahead(one.joints) > 0.0))
        for view, least in ((None, 0.0), (View(facing=0.5), np.cos(0.5))):
            poses = FreePoses(fit, some, view, described.sizes)
            joints, _ = poses.draw(30, np.random.default_rng(0))
            assert np.all(side * ahead(joints) >= least)
            for corner in one.sight.points.reference:
                s = transform(before(joints), corner)
                assert np.all(s[:, 2] > 0.0)
                assert in_picture(pixels(s)).mean() > 0.95
    joints, _ = FreePoses(fit, one, None, described.sizes).draw(60, np.random.default_rng(0))
    assert np.ptp(np.sign(ahead(joints))) == 2.0


def test_what_was_always_before_a_sensor_stays_there(tmp_path: Path):
    _, fit = of_case("points, eye in hand", tmp_path)
    one = fit.measurements[0]
    ahead = one.only(np.flatnonzero(places(fit, one, one.joints)[:, 2] > 0.0))
    assert 3 < len(ahead.joints) < len(one.joints)
    lowest = [
        places(fit, one, FreePoses(fit, some, None, {}).draw(100, np.random.default_rng(0))[0])
        for some in (one, ahead)
    ]
    assert lowest[0][:, 2].min() < 0.0 < lowest[1][:, 2].min()


def test_a_cone_is_for_what_looks(fit: MixedFit, tmp_path: Path):
    one, rng = fit.measurements[0], np.random.default_rng(0)
    s = places(fit, one, one.joints)
    aside = np.arccos(s[:, 2] / np.linalg.norm(s, axis=1))
    half = float(np.median(aside))
    cone = View(half_angle=half, near=0.2, far=3.0)
    s = places(fit, one, FreePoses(fit, one, cone, {}).draw(40, rng)[0])
    assert np.all(s[:, 2] >= np.cos(half) * np.linalg.norm(s, axis=1) - 1e-9)
    _, wire = of_case("a draw-wire and a ball bar", tmp_path)
    reel = wire.measurements[0]
    s = places(
        wire,
        reel,
        FreePoses(wire, reel, View(half_angle=0.3, near=1.0, far=3.0), {}).draw(40, rng)[0],
    )
    away = np.linalg.norm(s, axis=1)
    assert np.all((away >= 1.0) & (away <= 3.0))
    assert np.any(s[:, 2] < np.cos(0.3) * away)


def test_a_head_turns_as_it_has_turned(tmp_path: Path):
    _, fit = of_case("the stereo head", tmp_path)
    one = fit.measurements[0]
    assert isinstance(one, StereoSightings)
    found = suggest_rows(fit, 4)
    pan = np.array([row.pointing for row in found.rows], np.float64)
    assert np.all((pan >= one.pointing.min()) & (pan <= one.pointing.max()))
    s = places(fit, one, np.array([row.joints for row in found.rows]))
    aside = wrap(np.arctan2(s[:, 1], s[:, 0]) - pan)
    nearest = np.abs(aside[:, np.newaxis] - one.measured[:, 1]).min(axis=1)
    assert np.all(nearest < 1e-9)
    assert set(found.before) == {"range", "eccentricity"}
    assert found.before["range"] > 1.2 * found.before["eccentricity"]
