from dataclasses import replace

import numpy as np
import pytest

from handeye.calibration.calibrators import NetworkCorrection
from handeye.calibration.drift import OffsetStep, Thermal, steady
from handeye.calibration.session import WorldStreams
from handeye.networks import NoAdaptation
from handeye.thesis.experiment import FULL, Curve, Effort, Quantities
from handeye.thesis.experiments.fixed_point import OneInput, one_noisy_input
from handeye.thesis.experiments.noise_example import NOISE_EXAMPLE
from handeye.thesis.experiments.periodic import PARTS, PERIODS, periodic_response
from handeye.thesis.experiments.step import SLIP
from handeye.thesis.learning import Learning
from handeye.thesis.plants import NORMAL
from handeye.thesis.tracking import (
    Shares,
    misses,
    sightings,
    step_response,
    trained,
    without_drift,
)

SMALL = Learning(NORMAL, 30, drift=SLIP, trials=60, tests=20)


def curve(measured: Quantities, name: str) -> Curve:
    found = measured[name]
    assert isinstance(found, Curve)
    return found


def test_training_meets_no_drift_and_the_streams_go_on_behind_it():
    calibrator, streams = trained(SMALL, 3, FULL)
    again = WorldStreams.of(3)
    seen = SMALL.world.observe(np.arange(80) - 60, again.train_poses, again.train_noise)
    plain = SMALL.calibrator(3)
    plain.observe_many(seen[:60])
    np.testing.assert_array_equal(calibrator.network.weights, plain.network.weights)
    after = sightings(SMALL.world, streams, 20)
    unchanged = sightings(without_drift(SMALL.world), streams, 20)
    np.testing.assert_array_equal(after.range, seen.range[60:])
    np.testing.assert_array_equal(unchanged.joints, after.joints)
    assert not np.any(unchanged.range == after.range)


def test_a_copy_learns_alone():
    first = trained(SMALL, 0, FULL)
    other = first.copy()
    seen = sightings(SMALL.world, first.streams, 20)
    before = misses(first.calibrator, seen)
    errors = other.calibrator.observe_many(seen).error
    np.testing.assert_allclose(errors[0], before[0], atol=1e-12)
    assert not np.allclose(errors[1:], before[1:])
    np.testing.assert_array_equal(misses(first.calibrator, seen), before)
    other.streams.train_poses.random(3)
    np.testing.assert_array_equal(sightings(SMALL.world, first.streams, 20).joints, seen.joints)


def test_misses_are_what_an_empty_network_reports():
    seen = sightings(SMALL.world, WorldStreams.of(1), 10)
    blank = SMALL.calibrator(1)
    model = blank.model
    np.testing.assert_allclose(
        misses(NetworkCorrection(model), seen), model.displacement(seen, model.needed(seen))
    )


def test_shares_are_signed_and_best_in_the_least_squares_sense():
    d = np.random.default_rng(0).standard_normal((50, 2))
    sideways = d @ [[0.0, 1.0], [-1.0, 0.0]]
    shares = Shares.of(-0.3 * d + 5.0 * sideways, d)
    np.testing.assert_allclose(shares.share, -0.3)
    np.testing.assert_allclose(shares.weight, np.sum(d**2, axis=1))


def test_no_displacement_gives_no_share():
    shares = Shares.of(np.full((4, 2), 0.01), np.zeros((4, 2)))
    np.testing.assert_array_equal(shares.share, 0.0)
    assert np.all(shares.weight > 0.0)


@pytest.fixture(scope="module")
def response() -> Quantities:
    return step_response(replace(SMALL, capacity=60, trials=1500, tests=100), 0, Effort(0.5))


def test_a_step_shows_at_once_and_is_unlearned(response: Quantities):
    error, share = curve(response, "error"), curve(response, "share")
    before = response["error_before"]
    assert isinstance(before, float)
    assert error.at[0] == 0.0
    assert error.at[-1] == 2500.0
    assert np.all(np.diff(error.at) > 0.0)
    assert error.value[0] > 2.0 * before
    assert error.value[-1] < 1.5 * before
    assert len(share.at) == len(error.at) - 1
    assert share.value[0] == pytest.approx(1.0, abs=0.3)
    assert share.value[-1] == pytest.approx(0.0, abs=0.2)


@pytest.mark.parametrize("prefix", ["", "share_"])
def test_its_time_constant_lies_in_its_interval(response: Quantities, prefix: str):
    tau, low, high = (response[f"{prefix}time_constant{end}"] for end in ("", "_low", "_high"))
    assert isinstance(tau, float)
    assert isinstance(low, float)
    assert isinstance(high, float)
    assert 10.0 < low < tau < high < 500.0


def test_heat_fixed_at_half_a_turn_changes_nothing():
    heat = Thermal(np.inf, phase_shift=np.pi)
    still = step_response(replace(SMALL, drift=heat), 0, Effort(0.05))
    never = step_response(replace(SMALL, drift=steady), 0, Effort(0.05))
    np.testing.assert_allclose(curve(still, "error").value, curve(never, "error").value, rtol=1e-6)


def test_no_learning_lets_every_wave_pass_and_learning_leads():
    measured = periodic_response(Learning(NORMAL, 60, trials=1500), 0, Effort(0.2))
    periods, ratio = curve(measured, "share_ratio")
    np.testing.assert_allclose(periods, [20, 40, 100, 200, 500, 1000])
    lead = curve(measured, "share_lead").value
    assert ratio[0] > 0.8
    assert np.all(np.diff(ratio) < 0.05)
    assert np.all(lead > 0.0)
    assert np.all(curve(measured, "disturbance").value > 0.04)
    for name in PERIODS:
        cycle = curve(measured, f"cycle-{name}")
        assert len(cycle.at) == PARTS
        first = curve(measured, f"error-{name}")
        assert len(first.at) == 2 * PARTS
        np.testing.assert_array_equal(first.at, curve(measured, f"uncorrected-{name}").at)


def test_waves_that_no_network_answers_pass_whole():
    measured = periodic_response(
        Learning(NORMAL, 30, adaptation=NoAdaptation(), trials=100), 0, Effort(0.5)
    )
    np.testing.assert_allclose(curve(measured, "share_ratio").value, 1.0, atol=0.1)
    np.testing.assert_allclose(curve(measured, "share_lead").value, 0.0, atol=0.1)
    np.testing.assert_allclose(curve(measured, "ratio").value, 1.0, atol=0.1)


def test_one_noisy_input_follows_the_recursion_and_starts_with_it():
    measured = one_noisy_input(OneInput(bias=1.0), 0, Effort(0.2))
    output, predicted = curve(measured, "output"), curve(measured, "predicted")
    assert output.value[0] == predicted.value[0]
    target, misfit = measured["target"], measured["misfit"]
    assert isinstance(target, float)
    assert isinstance(misfit, float)
    assert abs(output.value[-1] - target) < 0.1 * abs(output.value[0] - target)
    assert misfit < 0.02


def test_the_slip_is_there_from_the_first_trial_after_training():
    assert OffsetStep("alpha", np.radians(2.0), at=0) == SLIP
    assert SLIP(NORMAL, 0).alpha.offset == pytest.approx(NORMAL.alpha.offset + np.radians(2.0))


def test_averages_at_the_example_pose_end_where_its_numbers_are():
    (setting,) = NOISE_EXAMPLE.settings.values()
    measured = NOISE_EXAMPLE.measure(setting, 0, Effort(0.05))
    learned, visual = curve(measured, "learned_average"), curve(measured, "visual_average")
    assert measured["learned_here"] == learned.value[-1]
    assert learned.value[0] == visual.value[0]
    assert learned.value[-1] < 0.5 * visual.value[-1]
    np.testing.assert_array_equal(curve(measured, "visual").at, [1.0, 2.0, 3.0, 4.0, 5.0])
