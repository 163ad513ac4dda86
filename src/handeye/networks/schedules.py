"""Allocation schedules: how far from every center an input must lie to be given a neuron.

t counts the trials from 1, D is the diameter of the input space. A kind is a NamedTuple class
with one compiled function; the fields are the constants of its formula, with the thesis's values.
"""

from typing import NamedTuple

import numpy as np

from handeye._compiled import by_kind


class Constant(NamedTuple):
    """`theta_d = threshold`: eq 3.54 (0, the preferred one), 3.55 (0.1) and 3.56 (0.5)."""

    threshold: float = 0.0


class Power(NamedTuple):
    """`theta_d = k D / t^exponent`.

    Exponent 1: eq 3.47, 1/2: eq 3.48, 2: eq 3.49, 1/3: eq 3.51, 1/n_eff: eq 3.53.
    """

    exponent: float = 1.0
    k: float = 0.5


class GaussianDecay(NamedTuple):
    """`theta_d = D exp(-t^2 / chi^2)` (eq 3.50)."""

    chi: float = 1000.0


class Logarithmic(NamedTuple):
    """`theta_d = k D / ln(t + 1)` (eq 3.52)."""

    k: float = 0.5


@by_kind
def threshold(schedule: NamedTuple, t: int, diameter: float) -> float:
    """The distance threshold theta_d at trial t >= 1."""
    return diameter


@threshold.of(Constant)
def constant(schedule: Constant, t: int, diameter: float) -> float:
    """Eq 3.54 to 3.56."""
    return schedule.threshold


@threshold.of(Power)
def power(schedule: Power, t: int, diameter: float) -> float:
    """Eq 3.47 to 3.49, 3.51 and 3.53."""
    return schedule.k * diameter / float(t) ** schedule.exponent


@threshold.of(GaussianDecay)
def gaussian_decay(schedule: GaussianDecay, t: int, diameter: float) -> float:
    """Eq 3.50."""
    return diameter * np.exp(-((t / schedule.chi) ** 2))


@threshold.of(Logarithmic)
def logarithmic(schedule: Logarithmic, t: int, diameter: float) -> float:
    """Eq 3.52."""
    return schedule.k * diameter / np.log(t + 1.0)


SCHEDULES: dict[str, type] = {
    kind.__name__: kind for kind in (Constant, Power, GaussianDecay, Logarithmic)
}
"""Every schedule by name; a stored network finds its own here. Add yours."""
