import numpy as np
import pytest

from handeye.networks import Constant, GaussianDecay, VirtualNeuron
from handeye.thesis.experiment import FULL, Curve, Effort
from handeye.thesis.experiments.allocation import ALLOCATION, trials_before_second_neuron
from handeye.thesis.experiments.grids import FIXED, GRIDS, VARIABLE, GridLearning, grid_curve
from handeye.thesis.experiments.width import CLEAN, RiskyLearning
from handeye.thesis.learning import Learning, learning_curve
from handeye.thesis.plants import NORMAL


def test_the_grids_leave_out_the_stretched_arm_and_nothing_else():
    setting = GRIDS.settings["variable-clean"]
    variable, fixed = setting.visits(VARIABLE, 0), setting.visits(FIXED, 0)
    assert len(variable) == 1 + 8 + 64 + 512 - 1  # the single point of the coarsest is at beta = 0
    assert len(fixed) == 512
    assert np.min(np.abs(variable.joints[:, 1])) == pytest.approx(0.1 * np.pi)
    np.testing.assert_array_equal(variable[-512:].joints, fixed.joints)


def test_what_is_seen_on_the_grid_is_what_the_plant_shows_there():
    setting = GRIDS.settings["fixed-clean"]
    seen = setting.visits(FIXED, 0)
    tips = NORMAL.tips(seen.joints)
    _, distance, _ = CLEAN.sight(tips, np.zeros(len(tips)), np.zeros((len(tips), 2)))
    np.testing.assert_allclose(seen.range, distance, atol=1e-4)
    noisy = GRIDS.settings["fixed-noisy"].visits(FIXED, 0)
    assert 1e-3 < np.std(noisy.range - seen.range) < 3e-2


def test_neurons_on_the_grid_are_counted_and_the_number_is_kept():
    setting = GridLearning(CLEAN, capacity=568, grid=FIXED, trials=200, tests=2)
    curves = grid_curve(setting, 0, FULL)
    neurons = curves["neurons"]
    assert isinstance(neurons, Curve)
    assert neurons.value[0] == curves["on_grid"]
    assert 400 < neurons.value[0] <= 512
    assert neurons.value[-1] == 568


def test_trials_before_the_second_neuron():
    at_once = Learning(NORMAL, schedule=Constant(0.0), trials=10)
    assert trials_before_second_neuron(at_once, 0, FULL) == 1.0
    never = Learning(NORMAL, schedule=Constant(100.0), trials=10)
    assert trials_before_second_neuron(never, 0, FULL) == 10.0
    late = Learning(NORMAL, schedule=GaussianDecay(chi=10.0), trials=100)
    assert 1.0 < trials_before_second_neuron(late, 0, FULL) < 20.0


def test_schedules_meet_the_same_world_and_the_lowest_end_is_picked():
    measured = ALLOCATION.measure(ALLOCATION.settings["noisy"], 0, Effort(0.02))
    errors = [q for name, q in measured.items() if name.endswith("-error")]
    assert len(errors) == 10
    ends = [error.value[-1] for error in errors if isinstance(error, Curve)]
    assert measured["lowest_error"] == min(ends)
    assert len({error.value[0] for error in errors if isinstance(error, Curve)}) == 1


def test_a_learner_that_diverges_is_recorded_with_a_hand_that_goes_anywhere():
    wild = VirtualNeuron(rate=1e9)
    setting = RiskyLearning(CLEAN, capacity=5, adaptation=wild, trials=200, tests=100)
    curves = learning_curve(setting, 0, FULL)
    error, neurons = curves["error"], curves["neurons"]
    assert isinstance(error, Curve)
    assert isinstance(neurons, Curve)
    assert np.all(np.isfinite(error.value))
    assert 1.0 < error.value[-1] < 2.0 * CLEAN.arm.reach
    assert neurons.value[-1] == 5
