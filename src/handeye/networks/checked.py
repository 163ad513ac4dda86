"""What the learners of this package share: the two verbs, checked once, and files."""

from abc import ABC, abstractmethod
from copy import deepcopy
from os import PathLike
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, count, finite, shaped
from handeye.errors import InvalidInput
from handeye.io.tensors import Parts, restore, write_tensors
from handeye.networks.outcomes import Learned, LearnedMany
from handeye.networks.units import moderate


class CheckedLearner(ABC):
    """A `Learner` whose every argument is checked here, before any work is done.

    A subclass does the work on checked arrays in `_predict` and `_learn`, and says in `_parts` and
    `_restored` what there is to store. Named in `handeye.networks.storage.LEARNERS`, it can be
    stored within a calibrated model too.

    Raises:
        InvalidInput: in any method an array of the wrong shape or type, or with values that are
            not finite or beyond 1e100; nothing has changed then.
    """

    FORMAT: ClassVar[str]
    """Kind of file, such as "handeye.network"."""

    VERSION: ClassVar[int] = 1
    """Raised when older versions of the package could not read what `_parts` says."""

    def __init__(self, n_inputs: int, n_outputs: int) -> None:
        self.n_inputs = count(n_inputs, "n_inputs")
        self.n_outputs = count(n_outputs, "n_outputs")
        self._trials: int = 0

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
        one = self._inputs(shaped(x, (self.n_inputs,), "x")[np.newaxis])
        wanted = moderate(shaped(target, (self.n_outputs,), "target"), "target")[np.newaxis]
        error, allocated = self._learn(one, wanted)
        return Learned(error[0], bool(allocated[0]))

    def learn_many(self, x: ArrayLike, target: ArrayLike) -> LearnedMany:
        """Learn N samples in order, x (N, d) and target (N, m); the same result as one by one.

        Raises:
            LearningDiverged: at the first sample whose error is beyond 1e100 or no number, where
                the rule can diverge at all; the samples before it are learned, of a
                HardwareNetwork none.
        """
        inputs = self._inputs(shaped(x, (None, self.n_inputs), "x"))
        targets = moderate(shaped(target, (None, self.n_outputs), "target"), "target")
        if len(inputs) != len(targets):
            raise InvalidInput(f"x has {len(inputs)} samples but target has {len(targets)}")
        return self._learn(inputs, targets)

    def copy(self) -> Self:
        """An independent learner in the same state."""
        return deepcopy(self)

    def save(self, path: str | PathLike[str]) -> None:
        """Write everything to one safetensors file, replacing an old one only once complete.

        Raises:
            InvalidInput: a learner that has diverged: `load` refuses what is not finite.
        """
        write_tensors(path, self.FORMAT, self.VERSION, *self.parts())

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Self:
        """The learner that `save` wrote.

        Raises:
            FileFormatError: a damaged or foreign file, one written by a newer version, or one that
                uses a response, schedule, rule or activation that is not registered.
        """
        return restore(path, cls.FORMAT, cls.VERSION, f"a stored {cls.__name__}", cls.of_parts)

    def parts(self) -> Parts:
        """What `save` writes, for a file that holds more than this learner.

        Raises:
            InvalidInput: as `save`.
        """
        arrays, rest = self._parts()
        for name, array in arrays.items():
            finite(array, name)
        return arrays, {**rest, "trials": self._trials}

    @classmethod
    def of_parts(cls, arrays: dict[str, Array], rest: dict[str, Any]) -> Self:
        """The learner of `parts`; raises what Python raises where they do not fit together."""
        learner = cls._restored(arrays, rest)
        learner._trials = count(rest["trials"], "trials", least=0)
        return learner

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
        """What to store beside the trials."""

    @classmethod
    @abstractmethod
    def _restored(cls, arrays: dict[str, Array], rest: dict[str, Any]) -> Self:
        """The learner of `_parts`."""
