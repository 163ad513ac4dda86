"""What a network refuses, and that a refused call changes nothing."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.networks.samples import make, state, stream

from handeye.errors import InvalidInput
from handeye.networks import (
    CMAC,
    Constant,
    Gaussian,
    InputSpace,
    Power,
    ResourceAllocatingNetwork,
    VirtualNeuron,
)

FAST: Any = "fast"
BAD_INPUTS = {
    "not a number": [np.nan, 1.0],
    "infinite": [0.0, -np.inf],
    "too short": [1.0],
    "too long": [1.0, 2.0, 3.0],
    "a scalar": 1.0,
    "too deep": [[1.0, 2.0]],
    "strings": ["1", "2"],
    "complex": [1.0, 2.0 + 1j],
    "objects": [1.0, None],
    "ragged": [[1.0], [1.0, 2.0]],
    "nothing": None,
    "a mapping": {"x": 1.0},
    "dates": np.array(["2026-01-01", "2026-01-02"], "datetime64[D]"),
    "too large to square": [1e200, 0.0],
}


@pytest.mark.parametrize("bad", BAD_INPUTS.values(), ids=BAD_INPUTS.keys())
def test_what_cannot_be_used_is_refused_and_changes_nothing(bad):
    network = make(capacity=40)
    network.learn_many(*stream(0, 20))
    before = state(network)
    good = [0.1, 0.2]
    for call in (
        lambda: network.predict(bad),
        lambda: network.nearest(bad),
        lambda: network.learn(bad, good),
        lambda: network.learn(good, bad),
        lambda: network.predict_many([good, bad]),
        lambda: network.nearest_many([good, bad]),
        lambda: network.learn_many([good, bad], [good, good]),
        lambda: network.learn_many([good, good], [good, bad]),
        lambda: network.place([good, bad]),
        lambda: network.place([good, good], [good, bad]),
    ):
        with pytest.raises(InvalidInput):
            call()
    assert state(network) == before


@given(
    st.integers(0, 9), st.sampled_from([0, 1]), st.sampled_from([np.nan, np.inf, -np.inf, 1e101])
)
def test_one_bad_value_anywhere_refuses_the_whole_batch(row, column, value):
    network = make()
    for which in range(2):
        batch = [array.copy() for array in stream(8, 10)]
        batch[which][row, column] = value * (2.0 if which == 0 else 1.0)
        with pytest.raises(InvalidInput):
            network.learn_many(*batch)
        assert state(network) == state(make())


def test_batches_must_match():
    x, targets = stream(0, 10)
    with pytest.raises(InvalidInput, match="10 samples but target has 9"):
        make().learn_many(x, targets[:9])
    network = make(capacity=9)
    with pytest.raises(InvalidInput, match="capacity of 9"):
        network.place(x)
    with pytest.raises(InvalidInput, match="targets must have shape"):
        network.place(x[:3], targets[:2])
    with pytest.raises(InvalidInput, match="weight"):
        network.place(x[:3], weight=np.nan)
    assert state(network) == state(make())


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"capacity": True}, "capacity"),
        ({"capacity": 0}, "capacity"),
        ({"capacity": 5.0}, "capacity"),
        ({"half_max_fraction": 0.0}, "half_max_fraction"),
        ({"half_max_fraction": np.nan}, "half_max_fraction"),
        ({"error_threshold": -1e-9}, "error_threshold"),
        ({"learning_threshold": -1.0}, "learning_threshold"),
        ({"learning_threshold": "1"}, "learning_threshold"),
        ({"first_width": 0.0}, "first_width"),
        ({"smallest_width": 0.0}, "smallest_width"),
        ({"smallest_width": [1e-3, 1e-3]}, "smallest_width"),
        ({"inputs": InputSpace.scaled([1.0, 1.0, 1.0])}, "3 inputs, not 2"),
        ({"response": Gaussian}, r"an instance, Gaussian\(\), not the class"),
        ({"response": Constant()}, "response must be one of Cosine, Gaussian, Parabolic"),
        ({"schedule": 0.5}, "schedule must be one of"),
        ({"adaptation": "CMAC"}, "adaptation must be one of"),
        ({"adaptation": None}, "adaptation must be one of"),
        ({"adaptation": CMAC(rate=np.nan)}, "adaptation rate must be finite"),
        ({"adaptation": CMAC(FAST)}, "adaptation rate must be real"),
        ({"schedule": Power(exponent=np.inf)}, "schedule exponent must be finite"),
    ],
)
def test_settings_out_of_range_are_refused(settings, message):
    with pytest.raises(InvalidInput, match=message):
        ResourceAllocatingNetwork(2, 2, **settings)


@pytest.mark.parametrize("shape", [(0, 1), (1, 0), (True, 1), (1, 2.0), ("2", 1), (-1, 1)])
def test_numbers_of_inputs_and_outputs_are_whole_and_positive(shape):
    with pytest.raises(InvalidInput):
        ResourceAllocatingNetwork(*shape)


def test_numbers_of_any_type_make_the_same_kinds():
    numbers: Any = np.array([0.5, 0.25], np.float32)
    network = ResourceAllocatingNetwork(
        1, 1, schedule=Constant(0), adaptation=VirtualNeuron(*numbers)
    )
    assert repr(network.schedule) == "Constant(threshold=0.0)"
    assert repr(network.adaptation) == "VirtualNeuron(rate=0.5, on_threshold=0.25)"


def test_whole_numbers_and_lists_are_numbers_too():
    network = ResourceAllocatingNetwork(*np.array([2, 1]))
    network.learn([1, 0], [3])
    assert network.predict(np.array([1, 0], np.int8)) == 3.0
    assert network.predict(np.array([1, 0], np.float32)[::1]) == 3.0
    network.learn_many(np.asfortranarray(np.eye(2)), [[1], [2]])
