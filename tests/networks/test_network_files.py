"""Stored networks: exact round trips, and every kind of damage told apart with the file's name."""

import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from safetensors.numpy import load_file, save_file

from handeye.errors import FileFormatError, InvalidInput
from handeye.io.tensors import _digest, write_tensors
from handeye.networks import GradientDescent, InputSpace, ResourceAllocatingNetwork

FORMAT, VERSION = ResourceAllocatingNetwork.FORMAT, ResourceAllocatingNetwork.VERSION
SPACE = InputSpace(*np.array([[-1, 0], [1, 3], [1.0, 2.0]]))


def make(n: Any = 12, **settings: Any):
    rng = np.random.default_rng(3)
    network = ResourceAllocatingNetwork(2, 3, inputs=SPACE, **settings)
    network.learn_many(rng.uniform([-1, 0], [1, 3], size=(n, 2)), rng.normal(size=(n, 3)))
    return network


def state(network):
    arrays, rest = network.parts()
    return {name: a.tobytes() for name, a in arrays.items()}, rest, network.settings


@pytest.fixture
def stored(tmp_path):
    path = tmp_path / "network.safetensors"
    make().save(path)
    return path


def assert_refused(path, match="."):
    with pytest.raises(FileFormatError, match=match) as caught:
        ResourceAllocatingNetwork.load(path)
    assert str(path) in str(caught.value)


def forge(path, change):
    """A file that is well formed, with `change` made to its arrays and its header."""
    arrays, rest = make().parts()
    change(arrays, rest)
    write_tensors(path, FORMAT, VERSION, arrays, rest)


@pytest.mark.parametrize("capacity", [None, 5, 200])
@pytest.mark.parametrize("n", [0, 12, 80])
def test_a_round_trip_is_exact_and_learning_goes_on_alike(kinds, capacity, n, tmp_path):
    network = make(n, capacity=capacity, half_max_fraction=0.9, first_width=0.3, **kinds._asdict())
    path = tmp_path / "deep" / "er" / "network.safetensors"
    network.save(path)
    again = ResourceAllocatingNetwork.load(str(path))
    assert state(again) == state(network)
    assert repr(again) == repr(network)
    assert again.capacity == capacity
    rng = np.random.default_rng(0)
    x, targets = rng.uniform([-1, 0], [1, 3], size=(70, 2)), rng.normal(size=(70, 3))
    np.testing.assert_array_equal(again.predict_many(x), network.predict_many(x))
    for one, other in zip(
        again.learn_many(x, targets), network.learn_many(x, targets), strict=True
    ):
        np.testing.assert_array_equal(one, other)
    assert state(again) == state(network)


def test_other_settings_are_stored_too(tmp_path):
    settings = {"error_threshold": 0.5, "learning_threshold": 0.25, "smallest_width": 1e-4}
    network = make(adaptation=GradientDescent(0.3), **settings)
    network.save(tmp_path / "n")
    again = ResourceAllocatingNetwork.load(tmp_path / "n")
    assert again.settings == network.settings
    assert again.adaptation == GradientDescent(0.3)


def test_every_truncated_file_is_refused(stored):
    whole = stored.read_bytes()
    for length in range(len(whole)):
        stored.write_bytes(whole[:length])
        assert_refused(stored)
    stored.write_bytes(whole + b"\0")
    assert_refused(stored)


def test_no_changed_byte_goes_unnoticed(stored):
    whole = stored.read_bytes()
    original = state(ResourceAllocatingNetwork.load(stored))
    rng = np.random.default_rng(0)
    for position in range(len(whole)):
        damaged = bytearray(whole)
        damaged[position] ^= 1 << int(rng.integers(8))
        stored.write_bytes(bytes(damaged))
        try:
            # White space may become other white space; nothing else may load.
            assert state(ResourceAllocatingNetwork.load(stored)) == original
        except FileFormatError as error:
            assert str(stored) in str(error)  # noqa: PT017 (either outcome is right)


@pytest.mark.parametrize("content", [b"", b"no", b"\xff" * 100, b'{"a": 1}' * 9, bytes(5000)])
def test_foreign_files_are_refused(stored, content):
    stored.write_bytes(content)
    assert_refused(stored)


@pytest.mark.parametrize("metadata", [None, {"format": "pt"}, {"format": "handeye.model"}])
def test_foreign_safetensors_are_refused(stored, metadata):
    save_file({"weight": np.ones((2, 2), np.float32)}, stored, metadata)
    assert_refused(stored, "not a stored ResourceAllocatingNetwork")


def test_a_newer_file_asks_for_an_update(stored):
    arrays, rest = make().parts()
    write_tensors(stored, FORMAT, VERSION + 1, arrays, rest)
    assert_refused(stored, "newer handeye.*update handeye")


@pytest.mark.parametrize("version", ["", "one", "1.5"])
def test_a_version_that_is_no_number_is_refused(stored, version):
    write(stored, version, json.dumps(make().parts()[1]))
    assert_refused(stored)


@pytest.mark.parametrize("header", ["", "[]", "null", "{}", '"x"', '{"trials": 1}', "[" * 500])
def test_a_header_without_a_network_is_refused(stored, header):
    write(stored, "1", header)
    assert_refused(stored)


def write(path, version, text):
    """The arrays of a network under this version and text of a header, with the right digest."""
    arrays, _ = make().parts()
    arrays = {name: np.ascontiguousarray(array) for name, array in arrays.items()}
    metadata = {"format": FORMAT, "version": version, "header": text}
    save_file(arrays, path, {**metadata, "sha256": _digest(arrays, text)})


def put(name, value, index=0):
    def change(arrays, _):
        arrays[name] = arrays[name].copy()
        arrays[name].flat[index] = value

    return change


def reshape(name, new):
    def change(arrays, _):
        arrays[name] = new(arrays[name])

    return change


def header(*keys, to):
    def change(_, rest):
        for key in keys[:-1]:
            rest = rest[key]
        rest[keys[-1]] = to

    return change


ARRAYS = ["centers", "widths", "weights", "low", "high", "scales"]
FORGERIES = {
    **{f"{name} has a NaN": put(name, np.nan) for name in ARRAYS},
    **{f"{name} is infinite": put(name, np.inf) for name in ARRAYS},
    **{f"{name} has one axis more": reshape(name, lambda a: a[np.newaxis]) for name in ARRAYS},
    **{f"{name} is shorter": reshape(name, lambda a: a[..., :-1]) for name in ARRAYS},
    **{f"{name} is complex": reshape(name, lambda a: a.astype(np.complex64)) for name in ARRAYS},
    **{f"{name} is missing": lambda arrays, _, name=name: arrays.pop(name) for name in ARRAYS},
    "negative width": put("widths", -1.0),
    "zero width": put("widths", 0.0, 3),
    "zero scale": put("scales", 0.0),
    "empty box": put("high", -1.0),
    "centers beyond all bounds": put("centers", 1e200),
    "no inputs": reshape("centers", lambda a: a[:0]),
    "no outputs": reshape("weights", lambda a: a[:0]),
    "fewer trials than none": header("trials", to=-1),
    "half a trial": header("trials", to=0.5),
    "too little capacity": header("capacity", to=11),
    "no capacity": header("capacity", to=0),
    "capacity beyond memory": header("capacity", to=10**15),
    "capacity beyond addresses": header("capacity", to=10**30),
    "a threshold that is no number": header("settings", "error_threshold", to=float("nan")),
    "a negative threshold": header("settings", "learning_threshold", to=-1),
    "no half-maximum": header("settings", "half_max_fraction", to=0),
    "an unknown setting": header("settings", "momentum", to=0.9),
    "settings of another type": header("settings", to=[1, 2]),
    "an unknown field": header("response", "sharpness", to=2),
    "a rate that is no number": header("adaptation", "rate", to=float("inf")),
    "no kind": header("schedule", to={}),
    "a kind of another type": header("schedule", to=5),
    "a kind that cannot be a name": header("schedule", "kind", to=[1]),
}


@pytest.mark.parametrize("change", FORGERIES.values(), ids=FORGERIES.keys())
def test_parts_that_make_no_working_network_are_refused(stored, change):
    forge(stored, change)
    assert_refused(stored)


def test_the_forger_can_also_write_a_good_file(stored):
    forge(stored, lambda *_: None)
    assert state(ResourceAllocatingNetwork.load(stored)) == state(make())
    write(stored, "1", json.dumps(make().parts()[1]))
    assert state(ResourceAllocatingNetwork.load(stored)) == state(make())


def test_a_kind_that_is_not_registered_says_what_to_do(stored):
    forge(stored, header("response", "kind", to="Triangular"))
    assert_refused(stored, "'Triangular', which is not registered: import the module")


def test_a_folder_and_a_missing_file_are_refused(tmp_path):
    assert_refused(tmp_path)
    assert_refused(tmp_path / "absent")
    assert_refused(tmp_path / "absent" / "more")


def test_a_file_that_cannot_be_read_is_refused(stored, monkeypatch):
    def denied(*_args, **_kwargs):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("handeye.io.tensors.safe_open", denied)
    assert_refused(stored, "Permission denied")


@pytest.mark.parametrize("where", [(os, "fsync"), (Path, "replace")])
@pytest.mark.parametrize("interruption", [OSError("disk full"), KeyboardInterrupt()])
def test_an_interrupted_save_leaves_the_old_file(stored, monkeypatch, where, interruption):
    before = stored.read_bytes()

    def interrupted(*_args):
        raise interruption

    with monkeypatch.context() as patch:
        patch.setattr(*where, interrupted)
        with pytest.raises(type(interruption)):
            make(40).save(stored)
    assert stored.read_bytes() == before
    assert list(stored.parent.iterdir()) == [stored]
    make(40).save(stored)
    assert ResourceAllocatingNetwork.load(stored).trials == 40


def test_a_diverged_network_is_not_saved_over_a_good_one(stored):
    before = stored.read_bytes()
    network = make()
    network._units.weights[0, 0] = np.inf
    with pytest.raises(InvalidInput, match="weights must be finite"):
        network.save(stored)
    assert stored.read_bytes() == before


def test_nothing_in_a_file_is_code(stored):
    header_length = int.from_bytes(stored.read_bytes()[:8], "little")
    metadata = json.loads(stored.read_bytes()[8 : 8 + header_length])["__metadata__"]
    assert metadata["format"] == "handeye.network"
    assert json.loads(metadata["header"])["response"] == {"kind": "Gaussian"}
    assert set(load_file(stored)) == set(ARRAYS)
