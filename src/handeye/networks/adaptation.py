"""Adaptation rules: how the neurons that exist are adjusted when none is added.

A kind is a NamedTuple class with one compiled function that changes the units in place. The error
is e = target - output; z and o hold every neuron's squared distance and response to the input.
"""

from math import sqrt
from typing import NamedTuple

import numpy as np

from handeye._compiled import by_kind, compiled
from handeye.arrays import Array, Integers
from handeye.networks.responses import respond, slopes, width
from handeye.networks.units import Settings, Units, Work


class VirtualNeuron(NamedTuple):
    """Corrects the active neurons in proportion to a virtual neuron centered at the input.

    `delta w_kj = rate e_k V_j / sum_l V_l o_l` over the active neurons (eq 3.69), where V_j is the
    response at center j of a neuron whose half-maximum distance is h times the distance to the
    nearest active neuron. A neuron is active when its response exceeds `on_threshold` (theta_o).
    """

    rate: float = 0.06
    on_threshold: float = 0.1


class CMAC(NamedTuple):
    """Corrects the active neurons alike: `delta w_kj = rate e_k / sum_l o_l` (eq 3.73)."""

    rate: float = 0.02
    on_threshold: float = 0.1


class GradientDescent(NamedTuple):
    """Descends E = |e|^2 / 2 in weights, centers and widths of every neuron (eq 3.59 to 3.61).

    A width that would fall below the network's floor stays there (note E11).
    """

    rate: float = 0.02


class NoAdaptation(NamedTuple):
    """Leaves the neurons as they were allocated."""


@by_kind
def adapt(
    rule: NamedTuple,
    response: NamedTuple,
    settings: Settings,
    units: Units,
    n: int,
    x: Array,
    error: Array,
    work: Work,
) -> None:
    """Adjust the first n units after input x (d,) gave error (m,)."""


@compiled
def find_active(o: Array, n: int, on_threshold: float, indices: Integers) -> int:
    """Fill `indices` with the neurons whose response exceeds the threshold; return how many."""
    found = 0
    for j in range(n):
        if o[j] > on_threshold:
            indices[found] = j
            found += 1
    return found


@compiled
def imitate(
    response: NamedTuple,
    settings: Settings,
    rate: float,
    half_distance: float,
    active: int,
    units: Units,
    error: Array,
    work: Work,
) -> None:
    """Eq 3.69 with a virtual neuron of a half-maximum distance, over the active neurons found."""
    z = work.a[:active]
    widths = work.b[:active]
    virtual = work.c[:active]
    for j in range(active):
        z[j] = work.z[work.indices[j]]
    smallest = settings.smallest_width * settings.diameter
    widths[:] = width(response, max(half_distance, smallest))
    respond(response, z, widths, virtual)
    overlap = 0.0
    for j in range(active):
        overlap += virtual[j] * work.o[work.indices[j]]
    # A response with a finite radius and h < 1/2 reaches no active neuron: nothing to correct.
    if overlap <= 0.0:
        return
    # Divided before the error comes in: an overlap next to zero must not make the step overflow.
    virtual /= overlap
    for k in range(error.size):
        step = rate * error[k]
        for j in range(active):
            units.weights[k, work.indices[j]] += step * virtual[j]


@adapt.of(VirtualNeuron)
def virtual_neuron(
    rule: VirtualNeuron,
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
    if active == 0:
        return
    nearest = np.inf
    for j in range(active):
        nearest = min(nearest, work.z[work.indices[j]])
    half_distance = settings.half_max_fraction * sqrt(nearest)
    imitate(response, settings, rule.rate, half_distance, active, units, error, work)


@adapt.of(CMAC)
def cmac(
    rule: CMAC,
    response: NamedTuple,
    settings: Settings,
    units: Units,
    n: int,
    x: Array,
    error: Array,
    work: Work,
) -> None:
    """Eq 3.73."""
    active = find_active(work.o, n, rule.on_threshold, work.indices)
    activity = 0.0
    for j in range(active):
        activity += work.o[work.indices[j]]
    if activity <= 0.0:
        return
    for k in range(error.size):
        step = rule.rate * error[k] / activity
        for j in range(active):
            units.weights[k, work.indices[j]] += step


@adapt.of(GradientDescent)
def gradient_descent(
    rule: GradientDescent,
    response: NamedTuple,
    settings: Settings,
    units: Units,
    n: int,
    x: Array,
    error: Array,
    work: Work,
) -> None:
    """Eq 3.59 to 3.61, every parameter stepped from the same state."""
    by_z = work.a[:n]
    by_width = work.b[:n]
    back = work.c[:n]
    slopes(response, work.z[:n], units.widths[:n], by_z, by_width)
    back[:] = 0.0
    for k in range(error.size):
        for j in range(n):
            back[j] += units.weights[k, j] * error[k]
            units.weights[k, j] += rule.rate * work.o[j] * error[k]
    for i in range(x.size):
        for j in range(n):
            units.centers[i, j] -= (
                2.0 * rule.rate * by_z[j] * (x[i] - units.centers[i, j]) * back[j]
            )
    floor = width(response, settings.smallest_width * settings.diameter)
    for j in range(n):
        units.widths[j] = max(units.widths[j] + rule.rate * by_width[j] * back[j], floor)


@adapt.of(NoAdaptation)
def no_adaptation(
    rule: NoAdaptation,
    response: NamedTuple,
    settings: Settings,
    units: Units,
    n: int,
    x: Array,
    error: Array,
    work: Work,
) -> None:
    """Nothing changes."""


RULES: dict[str, type] = {
    kind.__name__: kind for kind in (VirtualNeuron, CMAC, GradientDescent, NoAdaptation)
}
"""Every rule by name; a stored network finds its own here. Add yours."""
