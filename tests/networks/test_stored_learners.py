"""Files of the first version stay readable, and learners can be stored within other files."""

import json
from pathlib import Path
from typing import Any, Self

import numpy as np
import pytest
from tests.networks.learners import EVERY, samples, state

from handeye.arrays import Array
from handeye.errors import FileFormatError, InvalidInput
from handeye.io.kinds import kind_of
from handeye.io.tensors import Parts
from handeye.networks import HardwareNetwork, ResourceAllocatingNetwork
from handeye.networks.checked import CheckedLearner
from handeye.networks.layered import LayeredNetwork
from handeye.networks.memories import AlbusCMAC, HopfieldMemory, SigmaPi
from handeye.networks.outcomes import LearnedMany
from handeye.networks.recursive import RecursiveNetwork
from handeye.networks.storage import LEARNERS, from_arrays, to_arrays

STORED = Path(__file__).parent / "stored"
PROBES = [[0.3, -0.2], [-0.5, 0.6]]
# Learned and stored by the first version of each class: its trials, what it said at PROBES, and a
# part of its repr.
FIRST = {
    "ran": (
        ResourceAllocatingNetwork, 20, [-0.29346531561843003, 0.44226467625498933],
        "12 neurons of at most 12, 20 trials, Cosine(), Power(exponent=1.0, k=0.5), CMAC(rate=0.02",
    ),
    "layered": (
        LayeredNetwork, 20, [0.17153776940241117, 0.10381651247000936],
        "2-3-1 neurons, 20 trials, Sigmoid(gain=1.0), Linear(gain=1.0), rate 0.05",
    ),
    "albus-cmac": (
        AlbusCMAC, 20, [0.031109755961341357, -0.05555981548444612],
        "30 cells in 32 slots, 26 collisions, 20 trials, 4 layers, field 0.5, rate 0.5",
    ),
    "sigma-pi": (
        SigmaPi, 20, [0.17212995080817667, 0.19015661268957723],
        "6 products of up to 2, 20 trials, rate 0.5",
    ),
    "recursive": (
        RecursiveNetwork, 25, [0.2374358486618462, 0.22037734855998536],
        "8 neurons of at most 8, 25 trials",
    ),
    # Chips did not count their trials then.
    "chip": (
        HardwareNetwork, 0, [-0.296875, 0.435546875],
        "12 neurons, Cosine(), CMAC(rate=0.02, on_threshold=0.1), FixedPoint(word_length=12",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", FIRST)
def test_a_file_of_the_first_version_is_read_as_it_was(name):
    kind, trials, said, told = FIRST[name]
    learner = kind.load(STORED / f"{name}.safetensors")
    assert kind_of(STORED / f"{name}.safetensors") == kind.FORMAT
    assert learner.trials == trials
    assert told in repr(learner)
    # Least squares round otherwise than then.
    np.testing.assert_allclose(learner.predict_many(PROBES)[:, 0], said, rtol=1e-9)


def test_a_memory_of_the_first_version_is_read_as_it_was():
    memory = HopfieldMemory.load(STORED / "hopfield.safetensors")
    pattern = np.array([1, 1, -1, -1, 1, -1])
    assert memory.stored == 1
    np.testing.assert_array_equal(
        memory.weights, (np.outer(pattern, pattern) - np.eye(6)) / memory.n
    )


@pytest.mark.parametrize("case", EVERY, ids=[case.name for case in EVERY])
def test_a_learner_within_another_file_goes_on_alike(case, tmp_path):
    learner = case.make(0)
    learner.learn_many(*samples(learner, 0, 20))
    arrays, rest = to_arrays(learner)
    again = from_arrays(arrays, json.loads(json.dumps(rest)), CheckedLearner)
    assert type(again) is type(learner)
    assert state(again, tmp_path) == state(learner, tmp_path)
    for one in (again, learner):
        one.learn_many(*samples(one, 1, 20))
    assert state(again, tmp_path) == state(learner, tmp_path)


def test_without_a_name_it_is_a_resource_allocating_network():
    arrays, rest = to_arrays(ResourceAllocatingNetwork(2, 1))
    del rest["learner"]
    assert isinstance(from_arrays(arrays, rest), ResourceAllocatingNetwork)


def test_another_kind_than_wanted_or_known_is_refused():
    arrays, rest = to_arrays(LayeredNetwork(2, 1))
    with pytest.raises(FileFormatError, match=r"kind 'handeye\.layered'"):
        from_arrays(arrays, rest)
    with pytest.raises(FileFormatError, match=r"kind 'mine'.* import the module"):
        from_arrays(arrays, rest | {"learner": "mine"}, CheckedLearner)


class Mean(CheckedLearner):
    """A learner of one's own: the mean of all targets."""

    FORMAT = "tests.mean"

    def __init__(self, n_inputs: int, n_outputs: int) -> None:
        super().__init__(n_inputs, n_outputs)
        self.mean = np.zeros(self.n_outputs)

    def _predict(self, inputs: Array) -> Array:
        return np.tile(self.mean, (len(inputs), 1))

    def _learn(self, inputs: Array, targets: Array) -> LearnedMany:
        error = np.empty_like(targets)
        for i, target in enumerate(targets):
            error[i] = target - self.mean
            self._trials += 1
            self.mean = self.mean + error[i] / self._trials
        return LearnedMany(error, np.zeros(len(inputs), np.bool_))

    def _parts(self) -> Parts:
        return {"mean": self.mean}, {"n_inputs": self.n_inputs}

    @classmethod
    def _restored(cls, arrays: dict[str, Array], rest: dict[str, Any]) -> Self:
        learner = cls(rest["n_inputs"], len(arrays["mean"]))
        learner.mean = arrays["mean"]
        return learner


def test_only_registered_learners_are_stored_within_another_file(monkeypatch):
    mine = Mean(2, 1)
    mine.learn_many([[0.0, 0.0], [1.0, 1.0]], [[1.0], [4.0]])
    with pytest.raises(InvalidInput, match=r"a Mean .* its own .* save"):
        to_arrays(mine)
    monkeypatch.setitem(LEARNERS, Mean.FORMAT, Mean)
    again = from_arrays(*to_arrays(mine), Mean)
    assert again.trials == 2
    np.testing.assert_array_equal(again.predict([5.0, 5.0]), [2.5])


def test_a_learner_that_has_diverged_is_not_stored(tmp_path):
    mine = Mean(1, 1)
    mine.mean[0] = np.inf
    for store in (lambda: mine.save(tmp_path / "mine"), mine.parts):
        with pytest.raises(InvalidInput, match="mean must be finite"):
            store()
    assert not (tmp_path / "mine").exists()
