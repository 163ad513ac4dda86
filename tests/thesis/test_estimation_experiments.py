from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from handeye.calibration.estimation import Refit
from handeye.calibration.plant import PlanarPlant
from handeye.calibration.session import WorldStreams, position_errors
from handeye.robots.planar import TwoLinkArm
from handeye.thesis.estimating import Estimating, estimation_curve, parameter_error
from handeye.thesis.experiment import FULL, Curve, Effort, Quantities
from handeye.thesis.experiments.comparison import (
    COMPARISON,
    HEAT,
    SOON,
    Compared,
    scenario_errors,
)
from handeye.thesis.experiments.estimation import ESTIMATION, KINEMATIC, LOCAL
from handeye.thesis.experiments.exact import EXACT, what_changed
from handeye.thesis.experiments.scenarios import early_and_late
from handeye.thesis.learning import Learning
from handeye.thesis.plants import LARGE, NOMINAL, NORMAL


def curve(measured: Quantities, name: str) -> Curve:
    found = measured[name]
    assert isinstance(found, Curve)
    return found


def disguised(plant: PlanarPlant, turn: float, growth: float) -> PlanarPlant:
    """Another plant that no sighting can tell from this one."""
    c, s = np.cos(turn), np.sin(turn)
    v_x, v_y = float(plant.v_x), float(plant.v_y)
    return replace(
        plant,
        arm=TwoLinkArm(plant.arm.a * growth, plant.arm.b * growth),
        v_x=growth * (c * v_x - s * v_y),
        v_y=growth * (s * v_x + c * v_y),
        alpha=replace(plant.alpha, offset=plant.alpha.offset + turn),
        gamma=replace(plant.gamma, offset=plant.gamma.offset + turn),
        head=replace(plant.head, range_scale=plant.head.range_scale / growth),
    )


@given(st.floats(-0.5, 0.5), st.floats(0.5, 2.0))
def test_parameters_that_look_the_same_have_no_error(turn: float, growth: float):
    plant = LARGE.without_perturbations().without_noise()
    other = disguised(plant, turn, growth)
    joints = np.random.default_rng(0).uniform(-2.0, 2.0, (20, 2))
    eccentricity, noise = np.linspace(-0.5, 0.5, 20), np.zeros((20, 2))
    for seen, same in zip(
        plant.sight(plant.tips(joints), eccentricity, noise),
        other.sight(other.tips(joints), eccentricity, noise),
        strict=True,
    ):
        np.testing.assert_allclose(np.exp(1j * same), np.exp(1j * seen), atol=1e-12)
    assert parameter_error(other, plant) < 1e-11
    assert parameter_error(plant, other) < 1e-11


def test_parameter_error_is_the_largest_of_the_relative_ones():
    longer = replace(KINEMATIC, arm=TwoLinkArm(1.005 * 1.02, 1.003 * 0.99))
    assert parameter_error(longer, KINEMATIC) == pytest.approx(0.02)


def test_thesis_estimator_finds_the_parameters_of_a_normal_plant():
    setting = Estimating(KINEMATIC, Refit("forward"), trials=20, tests=20)
    measured = estimation_curve(setting, 0, FULL)
    assert set(measured) == {"error", "spread", "uncorrected", "first_error", "parameter_error"}
    np.testing.assert_array_equal(curve(measured, "error").at, [0.0, 10.0, 20.0])
    assert measured["first_error"] == curve(measured, "error").value[1]
    assert curve(measured, "error").value[0] == curve(measured, "uncorrected").value[0] > 0.03
    assert curve(measured, "error").value[2] < 1e-9
    assert isinstance(measured["parameter_error"], float)
    assert measured["parameter_error"] < 1e-6


def test_methods_are_compared_on_the_same_poses():
    small = Effort(0.02)
    measured = {
        name: ESTIMATION.measure(ESTIMATION.settings[name], 1, small)
        for name in ("local-forward", "local-modern", "local-network")
    }
    errors = [curve(each, "uncorrected").value for each in measured.values()]
    np.testing.assert_array_equal(errors[0], errors[1])
    np.testing.assert_array_equal(errors[0], errors[2])
    assert "neurons" in measured["local-network"]


def test_small_region_is_about_twenty_centimetres_two_metres_from_the_eye():
    joints, eccentricity = LOCAL.sample(2000, np.random.default_rng(0))
    tips = NOMINAL.tips(joints)
    np.testing.assert_allclose(tips.mean(axis=0), [1.0, 0.0], atol=0.01)
    assert np.all(np.ptp(tips, axis=0) < 0.4)
    assert np.max(np.abs(eccentricity)) <= 0.05


def test_early_numbers_are_those_of_the_curve():
    measured = early_and_late(Learning(NORMAL, tests=5), 0, Effort(0.02))
    assert curve(measured, "neurons").at[10] == 20.0
    assert measured["early_neurons"] == curve(measured, "neurons").value[10]
    assert measured["early_error"] == curve(measured, "error").value[10]


def test_estimator_leaves_an_exact_plant_alone():
    measured = what_changed(EXACT.settings["clean"], 0, Effort(0.05))
    assert measured["change"] == 0.0
    assert isinstance(measured["change_without_threshold"], float)
    assert measured["change_without_threshold"] < 1e-11


def test_exact_experiment_would_notice_an_estimator_that_errs():
    measured = what_changed(Learning(KINEMATIC), 0, Effort(0.05))
    assert isinstance(measured["change"], float)
    assert measured["change"] > 1e-3


def test_thesis_estimator_is_not_asked_for_late_errors():
    small = Effort(0.05)
    for name, late in (("both-forward", False), ("both-modern", True), ("both-network-200", True)):
        measured = scenario_errors(COMPARISON.settings[name], 0, small)
        assert ("late" in measured) is late
        error = curve(measured, "error")
        assert error.at[0] == 0.0
        assert error.at[-1] == small.of(SOON)
        later = error.value[error.at > small.of(SOON) // 2]
        assert measured["soon"] == pytest.approx(later.mean())


def test_encoder_slips_when_the_calibrator_has_learned():
    learner = Learning(NORMAL, 30)
    slipped = Compared(learner, slips=True, before=300, after=SOON)
    measured = scenario_errors(slipped, 0, Effort(0.5))

    streams, calibrator = WorldStreams.of(0), learner.calibrator(0)
    before = np.arange(150)
    calibrator.observe_many(learner.world.observe(before, streams.train_poses, streams.train_noise))
    plant = replace(NORMAL, alpha=replace(NORMAL.alpha, offset=np.radians(2.0)))
    changed = replace(learner.world, plant=plant)
    (errors,) = position_errors(changed, [calibrator], 150, streams, 10)
    expected = np.linalg.norm(errors, axis=1).mean()
    assert curve(measured, "error").value[0] == pytest.approx(expected)


def test_heat_reaches_every_calibrator():
    heated = [s for name, s in COMPARISON.settings.items() if name.startswith("heat")]
    assert len(heated) == 8
    assert all(setting.learner.drift == HEAT for setting in heated)
