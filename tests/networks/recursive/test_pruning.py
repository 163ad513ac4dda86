"""What pruning removes, and what it may change."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.networks.recursive.test_recursion import grown, information, responses, samples
from tests.networks.samples import fewer

from handeye.networks import InputSpace
from handeye.networks.recursive import RecursiveNetwork


@settings(max_examples=fewer(10, 3), deadline=None)
@given(st.floats(1e-4, 0.5), st.integers(0, 10**6))
def test_outputs_at_what_was_learned_change_by_less_than_the_tolerance(tolerance, seed):
    network = grown(capacity=30)
    grown_at = network.trials
    x, y = samples(120, seed)
    network.learn_many(x, y)
    before = network.predict_many(x)
    removed = network.prune(tolerance)
    assert network.n_neurons == 30 - removed
    change = network.predict_many(x) - before
    # The bound is on all samples together; these are some of them.
    assert (change**2).sum() <= tolerance**2 * (grown_at + 120) * (1.0 + 1e-9)


def test_as_many_are_removed_as_the_tolerance_lets():
    removed = []
    for tolerance in (1e-9, 1e-3, 0.01, 0.1, 10.0):
        network = grown(capacity=30)
        network.learn_many(*samples(120))
        removed.append(network.prune(tolerance))
    assert removed[0] == 0
    assert removed == sorted(removed)
    assert 0 < removed[2] < removed[3] < removed[4] == 30


def test_the_others_take_over_as_well_as_they_can():
    network = grown(capacity=20)
    network.learn_many(*samples(100))
    A, W, centers = information(network), network.weights, network.centers
    network.prune(0.0)
    A = information(network)
    assert network.prune(0.03) > 0
    left = [int(np.flatnonzero((centers == c).all(axis=1))[0]) for c in network.centers]
    assert left == sorted(left)
    # Least |(W' - W)|_A among weights that are zero at the removed neurons.
    b = A @ W
    kept = np.ix_(left, left)
    np.testing.assert_allclose(network.weights, np.linalg.solve(A[kept], b[left]), atol=1e-8)
    np.testing.assert_allclose(information(network), A[kept], rtol=1e-12)


def test_a_pruned_network_goes_on_learning():
    network = grown(capacity=20)
    network.learn_many(*samples(100))
    network.prune(0.03)
    A, W = information(network), network.weights
    network = network.copy()
    network.settings = network.settings._replace(distance_threshold=1e9)
    network._learner.settings = network.settings
    x, y = samples(5, seed=4)
    for x_i, y_i, o in zip(x, y, responses(network, x), strict=True):
        P, e = np.linalg.inv(A), y_i - o @ W
        W, A = W + np.outer(P @ o, e) / (1.0 + o @ P @ o), A + np.outer(o, o)
        np.testing.assert_allclose(network.learn(x_i, y_i).error, e, atol=1e-9)


def test_room_is_made_for_new_neurons_when_the_capacity_is_reached():
    def network(tolerance):
        return RecursiveNetwork(
            2, 1, inputs=InputSpace.scaled([0.2, 0.2]), capacity=30, relevance_samples=None,
            prune_tolerance=tolerance, distance_threshold=0.5, forgetting=0.99,
        )  # fmt: skip

    rng = np.random.default_rng(0)
    x = rng.uniform(-0.5, 0.5, size=(1000, 2))
    x[400:] += 3.0  # the robot now works elsewhere
    y = np.sin(6.0 * x[:, :1]) * np.cos(5.0 * x[:, 1:])
    left = []
    for tolerance in (0.0, 0.02):
        learner = network(tolerance)
        learner.learn_many(x, y)
        assert learner.n_neurons <= 30
        left.append(np.mean((learner.predict_many(x[800:]) - y[800:]) ** 2) / y[800:].var())
    assert left[0] > 0.9
    assert left[1] < 0.1
