"""What a chip's arithmetic must do; `fixed.py` and `floating.py` do it, each in its own numbers.

`numbers` is a NamedTuple of the constants of one chip. A width is a pair (gain, shift): a neuron
with it sees a squared distance z as u = gain z / 2^shift (see `curves.py`).
"""

from typing import Any, NamedTuple

from handeye._compiled import by_kind
from handeye.networks.hardware.operations import Tally


@by_kind
def activity(numbers: NamedTuple, table: Any, z: Any, gain: Any, shift: Any, tally: Tally) -> Any:
    """The response of a neuron of some width at squared distance z."""


@by_kind
def output_word(numbers: NamedTuple, total: Any, tally: Tally) -> Any:
    """A sum of weights times responses as an output."""


@by_kind
def virtual_width(numbers: NamedTuple, nearest: Any, tally: Tally) -> Any:
    """The width (gain, shift) that answers one half at squared distance h^2 `nearest`."""


@by_kind
def fixed_width(numbers: NamedTuple) -> Any:
    """The one virtual width (gain, shift) of a chip that has it fixed."""


@by_kind
def alike(numbers: NamedTuple, total: Any) -> Any:
    """A sum of responses in the units of a sum of products of two responses; costs nothing."""


@by_kind
def quotient(numbers: NamedTuple, table: Any, overlap: Any, tally: Tally) -> Any:
    """(q, shift): rate / overlap is about q / 2^shift. The one division of a trial."""


@by_kind
def part(numbers: NamedTuple, q: Any, error: Any, tally: Tally) -> Any:
    """rate error_k / overlap: what is common to the changes of all weights of one output."""


@by_kind
def change_alike(numbers: NamedTuple, part: Any, shift: Any, noise: Any, tally: Tally) -> Any:
    """The change of a weight of an output's active neurons when it is the same for all."""


@by_kind
def change_of(
    numbers: NamedTuple, part: Any, response: Any, shift: Any, noise: Any, tally: Tally
) -> Any:
    """The change of the weight of a neuron at which the virtual neuron responds so."""


@by_kind
def changed(numbers: NamedTuple, weight: Any, change: Any, tally: Tally) -> Any:
    """The weight after the change."""
