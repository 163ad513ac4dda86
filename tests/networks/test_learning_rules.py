"""One sample at a time against the formulas of sections 3.5.1 to 3.5.4, in plain NumPy.

Every step starts from the state that the network is in, so rounding does not build up.
"""

import numpy as np
import pytest
from tests.networks.formulas import PlainNetwork, width

from handeye.networks import GradientDescent, InputSpace, ResourceAllocatingNetwork

D_IN, D_OUT = 3, 2

SETTINGS = {
    "theta_e": 0.3,
    "theta_l": 0.1,
    "h": 1.3,
    "first_width": 0.2,
    "smallest_width": 1e-3,
}
SPACE = InputSpace(*np.array([[-1, -2, 0], [1, 2, 0.5], [1.0, 2.0, 0.3]]))


def make(kinds, settings=SETTINGS, capacity: int | None = 14):
    return ResourceAllocatingNetwork(
        D_IN,
        D_OUT,
        inputs=SPACE,
        response=kinds.response,
        schedule=kinds.schedule,
        adaptation=kinds.adaptation,
        capacity=capacity,
        half_max_fraction=settings["h"],
        error_threshold=settings["theta_e"],
        learning_threshold=settings["theta_l"],
        first_width=settings["first_width"],
        smallest_width=settings["smallest_width"],
    )


def samples(seed, n):
    rng = np.random.default_rng(seed)
    x = SPACE.low + (SPACE.high - SPACE.low) * rng.random((n, D_IN))
    targets = np.column_stack([np.sin(2 * x[:, 0]) + x[:, 2], x[:, 1] * np.cos(x[:, 0])])
    return x, targets + 0.05 * rng.normal(size=targets.shape)


def assert_same(network, plain):
    assert network.n_neurons == len(plain.R)
    assert network.trials == plain.t
    np.testing.assert_allclose(network.centers / SPACE.scales, plain.C, rtol=1e-12, atol=1e-13)
    np.testing.assert_allclose(network.widths, plain.R, rtol=1e-12)
    scale = np.abs(plain.W).max(initial=1.0)
    np.testing.assert_allclose(network.weights, plain.W, rtol=1e-12, atol=1e-13 * scale)


def test_every_step_equals_the_formulas(every_kinds):
    network = make(every_kinds)
    plain = PlainNetwork(network, **SETTINGS)
    done = []
    for x, target in zip(*samples(5, 70), strict=True):
        plain.take()
        error, what = plain.learn(x, target)
        learned = network.learn(x, target)
        np.testing.assert_allclose(learned.error, error, rtol=1e-12, atol=1e-13)
        assert learned.allocated == (what == "allocate")
        assert_same(network, plain)
        done.append(what)
    # Slow schedules never give a second neuron in so few trials.
    assert set(done) >= {"allocate", "adapt"}


@pytest.mark.parametrize("seed", range(3))
def test_each_rule_equals_its_formula_in_a_network_of_overlapping_neurons(kinds, seed):
    rng = np.random.default_rng(seed)
    settings = {**SETTINGS, "theta_e": 1e6, "theta_l": 0.0}
    network = make(kinds, settings, capacity=None)
    network.place(samples(seed, 12)[0], rng.normal(size=(12, D_OUT)))
    plain = PlainNetwork(network, **settings)
    for x, target in zip(*samples(seed + 10, 25), strict=True):
        plain.take()
        error, what = plain.learn(x, target)
        assert what == "adapt"
        before = network.weights
        np.testing.assert_allclose(network.learn(x, target).error, error, rtol=1e-12, atol=1e-13)
        assert_same(network, plain)
        changed = not np.array_equal(before, network.weights)
        assert changed == (not np.array_equal(before, plain.W))
    assert (type(kinds.adaptation).__name__ == "NoAdaptation") or changed


def test_a_new_neuron_corrects_the_output_completely(kinds):
    network = make(kinds, {**SETTINGS, "theta_e": 0.0}, capacity=None)
    for x, target in zip(*samples(1, 20), strict=True):
        if network.learn(x, target).allocated:
            np.testing.assert_allclose(network.predict(x), target, rtol=1e-12, atol=1e-13)


def test_widths_follow_from_the_nearest_neighbour(response):
    network = ResourceAllocatingNetwork(1, 1, response=response, half_max_fraction=0.7)
    network.learn([0.0], [1.0])
    network.learn([1.0], [5.0])
    network.learn([0.75], [-5.0])
    halves = np.array([0.1 * 0.7 * 1.0, 0.7 * 1.0, 0.7 * 0.25])
    np.testing.assert_allclose(network.widths, width(response, halves), rtol=1e-14)


def test_gradient_descent_keeps_widths_at_the_floor(response):
    network = ResourceAllocatingNetwork(
        1, 1, response=response, adaptation=GradientDescent(50.0), capacity=1, smallest_width=0.01
    )
    network.learn([0.0], [1.0])
    network.learn([0.03], [-10.0])
    floor = width(response, 0.01)
    assert network.widths[0] == pytest.approx(floor, rel=1e-14)
    assert np.isfinite(network.predict([0.003])).all()


def test_a_virtual_neuron_next_to_nothing_does_not_overflow():
    # The virtual neuron answers 2^-1020 at the only neuron there is.
    h = 1020**-0.5
    network = ResourceAllocatingNetwork(1, 1, capacity=1, half_max_fraction=h, first_width=1 / h)
    network.learn([0.0], [1.0])
    learned = network.learn([0.9], [1e9])
    o = 0.5 ** (0.9**2)
    np.testing.assert_allclose(network.weights[0], 1.0 + 0.06 * learned.error / o, rtol=1e-9)
