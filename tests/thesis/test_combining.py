from dataclasses import replace

import numpy as np
import pytest

from handeye.calibration.drift import OffsetStep
from handeye.calibration.session import WorldStreams, position_errors
from handeye.calibration.world import PlanarWorld
from handeye.thesis import combining
from handeye.thesis.combining import (
    Combining,
    calibration_curves,
    following,
    recovery,
    with_outliers,
)
from handeye.thesis.estimating import settled
from handeye.thesis.experiment import FULL, Curve, Quantities
from handeye.thesis.misfits import Misfit
from handeye.thesis.parameters import cramer_rao
from handeye.thesis.plants import NOMINAL, NORMAL

EXACT = NOMINAL.without_noise()
POSES = np.random.default_rng(3).uniform(-2.0, 2.0, (50, 2))


def curve(measured: Quantities, name: str) -> Curve:
    found = measured[name]
    assert isinstance(found, Curve)
    return found


def test_a_robot_that_is_as_drawn_is_at_the_floor_with_nominal_commands():
    setting = Combining(NOMINAL, rivals=("nominal",), marks=(0, 5), tests=20, quoted=(5,))
    measured = calibration_curves(setting, 0, FULL)
    np.testing.assert_allclose(curve(measured, "ratio").value, 1.0, rtol=1e-9)
    assert measured["ratio_5"] == curve(measured, "ratio").value[-1]
    np.testing.assert_array_equal(curve(measured, "floor").at, [0.0, 5.0])


def test_rivals_learn_what_they_would_learn_alone():
    setting = Combining(NORMAL, marks=(7, 20), tests=15)
    together = calibration_curves(setting, 1, FULL)
    for name in setting.rivals:
        alone = calibration_curves(replace(setting, rivals=(name,)), 1, FULL)
        np.testing.assert_array_equal(
            curve(alone, f"error_{name}").value, curve(together, f"error_{name}").value
        )


def test_without_noise_there_is_no_ratio_and_the_model_knows_that_the_head_has_none():
    measured = calibration_curves(Combining(EXACT, marks=(0, 2), tests=5), 0, FULL)
    assert "ratio" not in measured
    np.testing.assert_allclose(curve(measured, "error_nominal").value, 0.0, atol=1e-12)


def test_the_floor_of_a_misfit_is_that_of_the_robot_without_it():
    plain = Combining(NORMAL, rivals=("nominal",), marks=(3,), tests=30)
    odd = replace(plain, plant=Misfit.of(NORMAL, sag=0.02), floor=NORMAL)
    np.testing.assert_array_equal(
        curve(calibration_curves(plain, 2, FULL), "floor").value,
        curve(calibration_curves(odd, 2, FULL), "floor").value,
    )


def test_outliers_are_seen_elsewhere_at_the_same_joints_in_the_stated_share():
    streams = WorldStreams.of(0)
    seen = PlanarWorld(NORMAL).observe(np.arange(4000), streams.train_poses, streams.train_noise)
    wrong = with_outliers(seen, 0.2, NORMAL, np.random.default_rng(0))
    changed = wrong.range != seen.range
    assert np.mean(changed) == pytest.approx(0.2, abs=0.02)
    np.testing.assert_array_equal(wrong.joints, seen.joints)
    np.testing.assert_array_equal(changed, wrong.eccentricity != seen.eccentricity)
    assert np.median(np.abs(wrong.range - seen.range)[changed]) > 0.3
    unchanged = with_outliers(seen, 0.0, NORMAL, np.random.default_rng(0))
    np.testing.assert_array_equal(unchanged.range, seen.range)


@pytest.mark.parametrize(
    ("ratios", "expected"),
    [
        ([5.0, 4.0, 1.05, 1.0, 1.0], 2.0),
        ([5.0, 1.0, 1.2, 1.0, 1.0], 3.0),
        ([5.0, 4.0, 3.0, 2.0, 1.5], 4.0),
        ([1.0, 1.0, 1.0, 1.0, 1.0], 0.0),
        ([5.0, 1.1, 1.1, 1.1, 1.1], 1.0),
    ],
)
def test_recovery_counts_until_the_error_stays_near_the_floor(
    monkeypatch: pytest.MonkeyPatch, ratios: list[float], expected: float
):
    at = np.arange(200.0, 205.0)

    def curves(*_: object) -> Quantities:
        return {"ratio": Curve(at, np.array(ratios)), "floor": Curve(at, np.ones(5))}

    monkeypatch.setattr(combining, "calibration_curves", curves)
    slip = OffsetStep("alpha", 0.1, at=200)
    measured = recovery(Combining(NORMAL, drift=slip, marks=(200, 204)), 0, FULL)
    assert measured["recovery"] == expected
    np.testing.assert_array_equal(curve(measured, "ratio").at, np.arange(5.0))


def test_following_averages_over_the_second_half():
    setting = Combining(NORMAL, rivals=("nominal",), marks=(0, 1, 2, 3, 4), tests=10)
    measured = following(setting, 0, FULL)
    error, floor = (curve(measured, name).value[3:] for name in ("error_nominal", "floor"))
    assert measured["tracking_nominal"] == pytest.approx(error.mean() / floor.mean(), rel=1e-12)


def test_cramer_rao_bound_falls_with_the_root_of_the_number_of_sightings():
    streams, plant = WorldStreams.of(0), NORMAL.without_perturbations()
    seen = PlanarWorld(plant).observe(np.arange(100), streams.train_poses, streams.train_noise)
    twice = seen[np.repeat(np.arange(100), 2)]
    np.testing.assert_allclose(
        cramer_rao(plant, twice), cramer_rao(plant, seen) / np.sqrt(2.0), rtol=1e-9
    )


def test_cramer_rao_bound_is_proportional_to_the_noise_of_the_head():
    plant = NORMAL.without_perturbations()
    finer = replace(plant, head=replace(plant.head, pixel_pitch=0.25 * plant.head.pixel_pitch))
    seen = PlanarWorld(plant).observe(
        np.arange(60), np.random.default_rng(0), np.random.default_rng(1)
    )
    np.testing.assert_allclose(cramer_rao(finer, seen), 0.25 * cramer_rao(plant, seen), rtol=1e-9)


def test_what_sightings_tell_does_not_change_when_the_whole_robot_turns():
    turned = replace(
        NORMAL,
        v_x=np.cos(0.3) * NORMAL.v_x - np.sin(0.3) * NORMAL.v_y,
        v_y=np.sin(0.3) * NORMAL.v_x + np.cos(0.3) * NORMAL.v_y,
        alpha=replace(NORMAL.alpha, offset=0.3),
        gamma=replace(NORMAL.gamma, offset=NORMAL.gamma.offset + 0.3),
    )
    np.testing.assert_allclose(settled(turned), settled(NORMAL), atol=1e-12)


def test_a_misfit_with_nothing_wrong_is_the_plant():
    odd = Misfit.of(NORMAL)
    np.testing.assert_array_equal(odd.tips(POSES), NORMAL.tips(POSES))
    unit = np.zeros((50, 2))
    for mine, theirs in zip(
        odd.sight(odd.tips(POSES), POSES[:, 0] / 10.0, unit),
        NORMAL.sight(NORMAL.tips(POSES), POSES[:, 0] / 10.0, unit),
        strict=True,
    ):
        np.testing.assert_array_equal(mine, theirs)


def test_a_sagging_link_lowers_the_hand_most_when_it_is_level():
    odd = Misfit.of(EXACT, sag=0.02)
    level, upright = np.array([0.4, -0.4]), np.array([0.4, 0.5 * np.pi - 0.4])
    np.testing.assert_allclose(odd.tips(level) - EXACT.tips(level), [0.0, -0.02], atol=1e-12)
    np.testing.assert_allclose(odd.tips(upright) - EXACT.tips(upright), 0.0, atol=1e-12)


def test_no_command_can_beat_the_floor_by_more_than_chance():
    """Who knows the plant has the least mean error there is, up to the spread of 300 poses."""
    setting = Combining(NORMAL, rivals=("combined",), marks=(300,), tests=300)
    measured = calibration_curves(setting, 3, FULL)
    assert curve(measured, "ratio").value[0] > 0.97
    (misses,) = position_errors(
        setting.world, [combining.RIVALS["nominal"](combining.model_for(NORMAL))],
        0, WorldStreams.of(3), 300,
    )  # fmt: skip
    assert np.linalg.norm(misses, axis=1).mean() > curve(measured, "floor").value[0]
