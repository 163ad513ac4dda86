"""What the learners of this package share: the two verbs, checked once, and files."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from copy import deepcopy
from os import PathLike
from typing import Any, Self, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, count, shaped
from handeye.errors import FileFormatError, InvalidInput
from handeye.io.tensors import read_tensors, write_tensors
from handeye.networks.outcomes import Learned, LearnedMany
from handeye.networks.units import moderate

T = TypeVar("T")
Parts = tuple[dict[str, Any], dict[str, Any]]
"""Arrays, and the JSON-able rest."""


class Learner(ABC):
    """Learns a mapping from R^d to R^m one sample at a time; every argument is checked here.

    A subclass does the work on checked arrays in `_predict` and `_learn`, and says in `_parts` and
    `_restored` what there is to store.
    """

    _FORMAT = ""
    _VERSION = 1

    def __init__(self, n_inputs: int, n_outputs: int) -> None:
        self.n_inputs = count(n_inputs, "n_inputs")
        self.n_outputs = count(n_outputs, "n_outputs")
        self._trials = 0

    @property
    def trials(self) -> int:
        """Samples learned so far."""
        return self._trials

    def predict(self, x: ArrayLike) -> Array:
        """Output (m,) at one input (d,)."""
        return self._predict(self._inputs(shaped(x, (self.n_inputs,), "x")[np.newaxis]))[0]

    def predict_many(self, x: ArrayLike) -> Array:
        """Outputs (N, m) at inputs (N, d)."""
        return self._predict(self._inputs(shaped(x, (None, self.n_inputs), "x")))

    def learn(self, x: ArrayLike, target: ArrayLike) -> Learned:
        """Learn one sample, x (d,) and target (m,); report the error made before learning."""
        one = shaped(x, (self.n_inputs,), "x")[np.newaxis]
        wanted = shaped(target, (self.n_outputs,), "target")[np.newaxis]
        error, allocated = self.learn_many(one, wanted)
        return Learned(error[0], bool(allocated[0]))

    def learn_many(self, x: ArrayLike, target: ArrayLike) -> LearnedMany:
        """Learn N samples in order, x (N, d) and target (N, m); the same result as one by one."""
        inputs = self._inputs(shaped(x, (None, self.n_inputs), "x"))
        targets = moderate(shaped(target, (None, self.n_outputs), "target"), "target")
        if len(inputs) != len(targets):
            raise InvalidInput(f"x has {len(inputs)} samples but target has {len(targets)}")
        return self._learn(inputs, targets)

    def copy(self) -> Self:
        """An independent learner in the same state."""
        return deepcopy(self)

    def save(self, path: str | PathLike[str]) -> None:
        """Write everything to one safetensors file, replacing an old one only once complete."""
        arrays, rest = self._parts()
        write_tensors(path, self._FORMAT, self._VERSION, arrays, {**rest, "trials": self._trials})

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Self:
        """The learner that `save` wrote.

        Raises:
            FileFormatError: a damaged or foreign file, or one written by a newer version.
        """

        def restored(arrays: dict[str, Array], rest: dict[str, Any]) -> Self:
            learner = cls._restored(arrays, rest)
            learner._trials = count(rest["trials"], "trials", least=0)
            return learner

        return read_parts(path, cls._FORMAT, cls._VERSION, restored)

    def _inputs(self, x: Array) -> Array:
        """Inputs (N, d) as the work wants them; InvalidInput if some are too large."""
        return moderate(x, "x")

    @abstractmethod
    def _predict(self, inputs: Array) -> Array:
        """Outputs (N, m)."""

    @abstractmethod
    def _learn(self, inputs: Array, targets: Array) -> LearnedMany:
        """Learn in order and count the trials."""

    @abstractmethod
    def _parts(self) -> Parts:
        """What to store."""

    @classmethod
    @abstractmethod
    def _restored(cls, arrays: dict[str, Array], rest: dict[str, Any]) -> Self:
        """The learner of `_parts`; may raise what Python raises where they do not fit together."""


def read_parts(
    path: str | PathLike[str],
    kind: str,
    version: int,
    build: Callable[[dict[str, Array], dict[str, Any]], T],
) -> T:
    """What `build` makes of a stored file; FileFormatError says what is wrong with any other."""
    arrays, rest = read_tensors(path, kind, version, f"a stored {kind}")
    try:
        return build(arrays, rest)
    except (
        AttributeError, LookupError, MemoryError, OverflowError, TypeError, ValueError,
    ) as error:  # fmt: skip
        raise FileFormatError(
            f"{path}: damaged, its parts do not fit together ({error})"
        ) from error
