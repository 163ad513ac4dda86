"""Scales from the first samples."""

import numpy as np
import pytest

from handeye.networks.recursive import RecursiveNetwork
from handeye.networks.recursive.evidence import _cost, fitting_factor, relevance


def samples(n=150, noise=0.1):
    rng = np.random.default_rng(0)
    x = rng.normal(size=(n, 3))
    smooth = np.column_stack([np.sin(2.0 * x[:, 0]) + x[:, 1], np.cos(2.0 * x[:, 0])])
    return x, smooth + noise * rng.normal(size=smooth.shape)


def test_the_gradient_is_that_of_the_cost():
    x, y = samples(40)
    logs = np.array([0.2, -0.1, 0.5, -2.0, 0.3])
    _, gradient = _cost(logs, x, y, 0.5)
    for i, step in enumerate(np.eye(5) * 1e-5):
        slope = (_cost(logs + step, x, y, 0.5)[0] - _cost(logs - step, x, y, 0.5)[0]) / 2e-5
        assert gradient[i] == pytest.approx(slope, rel=1e-5)


def test_the_cost_is_the_density_of_a_gaussian_process():
    x, y = samples(20)
    logs = np.array([0.2, -0.1, 0.5, -2.0, 0.3])
    z = (((x[:, np.newaxis] - x) / np.exp(logs[:3])) ** 2).sum(axis=2)
    C = np.exp(0.3) * np.exp(-0.5 * z) + np.exp(-2.0) * np.eye(20)
    density = -0.5 * np.einsum("ik,ij,jk->", y, np.linalg.inv(C), y)
    density -= 2 * 0.5 * np.linalg.slogdet(C)[1]
    prior = -0.5 * ((logs[:3] - 0.5) ** 2).sum()
    assert _cost(logs, x, y, 0.5)[0] == pytest.approx(-density - prior, rel=1e-10)


def test_what_does_not_matter_gets_a_long_scale_and_noise_is_found():
    found = relevance(*samples())
    assert found.scales[0] < found.scales[1] < found.scales[2]
    assert found.scales[2] > 4.0 * found.scales[0]
    size = (samples()[1] ** 2).mean(axis=0)
    np.testing.assert_allclose(found.noise / size, found.noise[0] / size[0])
    assert 0.005 < found.noise.mean() < 0.02
    assert found.noise_ratio == pytest.approx(found.noise[1] / found.signal[1])


def test_units_do_not_matter():
    x, y = samples(60)
    units, outputs = np.array([1e-3, 1.0, 1e4]), np.array([10.0, 1e-5])
    found, other = relevance(x, y), relevance(x * units, y * outputs)
    np.testing.assert_allclose(other.scales, found.scales * units, rtol=1e-3)
    np.testing.assert_allclose(other.signal, found.signal * outputs**2, rtol=1e-2)
    np.testing.assert_allclose(other.noise, found.noise * outputs**2, rtol=1e-2)


@pytest.mark.parametrize("constant", [0.0, 3.0])
def test_inputs_and_targets_that_do_not_vary_do_no_harm(constant):
    x, y = samples(40)
    x[:, 1], y[:, 0] = constant, constant
    found = relevance(x, y)
    assert np.isfinite(found.scales).all()
    assert (found.scales > 0.0).all()
    learner = RecursiveNetwork(3, 2, relevance_samples=40)
    assert np.isfinite(learner.learn_many(x, y).error).all()
    assert np.isfinite(learner.predict_many(x)).all()


@pytest.mark.parametrize("capacity", [1000, 20])
def test_the_network_takes_the_scales_and_learns_the_first_samples_anew(capacity):
    x, y = samples(60)
    learner = RecursiveNetwork(3, 2, capacity=capacity, relevance_samples=50)
    learner.learn_many(x[:49], y[:49])
    np.testing.assert_allclose(learner.scales, np.sqrt(3.0))
    learner.learn(x[49], y[49])
    found = relevance(x[:50], y[:50])
    # With the neurons that there can be.
    factor = fitting_factor(x[: min(capacity, 50)] / found.scales, found.noise_ratio, 1e-6)
    np.testing.assert_allclose(learner.scales, found.scales * factor)
    assert learner.trials == 50
    # With the first scales it is 0.22.
    assert np.mean((learner.predict_many(x[:50]) - y[:50]) ** 2) < 0.05
    learner.learn_many(x[50:], y[50:])
    assert learner.trials == 60


def missing(points, factor):
    """Mean over the points of what Gaussians at all others do not represent there."""
    z = ((points[:, np.newaxis] - points) ** 2).sum(axis=2) / factor**2
    C = np.exp(-0.5 * z) + 1e-6 * np.eye(len(points))
    left: list[float] = []
    for j in range(len(points)):
        others = np.arange(len(points)) != j
        k = C[j, others]
        left.append(C[j, j] - k @ np.linalg.solve(C[np.ix_(others, others)], k))
    return np.mean(left)


@pytest.mark.parametrize("noise_ratio", [0.02, 0.05])
def test_scales_are_as_short_as_neurons_can_represent(noise_ratio):
    points = np.random.default_rng(1).uniform(-4.0, 4.0, size=(80, 2))
    factor = fitting_factor(points, noise_ratio, 1e-6)
    assert 0.76 < factor < 1.19
    assert missing(points, factor) == pytest.approx(noise_ratio, rel=0.03)
    # Less noise than a thousandth of the prior is like a thousandth.
    dense = 0.625 * points
    assert 0.8 < fitting_factor(dense, 1e-5, 1e-6) == fitting_factor(dense, 1e-3, 1e-6) < 1.0


@pytest.mark.parametrize(("spread", "factor"), [(0.1, 0.75), (10.0, 1.2)])
def test_scales_change_by_little(spread, factor):
    points = np.random.default_rng(1).uniform(-spread, spread, size=(80, 2))
    assert fitting_factor(points, 0.03, 1e-6) == pytest.approx(factor, rel=1e-12)
