"""Every error, output and variance is that of the textbook's recursion, sample by sample."""

import numpy as np
import pytest

from handeye.errors import InvalidInput
from handeye.networks import InputSpace
from handeye.networks.recursive import RecursiveNetwork
from handeye.networks.recursive.linear import symmetric

D, M = 2, 2


def samples(n, seed=0):
    rng = np.random.default_rng(seed)
    x = rng.uniform(-1.0, 1.0, size=(n, D))
    y = np.column_stack([np.sin(2.0 * x[:, 0] + x[:, 1]), x[:, 0] * x[:, 1]])
    return x, y + 0.1 * rng.normal(size=y.shape)


def grown(capacity=12, **settings):
    """A network with all its neurons and nothing pending."""
    network = RecursiveNetwork(
        D, M, capacity=capacity, relevance_samples=None, inputs=InputSpace.scaled([0.3, 0.4]),
        **settings,
    )  # fmt: skip
    x, y = samples(400)
    for x_i, y_i in zip(x, y, strict=True):
        network.learn(x_i, y_i)
        if network.n_neurons == capacity and network._learner.known == 0:
            return network
    raise AssertionError("it did not grow")


def responses(network, x):
    z = (((x[:, np.newaxis] - network.centers) / network.scales) ** 2).sum(axis=2)
    return np.exp(-0.5 * z)


def information(network, b=0):
    """A of one block, written out."""
    posterior = network._learner.posterior
    n = posterior.units.counts[b]
    return symmetric(posterior.prior[b, :n, :n] + posterior.information[b, :n, :n])


def test_errors_outputs_and_variances_are_those_of_recursive_least_squares():
    network = grown()
    A, W = information(network), network.weights
    x, y = samples(150, seed=1)
    query = samples(5, seed=2)[0]
    for x_i, y_i, o in zip(x, y, responses(network, x), strict=True):
        e = y_i - o @ W
        P = np.linalg.inv(A)
        W = W + np.outer(P @ o, e) / (1.0 + o @ P @ o)
        A = A + np.outer(o, o)
        np.testing.assert_allclose(network.learn(x_i, y_i).error, e, atol=1e-9)
        np.testing.assert_allclose(network.predict(query[0]), responses(network, query)[0] @ W,
                                   atol=1e-9)  # fmt: skip
    np.testing.assert_allclose(network.weights, W, atol=1e-8)
    o = responses(network, query)
    K = responses(network, network.centers) + 1e-6 * np.eye(12)
    k = responses(network, query)
    uncertain = np.einsum("ij,jk,ik->i", o, np.linalg.inv(A), o)
    missing = 1.0 - np.einsum("ij,jk,ik->i", k, np.linalg.inv(K), k)
    noise = network.noise**2
    expected = np.outer(uncertain, noise) + np.maximum(noise, np.outer(missing, noise / 0.01))
    np.testing.assert_allclose(network.variance_many(query), expected, rtol=1e-5)


def test_the_past_is_forgotten_by_the_same_factor_at_each_sample():
    f = 0.97
    network = grown(forgetting=f)
    assert network._learner._horizon() == 22  # it halves in 22.8 samples
    D_, W = information(network) - prior(network), network.weights
    x, y = samples(22, seed=1)
    # Between two consolidations all is forgotten, then the prior is as it was.
    A = D_ + prior(network)
    for x_i, y_i, o in zip(x, y, responses(network, x), strict=True):
        A = f * A
        P = np.linalg.inv(A)
        e = y_i - o @ W
        W = W + np.outer(P @ o, e) / (1.0 + o @ P @ o)
        A = A + np.outer(o, o)
        np.testing.assert_allclose(network.learn(x_i, y_i).error, e, atol=1e-9)
    assert network._learner.known == 0
    np.testing.assert_allclose(network.weights, W, atol=1e-9)
    remaining = A - f**22 * prior(network)
    np.testing.assert_allclose(information(network), prior(network) + remaining, rtol=1e-9)


def prior(network, b=0):
    posterior = network._learner.posterior
    n = posterior.units.counts[b]
    return symmetric(posterior.prior[b, :n, :n])


def test_the_prior_is_that_of_a_gaussian_process():
    network = grown(noise_ratio=0.03)
    K = responses(network, network.centers)
    np.testing.assert_allclose(prior(network), 0.03 * (K + 1e-6 * np.eye(12)), rtol=1e-12)


def test_a_new_neuron_inherits_the_information_of_its_imitation():
    network = RecursiveNetwork(
        D, M, capacity=None, relevance_samples=None, distance_threshold=0.9,
        inputs=InputSpace.scaled([0.3, 0.4]),
    )  # fmt: skip
    x, y = samples(200)
    network.learn_many(x, y)
    network.prune(0.0)  # consolidates
    old = network._learner.n_neurons
    before = information(network) - prior(network)
    beside = np.array([[1.3, 0.2], [-0.3, -1.4]])
    network.learn_many(beside, [[1.0, 0.0], [0.0, 1.0]])
    network.prune(0.0)
    assert network._learner.n_neurons == old + 2
    K = prior(network) / 0.01
    imitation = np.linalg.solve(K[:old, :old], K[:old, old:])
    T = np.concatenate([np.eye(old), imitation], axis=1)
    assert (np.abs(imitation).max(axis=0) > 0.2).all()
    o = responses(network, beside)[:, :old]
    seen = before + o.T @ o
    np.testing.assert_allclose(information(network) - prior(network), T.T @ seen @ T, atol=1e-8)


def test_blocks_take_the_others_for_noise():
    network = grown(capacity=18, block=6)
    old = [information(network, b) for b in range(3)]
    W = network.weights
    x, y = samples(40, seed=1)
    parts = np.split(responses(network, x), 3, axis=1)
    spread = [o @ np.linalg.inv(A) @ o.T for o, A in zip(parts, old, strict=True)]
    S = np.eye(40) + sum(spread)
    steps = [np.linalg.inv(A) @ o.T @ np.linalg.solve(S, y - np.concatenate(parts, axis=1) @ W)
             for A, o in zip(old, parts, strict=True)]  # fmt: skip
    network.learn_many(x, y)
    np.testing.assert_allclose(network.weights, W + np.concatenate(steps), atol=1e-8)
    network.prune(0.0)
    for b in range(3):
        noise = S - spread[b]
        expected = old[b] + parts[b].T @ np.linalg.inv(noise) @ parts[b]
        np.testing.assert_allclose(information(network, b), expected, rtol=1e-7, atol=1e-9)


@pytest.mark.parametrize("block", [7, 1000])
def test_consolidation_changes_no_output(block):
    network = grown(capacity=21, block=block)
    x, y = samples(30, seed=3)
    network.learn_many(x, y)
    before = network.predict_many(x)
    assert network._learner.known == 30
    network.prune(0.0)
    assert network._learner.known == 0
    np.testing.assert_allclose(network.predict_many(x), before, atol=1e-10)


def test_a_neuron_is_added_only_where_it_is_novel_and_there_is_room():
    network = RecursiveNetwork(
        1, 1, inputs=InputSpace.scaled([1.0]), capacity=3, relevance_samples=None,
        distance_threshold=0.5, error_threshold=0.2,
    )  # fmt: skip
    given = [(0.0, 1.0), (0.4, 5.0), (0.6, 0.0), (3.0, 0.1), (3.0, 1.0), (9.0, 1.0), (20.0, 1.0)]
    result = network.learn_many([[x] for x, _ in given], [[y] for _, y in given])
    allocated = [True, False, True, False, True, False, False]
    error = np.abs(result.error[:, 0])
    assert error[3] < 0.2 < error[2]
    assert result.allocated.tolist() == allocated
    assert network.n_neurons == 3


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("block", 0), ("noise_ratio", 0.0), ("forgetting", 1.01), ("forgetting", 0.2),
        ("distance_threshold", -1.0), ("prune_tolerance", np.nan), ("capacity", 0),
        ("relevance_samples", 7), ("inputs", InputSpace.scaled([1.0])),
    ],
)  # fmt: skip
def test_refuses_settings_out_of_range(name, value):
    with pytest.raises(InvalidInput, match=name):
        RecursiveNetwork(D, M, **{name: value})
