"""One sample at a time against the formulas of sections 3.5.1 to 3.5.4, in plain NumPy.

Every step starts from the state that the network is in, so rounding does not build up.
"""

import numpy as np
import pytest

from handeye.networks import (
    CMAC,
    Constant,
    GradientDescent,
    InputSpace,
    ResourceAllocatingNetwork,
    VirtualNeuron,
)

D_IN, D_OUT = 3, 2


def respond(response, z, R):
    """Eq 3.45, 3.107, 3.108."""
    r = np.sqrt(z) / R
    match type(response).__name__:
        case "Gaussian":
            return np.exp(-z / R)
        case "Cosine":
            return np.where(r < 1, (1 + np.cos(np.pi * r)) / 2, 0)
        case "Parabolic":
            return np.select([r <= 0.5, r <= 1], [1 - 2 * r**2, 2 * (1 - r) ** 2], 0)
    raise NotImplementedError


def slopes(response, z, R):
    """Eq 3.62, 3.63 and 3.109 to 3.112."""
    d = np.sqrt(z)
    match type(response).__name__:
        case "Gaussian":
            return -np.exp(-z / R) / R, z / R**2 * np.exp(-z / R)
        case "Cosine":
            s = np.where(d < R, np.sin(np.pi * d / R), 0)
            return -np.pi * s / (4 * R * d), np.pi * d * s / (2 * R**2)
        case "Parabolic":
            tests = [d < R / 2, d <= R]
            return (
                np.select(tests, [-2 / R**2, -2 * (R - d) / (d * R**2)], 0),
                np.select(tests, [4 * d**2 / R**3, 4 * (R - d) * d / R**3], 0),
            )
    raise NotImplementedError


def width(response, half_distance):
    """Response one half there."""
    if type(response).__name__ == "Gaussian":
        return half_distance**2 / np.log(2)
    return 2 * half_distance


def threshold(schedule, t, D):
    """Eq 3.47 to 3.56."""
    match type(schedule).__name__:
        case "Constant":
            return schedule.threshold
        case "Power":
            return schedule.k * D / t**schedule.exponent
        case "GaussianDecay":
            return D * np.exp(-((t / schedule.chi) ** 2))
        case "Logarithmic":
            return schedule.k * D / np.log(t + 1)
    raise NotImplementedError


class PlainNetwork:
    """The written-out formulas, on a copy of a network's state in scaled units."""

    def __init__(self, network, *, theta_e, theta_l, h, first_width, smallest_width):
        self.network = network
        self.scales = network.inputs.scales
        self.D = np.sqrt((((network.inputs.high - network.inputs.low) / self.scales) ** 2).sum())
        self.theta_e, self.theta_l, self.h = theta_e, theta_l, h
        self.first, self.floor = first_width * h * self.D, smallest_width * self.D
        self.take()

    def take(self):
        """Start again from the network's state."""
        self.C = self.network.centers / self.scales
        self.R = self.network.widths
        self.W = self.network.weights
        self.t = self.network.trials

    def learn(self, x, target):
        """Section A.6.3; returns the error before, and which of the three things was done."""
        x = x / self.scales
        z = ((x - self.C) ** 2).sum(axis=1)
        o = respond(self.network.response, z, self.R)
        e = target - self.W.T @ o
        self.t += 1
        size = np.sqrt((e**2).sum())
        distance = np.sqrt(z.min()) if len(z) else np.inf
        theta_d = threshold(self.network.schedule, self.t, self.D)
        room = self.network.capacity is None or len(self.R) < self.network.capacity
        if size > self.theta_e and distance > theta_d and room:
            half = max(self.h * distance, self.floor) if len(z) else self.first
            self.C = np.vstack([self.C, x])
            self.R = np.append(self.R, width(self.network.response, half))
            self.W = np.vstack([self.W, e])  # eq 3.46
            return e, "allocate"
        if size > self.theta_l:
            self.adapt(x, z, o, e)
            return e, "adapt"
        return e, "nothing"

    def adapt(self, x, z, o, e):
        """Eq 3.69, 3.73 and 3.59 to 3.61."""
        rule, response = self.network.adaptation, self.network.response
        active = o > getattr(rule, "on_threshold", -1)
        match type(rule).__name__:
            case "VirtualNeuron" if active.any():
                half = max(self.h * np.sqrt(z[active].min()), self.floor)
                V = respond(response, z, width(response, half)) * active
                if (V * o).sum() > 0:
                    self.W = self.W + rule.rate / (V * o).sum() * np.outer(V, e)
            case "FixedVirtualNeuron":
                half = max(rule.half_distance, self.floor)
                V = respond(response, z, width(response, half)) * active
                if (V * o).sum() > 0:
                    self.W = self.W + rule.rate * np.outer(V, e) / (V * o).sum()
            case "CMAC" if active.any():
                self.W = self.W + rule.rate / o[active].sum() * np.outer(active, e)
            case "GradientDescent":
                by_z, by_width = slopes(response, z, self.R)
                back = self.W @ e
                W = self.W + rule.rate * np.outer(o, e)
                C = self.C - 2 * rule.rate * (by_z * back)[:, None] * (x - self.C)
                R = self.R + rule.rate * by_width * back
                self.W, self.C, self.R = W, C, np.maximum(R, width(response, self.floor))
            case "VirtualNeuron" | "CMAC" | "NoAdaptation":
                pass
            case _:
                raise NotImplementedError


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
