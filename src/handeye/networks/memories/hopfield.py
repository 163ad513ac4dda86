"""A symmetric Hopfield memory: patterns are where its energy is lowest."""

from copy import deepcopy
from os import PathLike
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike

from handeye._compiled import compiled
from handeye.arrays import Array, Integers, count, finite, shaped
from handeye.errors import InvalidInput
from handeye.io.tensors import restore, write_tensors

FORMAT = "handeye.hopfield"
VERSION = 1


class Recall(NamedTuple):
    """Where a state went.

    state    each neuron +1 or -1, (n,)
    sweeps   times that every neuron was updated, the last without a change if settled
    settled  whether nothing changes any more
    """

    state: Array
    sweeps: int
    settled: bool


class HopfieldMemory:
    """n neurons of +1 or -1, each connected to all others, none to itself (section A.6.1).

    The connections are the sum of the outer products of the stored patterns,

        W = (1 / n) sum_p xi_p xi_p^T,    W_ii = 0                     (Hopfield 1982)

    One neuron at a time takes the sign of its net input `sum_j W_ij s_j`, and stays as it is where
    that is zero. Since W is symmetric, the energy `-s^T W s / 2` never rises, so every state comes
    to rest. Up to about 0.14 n random patterns can be recalled; with more, none can (Amit,
    Gutfreund and Sompolinsky 1985).

    Args:
        n: neurons.

    Raises:
        InvalidInput: no neurons, or in any method patterns that are not of n values +1 or -1;
            nothing has changed then.
    """

    def __init__(self, n: int) -> None:
        self.n = count(n, "n")
        self._stored = 0
        # Whole numbers, so that net inputs and energies are exact.
        self._sums = np.zeros((self.n, self.n))

    @property
    def stored(self) -> int:
        """Patterns stored so far."""
        return self._stored

    @property
    def weights(self) -> Array:
        """W, (n, n); a copy."""
        return self._sums / self.n

    def store(self, patterns: ArrayLike) -> None:
        """Add patterns (n,) or (P, n) to the memory."""
        some = self._signs(np.atleast_2d(finite(patterns, "patterns")), (None, self.n), "patterns")
        self._sums += some.T @ some
        np.fill_diagonal(self._sums, 0.0)
        self._stored += len(some)

    def energy(self, state: ArrayLike) -> float:
        """`-s^T W s / 2` of a state (n,)."""
        s = self._signs(state, (self.n,), "state")
        return float(-0.5 * (s @ self._sums @ s) / self.n)

    def recall(
        self, state: ArrayLike, rng: np.random.Generator, *, most_sweeps: int = 100
    ) -> Recall:
        """Let a state (n,) come to rest, neuron by neuron in an order drawn anew for each sweep.

        Updating all at once would not do: the energy could rise and states could alternate for
        ever (section A.6.5).
        """
        s = self._signs(state, (self.n,), "state").copy()
        for sweep in range(1, count(most_sweeps, "most_sweeps") + 1):
            if not update(self._sums, s, rng.permutation(self.n)):
                return Recall(s, sweep, settled=True)
        return Recall(s, most_sweeps, settled=False)

    def copy(self) -> Self:
        """An independent memory of the same patterns."""
        return deepcopy(self)

    def save(self, path: str | PathLike[str]) -> None:
        """Write everything to one safetensors file, replacing an old one only once complete."""
        write_tensors(path, FORMAT, VERSION, {"sums": self._sums}, {"stored": self._stored})

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Self:
        """The memory that `save` wrote.

        Raises:
            FileFormatError: a damaged or foreign file, or one written by a newer version.
        """

        def restored(arrays: dict[str, Array], rest: dict[str, Any]) -> Self:
            memory = cls(len(arrays["sums"]))
            memory._sums = shaped(arrays["sums"], (memory.n, memory.n), "sums").copy()
            memory._stored = count(rest["stored"], "stored", least=0)
            return memory

        return restore(path, FORMAT, VERSION, "a stored HopfieldMemory", restored)

    def __repr__(self) -> str:
        """Size and state."""
        return f"HopfieldMemory({self.n} neurons, {self.stored} patterns)"

    def _signs(self, value: ArrayLike, shape: tuple[int | None, ...], name: str) -> Array:
        array = shaped(value, shape, name)
        if not np.all(np.abs(array) == 1.0):
            raise InvalidInput(f"{name} must hold only +1 and -1: threshold it first")
        return array


@compiled
def update(sums: Array, state: Array, order: Integers) -> int:
    """Update neurons of state (n,) in place in an order; return how many changed."""
    changed = 0
    for i in order:
        if (sums[i] @ state) * state[i] < 0.0:
            state[i] = -state[i]
            changed += 1
    return changed
