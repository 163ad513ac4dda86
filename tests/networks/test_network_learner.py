"""What every network promises, whatever it is made of: one suite over all kinds."""

import pickle  # noqa: TID251 (worker processes exchange objects in it)

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.networks.samples import D_IN, D_OUT, make, state, stream

from handeye.errors import HandeyeError
from handeye.networks import (
    CMAC,
    Cosine,
    GradientDescent,
    LearningDiverged,
    Logarithmic,
    ResourceAllocatingNetwork,
    VirtualNeuron,
)


@pytest.fixture
def learned(kinds):
    network = make(kinds)
    network.learn_many(*stream(0, 90))
    return network


def test_a_fresh_network_predicts_zero_and_is_nowhere(kinds):
    network = make(kinds)
    assert network.n_neurons == network.trials == 0
    np.testing.assert_array_equal(network.predict([0.3, 1.0]), [0.0, 0.0])
    assert network.predict_many(np.zeros((0, D_IN))).shape == (0, D_OUT)
    assert network.nearest([0.3, 1.0]) == np.inf
    assert network.centers.shape == (0, D_IN)
    assert network.weights.shape == (0, D_OUT)


def test_learn_returns_the_error_before_learning(learned):
    for x, target in zip(*stream(1, 20), strict=True):
        expected = target - learned.predict(x)
        before = learned.n_neurons
        error, allocated = learned.learn(x, target)
        np.testing.assert_allclose(error, expected, rtol=1e-12, atol=1e-13)
        assert learned.n_neurons == before + allocated


def test_predict_is_pure(learned):
    before = state(learned)
    x = stream(1, 30)[0]
    many = learned.predict_many(x)
    learned.nearest(x[0])
    np.testing.assert_array_equal(learned.predict_many(x), many)
    np.testing.assert_array_equal([learned.predict(x_i) for x_i in x], many)
    assert state(learned) == before


def test_predictions_do_not_share_memory(learned):
    first = learned.predict([0.1, 0.2])
    kept = first.copy()
    learned.predict([0.9, 2.0])
    np.testing.assert_array_equal(first, kept)
    for array in (learned.centers, learned.widths, learned.weights):
        array[:] = np.nan
    np.testing.assert_array_equal(learned.predict([0.1, 0.2]), kept)


@pytest.mark.parametrize("capacity", [None, 20])
def test_learning_many_is_learning_one_by_one(kinds, capacity):
    x, targets = stream(2, 150)  # unlimited, it grows twice on the way
    many, one = make(kinds, capacity=capacity), make(kinds, capacity=capacity)
    error, allocated = many.learn_many(x, targets)
    results = [one.learn(x_i, t) for x_i, t in zip(x, targets, strict=True)]
    np.testing.assert_array_equal([r.error for r in results], error)
    np.testing.assert_array_equal([r.allocated for r in results], allocated)
    assert state(one) == state(many)
    assert many.n_neurons == allocated.sum()
    assert many.trials == 150


@settings(max_examples=25)
@given(st.lists(st.integers(0, 140), max_size=6), st.sampled_from([None, 30, 64, 65]))
def test_chunks_do_not_matter(cuts, capacity):
    x, targets = stream(3, 140)
    whole, pieces = make(capacity=capacity), make(capacity=capacity)
    whole.learn_many(x, targets)
    for part_x, part_t in zip(
        np.split(x, sorted(cuts)), np.split(targets, sorted(cuts)), strict=True
    ):
        pieces.learn_many(part_x, part_t)
    assert state(pieces) == state(whole)


@pytest.mark.parametrize("capacity", [1, 7, 64])
def test_capacity_is_never_exceeded(kinds, capacity):
    network = make(kinds, capacity=capacity)
    allocated = network.learn_many(*stream(4, 90)).allocated
    assert network.n_neurons == allocated.sum() <= capacity
    assert network.capacity == capacity
    assert network._units.widths.size == capacity


def test_memory_doubles_without_a_capacity():
    network = make()
    sizes = []
    for x, target in zip(*stream(5, 140), strict=True):
        network.learn(x, target)
        sizes.append(network._units.widths.size)
    assert network.n_neurons > 128
    assert sorted(set(sizes)) == [64, 128, 256]
    assert network.bytes_per_neuron == sum(a.nbytes for a in network._units) / sizes[-1]


def test_a_copy_is_independent(learned):
    copy = learned.copy()
    before = state(learned)
    assert state(copy) == before
    copy.learn_many(*stream(6, 30))
    assert state(learned) == before
    learned.learn_many(*stream(6, 30))
    assert state(learned) == state(copy)
    assert state(pickle.loads(pickle.dumps(learned))) == state(learned)


def test_repr_tells_shape_state_and_kinds(learned, kinds):
    text = repr(learned)
    for part in ("2 inputs", "2 outputs", f"{learned.n_neurons} neurons", "unlimited", "90 trials"):
        assert part in text
    for kind in kinds:
        assert repr(kind) in text
    assert "at most 7" in repr(make(capacity=7))


def test_nearest_is_the_distance_in_scaled_units(learned):
    x = stream(7, 20)[0]
    scales = learned.inputs.scales
    expected = np.linalg.norm((x[:, None] - learned.centers) / scales, axis=2).min(axis=1)
    np.testing.assert_allclose(learned.nearest_many(x), expected, rtol=1e-12, atol=1e-15)
    np.testing.assert_array_equal([learned.nearest(x_i) for x_i in x], learned.nearest_many(x))


def test_inputs_that_repeat_or_nearly_do_keep_widths_above_the_floor(kinds):
    network = make(kinds, error_threshold=0.0, smallest_width=1e-4)
    x = np.array([0.2, 0.7])
    for step in (0.0, 1e-15, 1e-13, 1e-300, 0.0, 1e-9):
        for target in ([1.0, -1.0], [2.0, 5.0]):
            network.learn(x + step, target)
            assert np.isfinite(network.predict(x)).all()
    assert network.widths.min() > 0.0
    network.place(np.tile(x, (3, 1)), np.ones((3, 2)))
    np.testing.assert_allclose(network.predict(x), 1.0, rtol=1e-9)
    beside = np.array([1e-4 * network.inputs.diameter, 0.0])
    assert np.isfinite(network.predict(x + beside)).all()


def test_the_floor_is_the_smallest_half_distance():
    network = ResourceAllocatingNetwork(1, 1, response=Cosine(), smallest_width=0.01)
    network.place([[0.3], [0.3]])
    assert network.widths[1] == pytest.approx(2 * 0.01, rel=1e-14)


@pytest.mark.parametrize("diverging", [VirtualNeuron(1e8), CMAC(1e8), GradientDescent(1e8)])
def test_divergence_is_raised_and_earlier_samples_stay_learned(diverging):
    x, targets = np.full((40, 2), 0.3), np.ones((40, 2))
    targets[::2] = -1.0
    network, one = make(adaptation=diverging, capacity=1), make(adaptation=diverging, capacity=1)
    with pytest.raises(LearningDiverged, match=r"sample \d+ .*smaller rate") as caught:
        network.learn_many(x, targets)
    assert isinstance(caught.value, HandeyeError)
    assert 2 < network.trials < 40
    for i in range(network.trials):
        one.learn(x[i], targets[i])
    assert state(one) == state(network)
    with pytest.raises(LearningDiverged):
        one.learn(x[one.trials], targets[one.trials])
    assert state(one) == state(network)


def test_placed_neurons_have_their_weight_or_make_the_output_exact():
    x, targets = stream(9, 100)
    network = make()
    network.place(x[:60])
    assert not network.weights.any()
    network.place(x[60:70], weight=0.001)
    assert (network.weights[60:] == 0.001).all()
    assert network.trials == 0
    for i in range(70, 100):
        network.place(x[i : i + 1], targets[i : i + 1])
        np.testing.assert_allclose(network.predict(x[i]), targets[i], rtol=1e-12, atol=1e-13)
    at_once, learned = make(), make(schedule=Logarithmic(k=0.0), error_threshold=0.0)
    at_once.place(x, targets)
    learned.learn_many(x, targets)
    np.testing.assert_array_equal(at_once.centers, learned.centers)
    np.testing.assert_allclose(at_once.widths, learned.widths, rtol=1e-12)
    np.testing.assert_allclose(at_once.weights, learned.weights, rtol=1e-9, atol=1e-9)
