"""Allocation schedules against eq 3.47 to 3.56."""

import math

import numpy as np
import pytest

from handeye._compiled import compiled
from handeye.networks import Constant, GaussianDecay, Logarithmic, Power
from handeye.networks.schedules import threshold

K, CHI, N_EFF = 0.5, 1000.0, 5

TABLE = {
    "eq 3.47": (Power(1.0), lambda t, D: K * D / t),
    "eq 3.48": (Power(0.5), lambda t, D: K * D / math.sqrt(t)),
    "eq 3.49": (Power(2.0), lambda t, D: K * D / t**2),
    "eq 3.50": (GaussianDecay(), lambda t, D: D * math.exp(-(t**2) / CHI**2)),
    "eq 3.51": (Power(1.0 / 3.0), lambda t, D: K * D / math.cbrt(t)),
    "eq 3.52": (Logarithmic(), lambda t, D: K * D / math.log(t + 1)),
    "eq 3.53": (Power(1.0 / N_EFF), lambda t, D: K * D / t ** (1 / N_EFF)),
    "eq 3.54": (Constant(), lambda *_: 0.0),
    "eq 3.55": (Constant(0.1), lambda *_: 0.1),
    "eq 3.56": (Constant(0.5), lambda *_: 0.5),
    "power, another k": (Power(1.0, k=0.2), lambda t, D: 0.2 * D / t),
    "logarithmic, another k": (Logarithmic(k=0.2), lambda t, D: 0.2 * D / math.log(t + 1)),
    "another chi": (GaussianDecay(chi=30.0), lambda t, D: D * math.exp(-(t**2) / 900.0)),
    "whole numbers": (Power(-1, k=2), lambda t, D: 2 * D * t),
}


@compiled
def compiled_threshold(schedule, t, diameter):
    return threshold(schedule, t, diameter)


@pytest.mark.parametrize(("kind", "formula"), TABLE.values(), ids=TABLE.keys())
def test_schedule_equals_its_equation(kind, formula):
    for t in (1, 2, 3, 10, 100, 999, 5000):
        for D in (0.4, 1.0, 3.7):
            found = compiled_threshold(kind, t, D)
            np.testing.assert_allclose(found, formula(t, D), rtol=1e-12, atol=1e-300)


def test_every_registered_schedule_is_in_the_table(schedule):
    assert type(schedule) in {type(kind) for kind, _ in TABLE.values()}
