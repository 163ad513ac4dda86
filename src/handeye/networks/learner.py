"""What every learner of this package does, however it learns."""

from os import PathLike
from typing import Protocol, Self

from numpy.typing import ArrayLike

from handeye.arrays import Array
from handeye.networks.outcomes import Learned, LearnedMany


class Learner(Protocol):
    """Learns a mapping from R^d to R^m, one sample at a time.

    Whoever uses a network should ask for no more than this. A learner of one's own that inherits
    from `handeye.networks.checked.CheckedLearner` has all of it.
    """

    @property
    def n_inputs(self) -> int:
        """d."""
        ...

    @property
    def n_outputs(self) -> int:
        """m."""
        ...

    def predict(self, x: ArrayLike) -> Array:
        """Output (m,) at one input (d,)."""
        ...

    def predict_many(self, x: ArrayLike) -> Array:
        """Outputs (N, m) at inputs (N, d)."""
        ...

    def learn(self, x: ArrayLike, target: ArrayLike) -> Learned:
        """Learn one sample, x (d,) and target (m,); report the error made before learning."""
        ...

    def learn_many(self, x: ArrayLike, target: ArrayLike) -> LearnedMany:
        """Learn N samples in order, x (N, d) and target (N, m); the same result as one by one."""
        ...

    def copy(self) -> Self:
        """An independent learner in the same state."""
        ...

    def save(self, path: str | PathLike[str]) -> None:
        """Write everything to one file, from which the class's `load` goes on as if nothing was."""
        ...
