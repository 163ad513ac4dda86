"""Learners of any kind within files that hold more than one learner."""

from typing import Any, TypeVar

from handeye.arrays import Array
from handeye.errors import FileFormatError, InvalidInput
from handeye.io.tensors import Parts
from handeye.networks.checked import CheckedLearner
from handeye.networks.hardware import HardwareNetwork
from handeye.networks.layered import LayeredNetwork
from handeye.networks.learner import Learner
from handeye.networks.memories import AlbusCMAC, SigmaPi
from handeye.networks.network import ResourceAllocatingNetwork
from handeye.networks.recursive import KalmanNetwork, RecursiveNetwork

L = TypeVar("L", bound=CheckedLearner)

LEARNERS: dict[str, type[CheckedLearner]] = {
    kind.FORMAT: kind
    for kind in (
        ResourceAllocatingNetwork, RecursiveNetwork, KalmanNetwork, LayeredNetwork, AlbusCMAC,
        SigmaPi, HardwareNetwork,
    )
}  # fmt: skip
"""The learners that such a file can hold, by their formats. Add yours."""


def to_arrays(learner: Learner) -> Parts:
    """The arrays and the JSON-able rest of a learner.

    Raises InvalidInput for one that is not registered, or that has diverged: `from_arrays` refuses
    what is not finite.
    """
    if isinstance(learner, CheckedLearner) and LEARNERS.get(learner.FORMAT) is type(learner):
        arrays, rest = learner.parts()
        return arrays, {**rest, "learner": learner.FORMAT}
    raise InvalidInput(
        f"a {type(learner).__name__} cannot be stored within another file: store it in one of its "
        "own with its method save"
    )


def from_arrays(
    arrays: dict[str, Array],
    rest: dict[str, Any],
    kind: type[L] = ResourceAllocatingNetwork,
) -> L:
    """The learner of `to_arrays`, which must be of a kind.

    Raises FileFormatError, or what Python raises where parts are missing or do not fit together.
    """
    # Files of before there was a choice hold no other.
    name = rest.get("learner", ResourceAllocatingNetwork.FORMAT)
    found = LEARNERS.get(name)
    if found is None or not issubclass(found, kind):
        raise FileFormatError(
            f"it holds a learner of kind {name!r}, which is not known here: update handeye, or "
            "import the module that defines it before loading"
        )
    return found.of_parts(arrays, rest)
