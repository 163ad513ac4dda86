"""Virtual neurons of one width, fixed at the outset (section 3.5.3, appendix B)."""
# ruff: noqa: ARG001 (every implementation has the arguments of its declaration)

from typing import NamedTuple

from handeye.arrays import Array
from handeye.networks.adaptation import RULES, adapt, find_active, imitate
from handeye.networks.units import Settings, Units, Work


class FixedVirtualNeuron(NamedTuple):
    """Eq 3.69 with a virtual neuron whose half-maximum distance never changes.

    `half_distance` is in scaled input units. For neurons on a regular grid it stands for the
    search for the nearest neuron: a chip needs no feedback to size the virtual neuron.
    """

    half_distance: float = 0.5
    rate: float = 0.06
    on_threshold: float = 0.1


@adapt.of(FixedVirtualNeuron)
def fixed_virtual_neuron(
    rule: FixedVirtualNeuron,
    response: NamedTuple,
    settings: Settings,
    units: Units,
    n: int,
    x: Array,
    error: Array,
    work: Work,
) -> None:
    """Eq 3.69."""
    active = find_active(work.o, n, rule.on_threshold, work.indices)
    imitate(response, settings, rule.rate, rule.half_distance, active, units, error, work)


RULES[FixedVirtualNeuron.__name__] = FixedVirtualNeuron
