"""The rule against its formulas (eq A.5 to A.14), and against differences of the energy."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.networks.layered.formulas import centred, energy, layers, make, output, steps

from handeye.networks import InputSpace
from handeye.networks.layered import LayeredNetwork, Linear, Sigmoid, Tanh

# Each pair of kinds takes seconds to compile.
KINDS = [(Tanh(0.5), Linear(2.0)), (Sigmoid(2.0), Tanh(1.5)), (Linear(0.5), Linear(2.0))]
BOX = InputSpace.box([-2.0, 0.0], [1.0, 4.0])
X, TARGET = np.array([-0.7, 3.1]), np.array([0.4, -1.3, 0.2])


@pytest.mark.parametrize(("hidden_kind", "output_kind"), KINDS)
def test_the_output_and_the_change_equal_their_formulas(hidden_kind, output_kind):
    network = make(
        inputs=BOX, output_scale=[1.0, 2.0, 0.5], activation=hidden_kind, output=output_kind,
        rate=0.07,
    )  # fmt: skip
    before, expected = network.weights, output(network, X)
    np.testing.assert_allclose(network.predict(X), expected, rtol=1e-12)
    changes = steps(network, X, (TARGET - expected) / network.output_scale)
    error, allocated = network.learn(X, TARGET)
    np.testing.assert_allclose(error, TARGET - expected, rtol=1e-12)
    assert not allocated
    for new, old, change in zip(network.weights, before, changes, strict=True):
        np.testing.assert_allclose(new - old, change, rtol=1e-9, atol=1e-14)


@given(
    st.lists(st.integers(1, 6), max_size=4), st.integers(1, 4), st.integers(1, 3), st.integers(0, 9)
)
def test_any_depth_and_width(hidden, n_inputs, n_outputs, seed):
    rng = np.random.default_rng(seed)
    network = LayeredNetwork(n_inputs, n_outputs, hidden, rng=rng, largest_weight=1.0, rate=0.1)
    x, target = rng.uniform(-1, 1, n_inputs), rng.normal(size=n_outputs)
    assert network.hidden == tuple(hidden)
    assert network.n_weights == sum(block.size for block in network.weights)
    before, changes = network.weights, steps(network, x, target - output(network, x))
    network.learn(x, target)
    for new, old, change in zip(network.weights, before, changes, strict=True):
        np.testing.assert_allclose(new - old, change, rtol=1e-9, atol=1e-14)


@pytest.mark.parametrize("hidden", [(), (3,), (4, 3), (3, 2, 4)])
@pytest.mark.parametrize(("kind", "output_kind"), KINDS[:2])
def test_every_weight_descends_the_energy_by_differences(hidden, kind, output_kind):
    network = make(
        hidden, inputs=BOX, output_scale=1.7, activation=kind, output=output_kind, rate=0.3
    )
    learned = network.copy()
    learned.learn(X, TARGET)
    tiny = 1e-6
    for layer, block in enumerate(network.weights):
        slopes = np.empty_like(block)
        for place in np.ndindex(*block.shape):
            sides = []
            for side in (tiny, -tiny):
                moved = network.weights
                moved[layer][place] += side
                other = network.copy()
                other.weights = moved
                sides.append(energy(other, X, TARGET))
            slopes[place] = (sides[0] - sides[1]) / (2.0 * tiny)
        change = learned.weights[layer] - block
        np.testing.assert_allclose(change, -0.3 * slopes, rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize("hidden", [(), (4, 3)])
@pytest.mark.parametrize(("kind", "output_kind"), KINDS[:2])
def test_slopes_are_derivatives_by_differences(hidden, kind, output_kind):
    network = make(
        hidden, inputs=BOX, output_scale=[1.0, 2.0, 0.5], activation=kind, output=output_kind
    )
    kept = network.weights
    tiny = 1e-6
    sides = [(network.predict(X + d) - network.predict(X - d)) / (2.0 * tiny)
             for d in tiny * np.eye(2)]  # fmt: skip
    np.testing.assert_allclose(network.slopes(X), np.stack(sides, axis=-1), rtol=1e-6, atol=1e-9)
    for new, old in zip(network.weights, kept, strict=True):
        np.testing.assert_array_equal(new, old)


def test_linear_layers_are_worth_one_matrix():
    network = make((5, 4), activation=Linear(0.5), output=Linear(2.0))
    network.weights = [np.column_stack([w[:, :-1], np.zeros(len(w))]) for w in network.weights]
    first, second, third = (w[:, :-1] for w in network.weights)
    product = 2.0 * third @ (0.5 * second) @ (0.5 * first)
    x = np.random.default_rng(1).uniform(-1, 1, (7, 2))
    np.testing.assert_allclose(network.predict_many(x), x @ product.T, rtol=1e-12, atol=1e-14)
    np.testing.assert_allclose(network.slopes(x[0]), product, rtol=1e-12)


def test_a_wanted_change_is_learned_as_an_error_is():
    by_target, by_change = (make(inputs=BOX, output_scale=[1.0, 2.0, 0.5]) for _ in range(2))
    change = TARGET - by_change.predict(X)
    by_target.learn(X, TARGET)
    by_change.learn_change(X, change)
    for one, other in zip(by_target.weights, by_change.weights, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-12)
    assert by_change.trials == by_target.trials == 1


def test_errors_do_not_pass_a_saturated_neuron():
    network = make((3,), activation=Tanh(gain=1.0))
    first, second = network.weights
    first[1] = [0.0, 0.0, 30.0]
    network.weights = [first, second]
    network.learn_many(*(np.random.default_rng(0).uniform(-1, 1, (50, n)) for n in (2, 3)))
    np.testing.assert_array_equal(network.weights[0][1], first[1])
    assert np.abs(network.weights[0][[0, 2]] - first[[0, 2]]).min() > 1e-6


def test_the_gain_is_the_slope_at_rest():
    """Of a sigmoid from 0 to 1 it is half that; it rests at one half."""
    for (kind, output_kind), at_rest in zip(KINDS, (0.5 * 2.0, 1.0 * 1.5, 0.5 * 2.0), strict=True):
        network = LayeredNetwork(1, 1, (1,), activation=kind, output=output_kind)
        resting = 0.5 if isinstance(kind, Sigmoid) else 0.0
        network.weights = [[[1.0, 0.0]], [[1.0, -resting]]]
        assert network.slopes([0.0])[0, 0] == pytest.approx(at_rest, rel=1e-12)


def test_a_layer_learns_what_cannot_be_separated_by_one():
    corners = np.array([[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]])
    exclusive = np.array([[-1.0], [1.0], [1.0], [-1.0]])
    order = np.random.default_rng(0).integers(0, 4, 4000)
    flat = LayeredNetwork(2, 1, ())
    deep = LayeredNetwork(2, 1, (4,), rate=0.1, largest_weight=0.5)
    for network in (flat, deep):
        network.learn_many(corners[order], exclusive[order])
    assert np.abs(deep.predict_many(corners) - exclusive).max() < 0.1
    assert np.abs(flat.predict_many(corners) - exclusive).max() > 0.9


def test_inputs_are_centred_on_their_box():
    network = make((4,), inputs=BOX)
    plain = make((4,))
    x = np.random.default_rng(2).uniform([-2.0, 0.0], [1.0, 4.0], (9, 2))
    np.testing.assert_allclose(
        network.predict_many(x), plain.predict_many(centred(network, x)), rtol=1e-12
    )
    assert layers(network, [1.0, 4.0])[1][0].tolist() == [1.0, 1.0]
