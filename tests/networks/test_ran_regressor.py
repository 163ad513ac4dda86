"""The scikit-learn estimator: the conventions, what it adds to the network, and its settings."""

import pickle  # noqa: TID251 (scikit-learn sends estimators to its workers that way)
from typing import Any

import numpy as np
import pytest
from sklearn.base import clone
from sklearn.exceptions import NotFittedError
from sklearn.model_selection import GridSearchCV
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.utils.estimator_checks import parametrize_with_checks

from handeye.errors import InvalidInput
from handeye.networks import CMAC, Constant, Cosine, InputSpace, ResourceAllocatingNetwork
from handeye.networks.regressor import RANRegressor


@parametrize_with_checks(
    [
        RANRegressor(),
        RANRegressor(capacity=30, response=Cosine(), adaptation=CMAC(), random_state=0, epochs=3),
    ]
)
def test_scikit_learn_conventions(estimator, check):
    check(estimator)


@pytest.fixture
def data():
    rng = np.random.default_rng(0)
    x = rng.uniform(-2, 2, size=(200, 2))
    y = np.column_stack([np.sin(x[:, 0]), 1e3 + 50 * x[:, 1] ** 2])
    return x, y


def test_it_learns_targets_of_any_unit(data):
    x, y = data
    fitted = RANRegressor().fit(x[:150], y[:150])
    assert fitted.score(x[150:], y[150:]) > 0.95
    other = RANRegressor().fit(x[:150], y[:150] * [1024.0, 0.5])
    np.testing.assert_array_equal(other.predict(x), fitted.predict(x) * [1024.0, 0.5])


def test_it_is_the_network_over_standardised_targets(data):
    x, y = data
    fitted = RANRegressor(epochs=2, capacity=40, scales=[1.0, 3.0], error_threshold=0.2).fit(x, y)
    network = ResourceAllocatingNetwork(
        2,
        2,
        inputs=InputSpace(x.min(axis=0), x.max(axis=0), np.array([1.0, 3.0])),
        capacity=40,
        error_threshold=0.2,
        learning_threshold=0.01,
    )
    for _ in range(2):
        network.learn_many(x, (y - y.mean(axis=0)) / y.std(axis=0))
    expected = network.predict_many(x) * y.std(axis=0) + y.mean(axis=0)
    np.testing.assert_array_equal(fitted.predict(x), expected)


def test_automatic_scales_are_standard_deviations(data):
    x, y = data
    space = RANRegressor().fit(x * [1.0, 500.0], y).network_.inputs
    np.testing.assert_allclose(space.scales, x.std(axis=0) * [1.0, 500.0])
    still = np.column_stack([x, np.full(len(x), 7.0)])
    assert RANRegressor().fit(still, y).network_.inputs.scales[2] == 1.0


def test_far_from_experience_it_predicts_the_mean(data):
    x, y = data
    far = RANRegressor().fit(x, y).predict([[1e4, -1e4]])
    np.testing.assert_allclose(far[0], y.mean(axis=0))


def test_partial_fit_continues_where_fit_stopped(data):
    x, y = data
    whole = RANRegressor(epochs=1).fit(x, y)
    parts = RANRegressor().partial_fit(x, y)
    np.testing.assert_array_equal(whole.predict(x), parts.predict(x))
    parts.partial_fit(x[:50], y[:50])
    assert parts.network_.trials == 250
    np.testing.assert_array_equal(parts.target_mean_, y.mean(axis=0))
    with pytest.raises(InvalidInput, match=r"shape \(N, 2\)"):
        parts.partial_fit(x, y[:, 0])
    assert parts.network_.trials == 250
    assert parts.fit(x, y[:, 0]).predict(x).shape == (200,)


def test_predictions_have_the_shape_of_the_targets(data):
    x, y = data
    for target in (y, y[:, 0], y[:, :1]):
        assert RANRegressor(epochs=1).fit(x, target).predict(x[:7]).shape == (7, *target.shape[1:])
    assert RANRegressor().partial_fit(x[:1], y[:1]).predict(x[:1]).shape == (1, 2)


def test_order_is_kept_unless_a_random_state_is_given(data):
    x, y = data
    kept = RANRegressor(capacity=20).fit(x, y).predict(x)
    np.testing.assert_array_equal(RANRegressor(capacity=20).fit(x, y).predict(x), kept)
    one = RANRegressor(capacity=20, random_state=1).fit(x, y).predict(x)
    np.testing.assert_array_equal(
        RANRegressor(capacity=20, random_state=1).fit(x, y).predict(x), one
    )
    assert not np.array_equal(one, kept)


def test_it_works_with_pipelines_searches_clones_and_pickles(data):
    x, y = data
    pipeline = make_pipeline(StandardScaler(), RANRegressor(response=Cosine()))
    search = GridSearchCV(
        pipeline, {"ranregressor__half_max_fraction": [0.5, 1.2], "ranregressor__capacity": [60]}
    ).fit(x, y)
    best = search.best_estimator_
    again = pickle.loads(pickle.dumps(best))
    np.testing.assert_array_equal(again.predict(x), best.predict(x))
    copy: Any = clone(best)
    assert repr(copy[-1]) == repr(best[-1])
    with pytest.raises(NotFittedError):
        copy.predict(x)


@pytest.mark.parametrize(
    "settings",
    [
        {"scales": "standard"},
        {"scales": [1.0]},
        {"scales": [1.0, 0.0]},
        {"epochs": 0},
        {"epochs": 1.5},
        {"capacity": 0},
        {"response": Constant()},
        {"error_threshold": -1.0},
    ],
)
def test_settings_out_of_range_are_refused_when_fitting(data, settings):
    regressor = RANRegressor(**settings)
    with pytest.raises(InvalidInput):
        regressor.fit(*data)
