"""Settings, refusals and files of the layered network, beyond the laws of every learner."""

from typing import Any

import numpy as np
import pytest
from tests.networks.layered.formulas import make

from handeye.errors import FileFormatError, InvalidInput
from handeye.io.tensors import read_tensors, write_tensors
from handeye.networks import InputSpace, LearningDiverged
from handeye.networks.layered import LayeredNetwork, Linear, Tanh

FAST: Any = "fast"


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"hidden": (3, 0)}, "each of hidden"),
        ({"hidden": (2.5,)}, "each of hidden"),
        ({"rate": 0.0}, "rate must be greater"),
        ({"rate": np.nan}, "rate must be finite"),
        ({"rate": FAST}, "rate must be real"),
        ({"largest_weight": -0.1}, "largest_weight"),
        ({"output_scale": 0.0}, "output_scale must be positive"),
        ({"output_scale": [1.0, 2.0]}, "output_scale must have shape"),
        ({"output_scale": np.inf}, "output_scale must be finite"),
        ({"inputs": InputSpace.scaled([1.0])}, "1 inputs, not 2"),
        ({"activation": Tanh}, r"an instance, Tanh\(\), not the class"),
        ({"activation": "tanh"}, "activation must be one of Linear, Sigmoid, Tanh"),
        ({"output": Linear(0.0)}, "output gain must be greater"),
        ({"output": Tanh(FAST)}, "output gain must be real"),
    ],
)
def test_settings_out_of_range_are_refused(settings, message):
    with pytest.raises(InvalidInput, match=message):
        make(**settings)


@pytest.mark.parametrize("shape", [(0, 1), (1, 0), (True, 1), ("2", 1)])
def test_numbers_of_inputs_and_outputs_are_whole_and_positive(shape):
    with pytest.raises(InvalidInput):
        LayeredNetwork(*shape)


def test_first_weights_are_drawn_evenly_up_to_the_largest():
    weights = np.concatenate([w.ravel() for w in make((60, 60), largest_weight=0.2).weights])
    assert np.abs(weights).max() <= 0.2
    assert np.abs(weights).max() > 0.19
    assert abs(weights.mean()) < 0.01
    np.testing.assert_allclose(weights.std(), 0.2 / np.sqrt(3.0), rtol=0.03)
    assert not any(w.any() for w in make(largest_weight=0.0).weights)


def test_without_a_generator_first_weights_are_the_same_each_time():
    one, other = LayeredNetwork(2, 1, (3,)), LayeredNetwork(2, 1, (3,))
    np.testing.assert_array_equal(one.weights[0], other.weights[0])


def test_given_weights_are_taken_and_handed_out_as_copies():
    network, given = make((2,)), [np.ones((2, 3)), 2.0 * np.ones((3, 3))]
    network.weights = given
    given[0][:] = 9.0
    network.weights[1][:] = 9.0
    np.testing.assert_array_equal(network.weights[0], np.ones((2, 3)))
    np.testing.assert_array_equal(network.weights[1], 2.0 * np.ones((3, 3)))
    network.output_scale[:] = 9.0
    np.testing.assert_array_equal(network.output_scale, 1.0)


@pytest.mark.parametrize(
    "bad",
    [
        [np.ones((2, 3))],
        [np.ones((2, 3)), np.ones((3, 2))],
        [np.ones((2, 3)), np.full((3, 3), np.nan)],
    ],
)
def test_weights_that_do_not_fit_are_refused_and_change_nothing(bad):
    network = make((2,))
    kept = network.weights
    with pytest.raises(InvalidInput, match=r"layers need|weights of layer 1"):
        network.weights = bad
    for new, old in zip(network.weights, kept, strict=True):
        np.testing.assert_array_equal(new, old)


@pytest.mark.parametrize("bad", [[np.nan, 0.0, 0.0], [1.0], [1e200, 0.0, 0.0], None])
def test_a_wanted_change_that_cannot_be_used_is_refused(bad):
    network = make()
    kept = network.weights
    with pytest.raises(InvalidInput, match="change"):
        network.learn_change([0.1, 0.2], bad)
    with pytest.raises(InvalidInput, match="x must"):
        network.learn_change([0.1], [0.0, 0.0, 0.0])
    assert network.trials == 0
    for new, old in zip(network.weights, kept, strict=True):
        np.testing.assert_array_equal(new, old)


def test_divergence_is_raised_and_earlier_samples_stay_learned():
    network, one = (make((5,), rate=50.0) for _ in range(2))
    rng = np.random.default_rng(0)
    x, targets = rng.uniform(-1, 1, (400, 2)), rng.normal(size=(400, 3))
    with pytest.raises(LearningDiverged, match=r"sample \d+ .* smaller rate"):
        network.learn_many(x, targets)
    assert 2 < network.trials < 400
    for i in range(network.trials):
        one.learn(x[i], targets[i])
    np.testing.assert_array_equal(one.predict_many(x), network.predict_many(x))
    with pytest.raises(LearningDiverged):
        one.learn(x[one.trials], targets[one.trials])
    assert one.trials == network.trials


def test_a_constant_is_learned_by_the_threshold_alone():
    network = make((3,), largest_weight=0.0, rate=0.5)
    network.learn_many(np.zeros((60, 2)), np.tile([1.0, -2.0, 0.5], (60, 1)))
    np.testing.assert_allclose(network.predict([0.0, 0.0]), [1.0, -2.0, 0.5], rtol=1e-12)
    assert not network.weights[0].any()


def test_every_setting_is_stored(tmp_path):
    network = make(
        (4, 2), inputs=InputSpace.box([-2.0, 0.0], [1.0, 4.0]), output_scale=[1.0, 2.0, 0.5],
        activation=Tanh(0.7), output=Linear(1.3), rate=0.013,
    )  # fmt: skip
    network.save(tmp_path / "n")
    again = LayeredNetwork.load(tmp_path / "n")
    assert (again.hidden, again.rate, again.kinds) == (network.hidden, 0.013, network.kinds)
    np.testing.assert_array_equal(again.output_scale, network.output_scale)
    np.testing.assert_array_equal(again.inputs.low, network.inputs.low)


UNFIT: dict[str, tuple[dict[str, Any], str]] = {
    "unknown kind": ({"output": {"kind": "Spline"}}, "'Spline', which is not registered"),
    "other layers": ({"hidden": [3]}, "parts do not fit together"),
    "negative trials": ({"trials": -1}, "parts do not fit together"),
    "no rate": ({"rate": None}, "parts do not fit together"),
    "no scale": ({"output_scale": np.zeros(3)}, "parts do not fit together"),
    "too few weights": ({"weights": np.zeros(5)}, "parts do not fit together"),
}


@pytest.mark.parametrize(("change", "message"), UNFIT.values(), ids=UNFIT.keys())
def test_files_whose_parts_do_not_fit_are_refused(change, message, tmp_path):
    path = tmp_path / "n"
    make().save(path)
    arrays, header = read_tensors(path, LayeredNetwork.FORMAT, LayeredNetwork.VERSION, "")
    for name, value in change.items():
        (arrays if name in arrays else header)[name] = value
    write_tensors(path, LayeredNetwork.FORMAT, LayeredNetwork.VERSION, arrays, header)
    with pytest.raises(FileFormatError, match=message) as caught:
        LayeredNetwork.load(path)
    assert str(path) in str(caught.value)


def test_repr_tells_shape_state_and_kinds():
    network = make((4, 2), rate=0.01)
    network.learn([0.0, 0.0], [1.0, 2.0, 3.0])
    for part in ("2-4-2-3 neurons", "1 trials", "Tanh(gain=1.0)", "Linear(gain=1.0)", "0.01"):
        assert part in repr(network)
