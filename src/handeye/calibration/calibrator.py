"""What every calibrator does, whatever it knows and however it learns."""

from typing import NamedTuple, Protocol, TypeVar

from handeye.arrays import Array, Booleans
from handeye.observations import Observation, Target

O_contra = TypeVar("O_contra", bound=Observation, contravariant=True)
T_contra = TypeVar("T_contra", bound=Target, contravariant=True)


class Feedback(NamedTuple):
    """What one observation (or N of them, in order) taught.

    error      how far off the hand would have been, *before* learning: where it was seen minus
               where the calibrator would have put it, (k,) or (N, k) [m]
    allocated  whether the learner took a new unit for it, () or (N,)
    """

    error: Array
    allocated: Booleans


class Calibrator(Protocol[O_contra, T_contra]):
    """Learns from observations where the hand goes; says which joints bring it to a target."""

    def observe(self, observation: O_contra) -> Feedback:
        """Learn from one observation; report the error made before learning."""
        ...

    def observe_many(self, observations: O_contra) -> Feedback:
        """Learn from N observations in order: the same result as one by one, but faster."""
        ...

    def errors(self, observations: O_contra) -> Array:
        """The errors (N, k) [m] that it would make on N observations as it is, learning nothing."""
        ...

    def command(self, target: T_contra) -> Array:
        """Joint commands (encoder readings) that bring the hand to one target or to each of N."""
        ...
