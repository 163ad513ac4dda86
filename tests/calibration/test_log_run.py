"""From a log to a calibrated model, on logs of simulated robots."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tests.calibration.cases import CASES, sightings

from handeye.calibration.calibrators import NetworkCorrection, Nominal
from handeye.calibration.combined import Combined
from handeye.calibration.log_run import calibrate_log
from handeye.calibration.placed import Method, robot_name, working_range
from handeye.calibration.planar_placement import eye_points
from handeye.calibration.results import ErrorSummary
from handeye.calibration.session import learn_from_log
from handeye.errors import LogError
from handeye.io.records import BadRow, Log
from handeye.thesis.plants import NOMINAL, NORMAL

N = 60
SPACE = next(case for case in CASES if case.name == "two links in space")


def log_of(seen) -> Any:
    return Log("run.csv", ("alpha", "beta"), seen, np.arange(2, len(seen) + 2))


def calibrated(log, robot, *, method: Method = "network", **settings) -> Any:
    return calibrate_log(log, robot, method=method, **settings)


@pytest.fixture(scope="module")
def log():
    return log_of(sightings(n=N))


def test_rows_and_columns_of_a_result(log):
    bad = BadRow("run.csv", 7, "range_m is empty", "fill it in")
    run = calibrated(log, NOMINAL, rejected=(bad,))
    result = run.result
    assert (result.robot, result.log, result.method) == ("planar", "run.csv", "network")
    assert result.joint_names == ("alpha", "beta")
    assert result.rejected == (str(bad),)
    np.testing.assert_array_equal(result.joints, log.observations.joints)
    np.testing.assert_array_equal(result.positions[:, :2], eye_points(log.observations))
    np.testing.assert_array_equal(result.positions[:, 2], 0.0)
    assert result.before.shape == result.online.shape == (N, 2)
    assert result.n_neurons[-1] == run.calibrator.network.n_neurons
    assert np.all(np.diff(result.n_neurons) >= 0)
    assert run.frames == result.settings["frames"]
    assert run.frames.startswith("eye at (")


def test_the_run_is_test_then_train_from_the_placed_robot(log):
    run = calibrated(log, NOMINAL)
    model = run.calibrator.model
    before = Nominal(model).observe_many(log.observations).error
    np.testing.assert_array_equal(run.result.before, before)
    again = NetworkCorrection(model)
    online = learn_from_log(again, log.observations)
    np.testing.assert_array_equal(run.result.online, online.error)
    np.testing.assert_array_equal(run.result.n_neurons, np.cumsum(online.allocated))
    np.testing.assert_array_equal(run.calibrator.network.weights, again.network.weights)


def test_a_run_can_be_repeated(log):
    random: Any = {"validate": "random"}
    first, second = (calibrated(log, NOMINAL, replicate=3, **random).result for _ in range(2))
    assert first.settings == second.settings
    assert first.summary() == second.summary()
    other = calibrated(log, NOMINAL, replicate=4, **random).result
    np.testing.assert_array_equal(first.online, other.online)
    assert first.held_out.rows.tolist() != other.held_out.rows.tolist()


def test_a_log_of_the_thesis_robot_is_calibrated():
    result = calibrated(log_of(sightings(NORMAL.without_noise(), n=400)), NOMINAL).result
    summary = result.summary()
    assert summary["held_out_after"]["mean"] < 0.5 * summary["held_out_before"]["mean"]
    late = np.linalg.norm(result.online[200:], axis=1).mean()
    assert late < 0.5 * np.linalg.norm(result.before[200:], axis=1).mean()


def test_an_arm_in_space_is_placed_and_calibrated():
    log = log_of(SPACE.noise_free)
    result = calibrated(log, SPACE.model.arm).result
    np.testing.assert_array_equal(result.positions, log.observations.position)
    assert result.before.shape == (60, 3)
    assert result.robot == robot_name(SPACE.model.arm) == "planar"
    exact = calibrated(log_of(SPACE.exact[1]), SPACE.model.arm).result
    assert np.abs(exact.before).max() < 1e-6
    assert not exact.n_neurons.any()


def test_the_resolution_of_an_arm_in_space_is_that_of_its_sensor():
    seen = SPACE.noise_free
    assert calibrated(log_of(seen), SPACE.model.arm).calibrator.model.resolution == 1e-4
    std = np.full((60, 3), [1e-3, 2e-3, 2e-3])
    known = calibrated(log_of(replace(seen, position_std=std)), SPACE.model.arm)
    np.testing.assert_allclose(known.calibrator.model.resolution, 3.0 * 3e-3)


def test_the_working_range_leaves_room_beside_every_joint():
    joints = np.array([[0.0, 1.0], [4.0, 1.0], [2.0, 1.0]])
    low, high = working_range(joints)
    np.testing.assert_allclose(low, [-0.2, 0.95])
    np.testing.assert_allclose(high, [4.2, 1.05])


def test_progress_is_told(log):
    done = []
    calibrated(log, NOMINAL, progress=lambda n, total: done.append((n, total)))
    assert done[-1] == (5 * N, 5 * N)  # all rows once, and four fifths of them five times
    assert done == sorted(done)


@pytest.mark.parametrize(
    ("kind", "robot", "columns"),
    [
        ("stereo", SPACE.model.arm, "x_m, y_m, z_m"),
        ("point", NOMINAL, "pointing_rad, range_m, eccentricity_rad"),
    ],
)
def test_a_log_of_another_kind_of_robot_is_refused(log, kind, robot, columns):
    wrong = log if kind == "stereo" else log_of(SPACE.seen)
    assert wrong.kind == kind
    with pytest.raises(LogError, match=f"run.csv: robot planar needs a log with .* {columns}"):
        calibrated(wrong, robot)


@pytest.mark.parametrize("n", [1, 8])
def test_too_few_rows_are_refused(n):
    with pytest.raises(LogError, match=f"run.csv: {n} usable rows; at least 9"):
        calibrated(log_of(sightings(n=n)), NOMINAL)


def test_a_summary_is_made_of_the_lengths_of_errors():
    lengths = np.arange(1.0, 101.0)
    turn = np.exp(1j * np.arange(100.0))
    summary = ErrorSummary.of(np.transpose([(lengths * turn).real, (lengths * turn).imag]))
    assert summary.n == 100
    np.testing.assert_allclose(summary.mean, 50.5)
    np.testing.assert_allclose(summary.rms, np.sqrt(np.mean(lengths**2)))
    np.testing.assert_allclose(summary.p95, 95.05)
    np.testing.assert_allclose(summary.max, 100.0)


def test_the_default_is_the_combined_calibrator_where_the_robot_allows_it(log):
    run = calibrate_log(log, NOMINAL)
    assert isinstance(run.calibrator, Combined)
    assert run.result.method == "combined"
    assert run.result.n_neurons is None
    placed = calibrate_log(log_of(SPACE.seen), SPACE.model.arm)
    assert isinstance(placed.calibrator, NetworkCorrection)
    with pytest.raises(LogError, match="combined knows only the planar robot and arms"):
        calibrate_log(log_of(SPACE.seen), SPACE.model.arm, method="combined")
