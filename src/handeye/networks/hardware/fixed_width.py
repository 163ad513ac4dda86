"""Virtual neurons of one width, fixed at the outset (section 3.5.3, appendix B)."""

from typing import NamedTuple

from handeye.arrays import Array
from handeye.networks.adaptation import RULES, adapt, find_active
from handeye.networks.responses import respond, width
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
    x: Array,  # noqa: ARG001
    error: Array,
    work: Work,
) -> None:
    """Eq 3.69."""
    active = find_active(work.o, n, rule.on_threshold, work.indices)
    z, widths, virtual = work.a[:active], work.b[:active], work.c[:active]
    for j in range(active):
        z[j] = work.z[work.indices[j]]
    smallest = settings.smallest_width * settings.diameter
    widths[:] = width(response, max(rule.half_distance, smallest))
    respond(response, z, widths, virtual)
    overlap = 0.0
    for j in range(active):
        overlap += virtual[j] * work.o[work.indices[j]]
    if overlap <= 0.0:
        return
    virtual /= overlap
    for k in range(error.size):
        step = rule.rate * error[k]
        for j in range(active):
            units.weights[k, work.indices[j]] += step * virtual[j]


RULES[FixedVirtualNeuron.__name__] = FixedVirtualNeuron
