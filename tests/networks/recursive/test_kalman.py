"""The extended Kalman filter of a KalmanNetwork against its formulas."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.networks.samples import fewer

from handeye.networks import InputSpace
from handeye.networks.recursive import KalmanNetwork
from handeye.networks.recursive.kalman_filter import linearise
from handeye.networks.recursive.kalman_kernels import evaluate, strongest

D, M = 2, 2
P = M + D + 1


def samples(n, seed=0):
    rng = np.random.default_rng(seed)
    x = rng.uniform(-1.0, 1.0, size=(n, D))
    y = np.column_stack([np.sin(2.0 * x[:, 0] + x[:, 1]), x[:, 0] * x[:, 1]])
    return x, y + 0.05 * rng.normal(size=y.shape)


def grown(capacity=6, n=200, **options):
    network = KalmanNetwork(
        D, M, capacity=capacity, inputs=InputSpace.scaled([0.8, 1.3]),
        **{"neighbours": capacity, "distance_threshold": 0.4} | options,
    )  # fmt: skip
    network.learn_many(*samples(n))
    assert network.n_neurons == capacity
    return network


def parameters(network):
    """Of every neuron (n, p), and the logarithms of the scales (d,)."""
    own = np.column_stack(
        [network.weights, network.centers / network.inputs.scales, np.log(network.widths)]
    )
    return own, np.log(network.scales)


def outputs(own, log_scales, first_scales, x):
    """The formula, at one input (d,)."""
    W, C, h = own[:, :M], own[:, M : M + D] * first_scales, np.exp(own[:, -1])
    z = (((x - C) / np.exp(log_scales)) ** 2).sum(axis=1)
    return np.exp(-z / (2.0 * h**2)) @ W


def derivatives(network, x):
    """H (n, m, p) and of the scales (m, d), by differences."""
    own, scales = parameters(network)
    space, step = network.inputs.scales, 1e-6
    H, by_scale = np.empty((len(own), M, P)), np.empty((M, D))
    for j in range(len(own)):
        for i in range(P):
            change = np.zeros_like(own)
            change[j, i] = step
            ahead, behind = (outputs(own + s * change, scales, space, x) for s in (1.0, -1.0))
            H[j, :, i] = (ahead - behind) / (2.0 * step)
    for i in range(D):
        change = np.eye(D)[i] * step
        ahead, behind = (outputs(own, scales + s * change, space, x) for s in (1.0, -1.0))
        by_scale[:, i] = (ahead - behind) / (2.0 * step)
    return H, by_scale


def covariances(network):
    roots = network._units.roots[: network.n_neurons]
    return roots @ roots.transpose(0, 2, 1)


def test_outputs_are_those_of_the_formula():
    network = grown()
    x = samples(5, seed=1)[0]
    expected = [outputs(*parameters(network), network.inputs.scales, x_i) for x_i in x]
    np.testing.assert_allclose(network.predict_many(x), expected, rtol=1e-12)


def test_derivatives_are_those_of_the_outputs():
    network = grown()
    x = samples(1, seed=2)[0]
    H, by_scale = derivatives(network, x[0])
    work = network._work
    evaluate(network._units, network._shared, 6, x[0] / network.inputs.scales, work, np.empty(M))
    found = strongest(6, work)
    assert sorted(work.which[:found]) == list(range(6))
    linearise(network._units, network._shared, found, x[0] / network.inputs.scales, work)
    np.testing.assert_allclose(work.slopes, H[work.which], atol=1e-7)
    np.testing.assert_allclose(work.by_scale, by_scale, atol=1e-7)


@pytest.mark.parametrize("neighbours", [6, 2])
def test_a_step_is_that_of_the_decoupled_filter(neighbours):
    network = grown(neighbours=neighbours, scale_deviation=0.1)
    x, y = samples(1, seed=3)
    if neighbours < 6:  # the scales then see the neighbours only
        network._shared.root[:] = 0.0
    H, by_scale = derivatives(network, x[0])
    before, scales = parameters(network)
    old, R = covariances(network), network.noise**2
    root = network._shared.root.copy()
    strong = np.argsort(-H[:, 0, 0])[:neighbours]  # the derivative by a weight is the response
    error = network.learn(x[0], y[0]).error
    np.testing.assert_allclose(
        error, y[0] - outputs(before, scales, network.inputs.scales, x[0]), atol=1e-12
    )
    groups = [*old[strong], root @ root.T]
    steps = [np.zeros(len(covariance)) for covariance in groups]
    for k in range(M):  # one output after the other, every group taking the others for noise
        h = [*H[strong, k], by_scale[k]]
        total = R[k] + sum(h_g @ P_g @ h_g for h_g, P_g in zip(h, groups, strict=True))
        left = error[k] - sum(h_g @ step for h_g, step in zip(h, steps, strict=True))
        steps = [s_g + P_g @ h_g * left / total
                 for s_g, P_g, h_g in zip(steps, groups, h, strict=True)]  # fmt: skip
        groups = [P_g - np.outer(P_g @ h_g, P_g @ h_g) / total
                  for P_g, h_g in zip(groups, h, strict=True)]  # fmt: skip
    after, new_scales = parameters(network)
    before[strong] += steps[:-1]
    old[strong] = groups[:-1]
    np.testing.assert_allclose(after, before, atol=1e-8)
    np.testing.assert_allclose(covariances(network), old, atol=1e-8)
    np.testing.assert_allclose(new_scales, scales + steps[-1], atol=1e-8)
    kept = network._shared.root @ network._shared.root.T
    np.testing.assert_allclose(kept, groups[-1], atol=1e-9)
    np.testing.assert_allclose(network.noise**2, R + (error**2 - R) / network.trials, rtol=1e-12)


@pytest.mark.parametrize("neighbours", [1, 3, 6])
def test_the_neighbours_are_those_of_the_largest_responses(neighbours):
    network = grown(neighbours=neighbours)
    work = network._work
    for x_i in samples(20, seed=6)[0] / network.inputs.scales:
        evaluate(network._units, network._shared, 6, x_i, work, np.empty(M))
        assert strongest(6, work) == neighbours
        assert set(work.which) == set(np.argsort(-work.o)[:neighbours])


def test_weights_alone_and_one_neuron_are_recursive_least_squares():
    network = KalmanNetwork(
        D, M, capacity=1, weight_deviation=2.0, shape_deviation=0.0, scale_deviation=0.0
    )
    x, y = samples(60)
    network.learn(x[0], y[0])
    w, p = y[0].copy(), np.full(M, 4.0)
    for t, (x_i, y_i) in enumerate(zip(x[1:], y[1:], strict=True)):
        R = network.noise**2
        o = np.exp(-0.5 * (((x_i - x[0]) / np.sqrt(2.0)) ** 2).sum())
        e = y_i - o * w
        gain = p * o / (R + o * p * o)
        w, p = w + gain * e, p - gain * o * p
        np.testing.assert_allclose(network.learn(x_i, y_i).error, e, atol=1e-12)
        np.testing.assert_allclose(network.weights[0], w, atol=1e-12)
        np.testing.assert_allclose(network.noise**2, R + (e**2 - R) / (t + 2.0), rtol=1e-12)
    np.testing.assert_allclose(network.centers, x[:1], rtol=1e-15)


def test_the_variance_is_that_of_the_linearised_output():
    network = grown()
    x = samples(1, seed=4)[0]
    H, by_scale = derivatives(network, x[0])
    total = (
        np.diag(network.noise**2)
        + by_scale @ network._shared.root @ (by_scale @ network._shared.root).T
    )
    total = total + sum(h @ p @ h.T for h, p in zip(H, covariances(network), strict=True))
    np.testing.assert_allclose(network.variance(x[0]), np.diag(total), rtol=1e-6)


@settings(max_examples=fewer(20, 5), deadline=None)
@given(st.integers(0, 10**6), st.floats(0.0, 1.0))
def test_a_step_reduces_the_error_at_the_same_sample(seed, shape):
    network = grown(shape_deviation=shape)
    x, y = samples(1, seed)
    first = network.learn(x[0], y[0]).error
    again = y[0] - network.predict(x[0])
    # In the metric of the filter; with two outputs of alike noise that is nearly the length.
    assert np.linalg.norm(again) <= np.linalg.norm(first) * (1.0 + 1e-6)


@pytest.mark.parametrize("forgetting", [1.0, 0.99])
def test_covariances_stay_symmetric_positive_and_below_their_prior(forgetting):
    rng = np.random.default_rng(0)
    network = KalmanNetwork(3, 1, capacity=20, forgetting=forgetting, error_threshold=0.1)
    x = rng.normal(size=(fewer(30_000, 300), 3)) * [1.0, 1e3, 1e-3]  # far away, and hardly anything
    x[::3] = x[0]
    y = np.sign(x[:, :1]) * 10.0 ** rng.uniform(-6.0, 3.0, size=(len(x), 1))
    network.learn_many(x, y)
    n = network.n_neurons
    spread = np.sqrt(np.einsum("ipq,ipq->ip", *[network._units.roots[:n]] * 2))
    assert (spread <= network._units.prior[:n] * (1.0 + 1e-9)).all()
    for root in network._units.roots[:n]:
        assert np.linalg.eigvalsh(root @ root.T).min() > -1e-15
    assert np.isfinite(network.predict_many(x[:100])).all()
    assert (network.scales > 0.0).all()


def test_forgetting_lets_a_neuron_follow():
    left = {}
    for forgetting in (1.0, 0.95):
        network = grown(capacity=12, n=fewer(3000, 300), forgetting=forgetting)
        x, y = samples(fewer(400, 150), seed=5)
        network.learn_many(x, 1.0 - y)
        left[forgetting] = np.mean((network.predict_many(x) - 1.0 + y) ** 2)
    assert left[0.95] < 0.5 * left[1.0]


def test_learning_scales_finds_what_matters():
    rng = np.random.default_rng(1)
    x = rng.uniform(-1.0, 1.0, size=(fewer(4000, 500), 2))
    y = np.sin(4.0 * x[:, :1])  # the second does not matter
    fixed, learned = (KalmanNetwork(2, 1, capacity=40, scale_deviation=s) for s in (0.0, 0.3))
    for network in (fixed, learned):
        network.learn_many(x, y)
    np.testing.assert_allclose(fixed.scales, np.sqrt(2.0))
    assert learned.scales[1] > 2.0 * learned.scales[0]


def test_moving_neurons_do_more_with_few_of_them():
    n = fewer(4000, 500)
    x, y = samples(n)
    left = []
    for shape in (0.0, 0.3):
        network = grown(capacity=8, n=n, shape_deviation=shape, scale_deviation=0.0)
        left.append(np.mean((network.predict_many(x) - y) ** 2))
    assert left[1] < 0.5 * left[0]
