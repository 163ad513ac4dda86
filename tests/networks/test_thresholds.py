"""Where learning begins and ends: errors, distances and responses at their thresholds."""

import numpy as np
import pytest

from handeye.networks import CMAC, Constant, ResourceAllocatingNetwork, VirtualNeuron


def test_thresholds_must_be_exceeded():
    network = ResourceAllocatingNetwork(
        1, 1, schedule=Constant(0.5), error_threshold=1.0, learning_threshold=0.25
    )
    assert not network.learn([0.0], [1.0]).allocated  # |e| = theta_e
    assert network.learn([0.0], [1.5]).allocated
    assert not network.learn([0.5], [9.0]).allocated  # distance = theta_d
    assert network.learn([np.nextafter(0.5, 1.0)], [9.0]).allocated
    before = network.weights
    network.learn([0.0], network.predict([0.0]) + 0.25)  # |e| = theta_l
    np.testing.assert_array_equal(network.weights, before)
    network.learn([0.0], network.predict([0.0]) + 0.26)
    assert not np.array_equal(network.weights, before)


def test_the_error_threshold_is_for_the_norm_of_the_error():
    network = ResourceAllocatingNetwork(1, 2, error_threshold=5.0)
    assert not network.learn([0.0], [2.9, 4.0]).allocated
    assert network.learn([0.0], [3.1, 4.0]).allocated


@pytest.mark.parametrize("active_rule", [VirtualNeuron, CMAC])
def test_only_active_neurons_are_corrected(active_rule):
    network = ResourceAllocatingNetwork(
        1, 1, adaptation=active_rule(rate=0.5, on_threshold=0.3), capacity=3, half_max_fraction=0.5
    )
    network.place([[0.0], [1.0], [2.0]], [[1.0], [1.0], [1.0]])
    o = np.exp(-(np.array([0.55, 0.45, 1.45]) ** 2) / network.widths)
    assert (o > 0.3).tolist() == [False, True, False]
    before = network.weights
    network.learn([0.55], [7.0])
    assert (network.weights != before)[:, 0].tolist() == [False, True, False]


@pytest.mark.parametrize("active_rule", [VirtualNeuron, CMAC])
def test_a_neuron_at_the_on_threshold_is_not_active(active_rule):
    for on_threshold, changes in ((1.0, False), (np.nextafter(1.0, 0.0), True)):
        rule = active_rule(on_threshold=on_threshold)
        network = ResourceAllocatingNetwork(1, 1, adaptation=rule, capacity=1)
        network.learn([0.0], [1.0])
        network.learn([0.0], [2.0])  # its response is one
        assert (network.weights[0, 0] != 1.0) == changes


def test_a_rule_without_active_neurons_changes_nothing(rule):
    network = ResourceAllocatingNetwork(1, 1, adaptation=rule, capacity=1)
    network.learn([0.0], [1.0])
    before = network.centers, network.widths, network.weights
    learned = network.learn([50.0], [1.0])
    assert learned.error == 1.0
    assert not learned.allocated
    for array, old in zip((network.centers, network.widths, network.weights), before, strict=True):
        np.testing.assert_array_equal(array, old)
