"""Which neurons are kept, and what they know of samples that came before them."""

import numpy as np
import pytest
from tests.networks.recursive.test_recursion import information, prior, responses, samples
from tests.networks.samples import fewer

from handeye.networks import InputSpace
from handeye.networks.recursive import RecursiveNetwork
from handeye.networks.recursive.posterior import novel, prior_factor


def network(novelty, **options):
    return RecursiveNetwork(
        2, 2, inputs=InputSpace.scaled([0.5, 0.5]), relevance_samples=None, noise_ratio=0.05,
        novelty=novelty, distance_threshold=0.0, **options,
    )  # fmt: skip


def missing(learner, x):
    """1 - k^T K^-1 k, written out."""
    K = responses(learner, learner.centers) + 1e-6 * np.eye(learner.n_neurons)
    k = responses(learner, x)
    return 1.0 + 1e-6 - np.einsum("ij,jk,ik->i", k, np.linalg.inv(K), k)


@pytest.mark.parametrize("novelty", [0.1, 1.0])
def test_what_is_left_out_is_represented_and_what_is_kept_was_not(novelty):
    learner = network(novelty)
    x, y = samples(300)
    allocated = learner.learn_many(x, y).allocated
    learner.prune(0.0)  # consolidates
    kept = learner.n_neurons
    assert kept < 100 < allocated.sum()
    assert missing(learner, x[allocated]).max() <= novelty * 0.05 * (1.0 + 1e-6) + 2e-6
    # Each is missed by those before it.
    K = responses(learner, learner.centers) + 1e-6 * np.eye(kept)
    pivots = np.diag(np.linalg.cholesky(K)) ** 2
    assert pivots.min() > 1e-6
    assert (pivots > novelty * 0.05).mean() > 0.7


def test_that_of_which_most_is_missing_is_taken_first():
    learner = network(0.5)
    points = samples(60)[0] / 0.5
    K = np.exp(-0.5 * ((points[:, np.newaxis] - points) ** 2).sum(axis=2)) + 1e-6 * np.eye(60)
    chosen: list[int] = []
    while True:
        left = np.diag(K).copy()
        if chosen:
            among = K[np.ix_(chosen, chosen)]
            left -= np.einsum("ij,jk,ik->i", K[:, chosen], np.linalg.inv(among), K[:, chosen])
            left[chosen] = 0.0
        if left.max() <= 1e-6 + 0.5 * 0.05:
            break
        chosen.append(int(np.argmax(left)))
    posterior = learner._learner.posterior
    found = novel(posterior, learner.settings, 0, points, prior_factor(posterior, 0))
    assert found.tolist() == sorted(chosen)


def test_without_the_threshold_all_are_kept():
    learner = network(0.0, capacity=80)
    allocated = learner.learn_many(*samples(200)).allocated
    learner.prune(0.0)
    assert learner.n_neurons == allocated.sum() == 80


def test_what_is_left_out_is_not_missed():
    n, capacity = fewer(2000, 200), fewer(400, 120)
    x, y = samples(n)
    probe = samples(300, seed=1)[0]
    many, few = network(0.0, capacity=capacity), network(0.01, capacity=capacity)
    for learner in (many, few):
        learner.learn_many(x, y)
    assert few.n_neurons < fewer(0.4, 0.7) * many.n_neurons
    difference = few.predict_many(probe) - many.predict_many(probe)
    uncertain = np.sqrt(many.variance_many(probe) - many.noise**2)
    assert np.abs(difference).max() < uncertain.max()


def test_neurons_of_the_first_samples_know_them_all():
    learner = RecursiveNetwork(2, 2, capacity=100, relevance_samples=60)
    x, y = samples(60)
    learner.learn_many(x, y)
    learner.prune(0.0)
    o = responses(learner, x)
    # Nothing is inherited: the neurons were there before the samples.
    np.testing.assert_allclose(information(learner) - prior(learner), o.T @ o, atol=1e-9)
