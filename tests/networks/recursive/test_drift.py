"""Forgetting, uncertainty, and a million samples."""

import numpy as np
from tests.networks.samples import fewer

from handeye.networks import InputSpace
from handeye.networks.recursive import RecursiveNetwork


def stream(n, seed, noise=0.05):
    rng = np.random.default_rng(seed)
    x = rng.uniform(-1.0, 1.0, size=(n, 2))
    smooth = np.sin(3.0 * x[:, :1]) + 0.5 * np.cos(4.0 * x[:, 1:])
    return x, smooth + noise * rng.normal(size=(n, 1)), smooth


def network(**settings):
    return RecursiveNetwork(
        2, 1, inputs=InputSpace.scaled([0.4, 0.4]), capacity=fewer(60, 30), relevance_samples=None,
        **settings,
    )  # fmt: skip


def test_forgetting_recovers_from_a_change():
    n, short = fewer(1000, 300), fewer(0.995, 0.98)
    x, y, smooth = stream(3 * n, 0)
    y[2 * n :] += 1.0 - 2.0 * smooth[2 * n :]  # the plant is another one
    left = {}
    for forgetting in (1.0, short):
        learner = network(forgetting=forgetting)
        learner.learn_many(x, y)
        probe = stream(300, 1)
        left[forgetting] = np.sqrt(np.mean((learner.predict_many(probe[0]) - 1.0 + probe[2]) ** 2))
    # All of it remembered: two thirds of the old plant remain, of which the rms is 0.8 or more.
    assert left[1.0] > 0.5
    assert left[short] < fewer(0.05, 0.1)


def test_what_is_not_visited_is_not_forgotten():
    x, y, _ = stream(fewer(1500, 500), 0)
    learner = network(forgetting=0.99)
    learner.learn_many(x, y)
    rng = np.random.default_rng(1)
    corner = rng.uniform(0.6, 1.0, size=(fewer(2000, 300), 2))
    learner.learn_many(corner, np.sin(3.0 * corner[:, :1]) + 0.5 * np.cos(4.0 * corner[:, 1:]))
    probe = stream(300, 2)
    far = (probe[0] < 0.0).all(axis=1)
    assert np.abs(learner.predict_many(probe[0]) - probe[2])[far].max() < fewer(0.15, 0.5)


def test_the_variance_is_that_of_the_errors():
    x, y, _ = stream(fewer(4000, 800), 0)
    learner = RecursiveNetwork(2, 1, capacity=fewer(100, 40), relevance_samples=100)
    learner.learn_many(x, y)
    probe, targets, _ = stream(fewer(2000, 500), 1)
    normalised = (targets - learner.predict_many(probe)) ** 2 / learner.variance_many(probe)
    # Its mean scatters by sqrt(2 / 2000) = 0.03 were it right, and the noise's estimate by 0.045.
    assert 0.8 < normalised.mean() < 1.2
    assert 0.9 < (normalised < 3.84).mean() <= 1.0  # 0.95 of a chi square
    np.testing.assert_allclose(learner.noise, 0.05, rtol=0.1)
    far = learner.variance([30.0, -30.0])
    signal = learner._learner.signal
    assert signal is not None
    np.testing.assert_allclose(far, signal, rtol=1e-12)
    assert far[0] > 10.0 * learner.variance([0.0, 0.0])[0]


def test_few_samples_leave_much_uncertain():
    learner = RecursiveNetwork(1, 1, inputs=InputSpace.scaled([0.3]), relevance_samples=None)
    learner.learn_many(np.linspace(-1.0, 0.0, 60)[:, np.newaxis], np.ones((60, 1)))
    near, beyond = learner.variance([-0.5]), learner.variance([2.0])
    assert near[0] < 0.1 * beyond[0]


def test_stable_over_tens_of_thousands_of_samples():
    # A million take the same course and longer.
    x, y, _ = stream(fewer(20_000, 2500), 0)
    x[:, 1] = 0.3 * x[:, 0]  # most directions of the weights are never excited
    for forgetting in (1.0, 0.98):
        learner = RecursiveNetwork(
            2, 1, inputs=InputSpace.scaled([0.5, 0.5]), capacity=24, relevance_samples=None,
            forgetting=forgetting,
        )  # fmt: skip
        error = learner.learn_many(x, np.sin(3.0 * x[:, :1]) + (y - y.mean())[:, :1] * 0.0).error
        assert np.isfinite(learner.weights).all()
        assert np.abs(learner.weights).max() < 1e4
        assert np.abs(error[-1000:]).max() < 1e-2
        n = learner._learner.n_neurons
        assert (np.diag(learner._learner.posterior.units.factor[0, :n, :n]) > 0.0).all()
