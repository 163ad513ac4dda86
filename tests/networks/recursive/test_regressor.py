"""The recursive network behind scikit-learn's interface."""

import numpy as np
import pytest
from sklearn.utils.estimator_checks import parametrize_with_checks
from tests.networks.samples import fewer

from handeye.errors import InvalidInput
from handeye.networks import InputSpace
from handeye.networks.recursive import RecursiveNetwork
from handeye.networks.recursive.regressor import RecursiveRegressor


@parametrize_with_checks(
    [
        RecursiveRegressor(capacity=fewer(60, 20), relevance_samples=fewer(60, 30)),
        RecursiveRegressor(
            capacity=fewer(30, 15), relevance_samples=None, random_state=0, epochs=2
        ),
    ]
)
def test_scikit_learn_conventions(estimator, check):
    check(estimator)


@pytest.fixture
def data():
    rng = np.random.default_rng(0)
    x = rng.uniform(-2, 2, size=(300, 2)) * [1.0, 1e3]
    y = np.column_stack([np.sin(x[:, 0]), 1e3 + 5e-5 * x[:, 1] ** 2])
    return x, y + rng.normal(size=y.shape) * [0.05, 2.0]


def test_it_is_the_network_over_standardised_targets(data):
    x, y = data
    fitted = RecursiveRegressor(capacity=40, relevance_samples=100, forgetting=0.999).fit(x, y)
    network = RecursiveNetwork(
        2, 2, inputs=InputSpace.scaled(np.sqrt(2.0) * x.std(axis=0)), capacity=40,
        relevance_samples=100, forgetting=0.999,
    )  # fmt: skip
    network.learn_many(x, (y - y.mean(axis=0)) / y.std(axis=0))
    expected = network.predict_many(x) * y.std(axis=0) + y.mean(axis=0)
    np.testing.assert_array_equal(fitted.predict(x), expected)
    np.testing.assert_array_equal(
        fitted.predict_deviation(x), np.sqrt(network.variance_many(x)) * y.std(axis=0)
    )


def test_few_samples_are_enough_to_find_scales_and_noise(data):
    x, y = data
    fitted = RecursiveRegressor().fit(x[:200], y[:200])
    assert fitted.score(x[200:], y[200:]) > 0.95
    scales = fitted.network_.scales
    assert not np.allclose(scales, np.sqrt(2.0) * x[:200].std(axis=0))
    inside = np.abs(fitted.predict(x[200:]) - y[200:]) < 2.0 * fitted.predict_deviation(x[200:])
    assert inside.mean() > 0.85
    single = RecursiveRegressor().fit(x[:3], y[:3, 0])  # too few for that
    assert single.predict_deviation(x[:5]).shape == (5,)


def test_partial_fit_continues_where_fit_stopped(data):
    x, y = data
    whole = RecursiveRegressor(capacity=40, relevance_samples=100).fit(x, y)
    parts = RecursiveRegressor(capacity=40, relevance_samples=100).partial_fit(x, y)
    np.testing.assert_array_equal(whole.predict(x), parts.predict(x))
    parts.partial_fit(x[:50], y[:50])
    assert parts.network_.trials == 350


@pytest.mark.parametrize(
    "settings",
    [{"scales": "standard"}, {"scales": [1.0]}, {"relevance_samples": 0}, {"forgetting": 2.0}],
)
def test_settings_out_of_range_are_refused_when_fitting(data, settings):
    with pytest.raises(InvalidInput):
        RecursiveRegressor(**settings).fit(*data)
