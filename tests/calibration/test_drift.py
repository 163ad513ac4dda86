"""Plants that change: eq 3.97 to 3.99, and steps."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.calibration.cases import sightings

from handeye.calibration.drift import OffsetStep, Thermal, steady
from handeye.calibration.world import PlanarWorld
from handeye.thesis.plants import NORMAL

trials = st.integers(0, 3000)


def numbers(plant) -> Any:
    """Every parameter that may drift."""
    return [
        plant.arm.a, plant.arm.b, plant.v_x, plant.v_y, plant.alpha.offset, plant.beta.offset,
        plant.gamma.offset, plant.head.range_scale,
    ]  # fmt: skip


@given(trials)
def test_steady_is_the_same_plant(trial):
    assert steady(NORMAL, trial) is NORMAL


@given(trials, st.sampled_from([250.0, 500.0, 4000.0]))
def test_thermal_drift_equals_eq_3_97_to_3_99(n, period):
    s = np.sin(2.0 * np.pi * n / period)
    f = 1.0 + 26e-6 * 50.0 * s  # eq 3.98
    degree = np.pi / 180.0
    expected = [
        1.005 * f,
        1.003 * f,
        -1.01 * f,
        -0.02 * f + 1.01 * degree * s,
        0.0 + degree * s,
        0.018 + degree * s,
        0.035 - degree * s,
        1.0 + 0.02 * s,
    ]
    np.testing.assert_allclose(
        numbers(Thermal(period)(NORMAL, n)), expected, rtol=1e-13, atol=1e-15
    )


def test_a_base_one_metre_away_is_displaced_as_the_thesis_states():
    moved = Thermal(4.0)(replace(NORMAL, v_x=-1.0, v_y=0.0), 1)
    np.testing.assert_allclose(moved.v_y, 1.745e-2, rtol=1e-3)


def test_drift_touches_nothing_else():
    warm = Thermal(400.0)(NORMAL, 100)
    back = replace(
        warm,
        arm=NORMAL.arm,
        v_x=NORMAL.v_x,
        v_y=NORMAL.v_y,
        alpha=replace(warm.alpha, offset=NORMAL.alpha.offset),
        beta=replace(warm.beta, offset=NORMAL.beta.offset),
        gamma=replace(warm.gamma, offset=NORMAL.gamma.offset),
        head=replace(warm.head, range_scale=1.0),
    )
    assert back == NORMAL


def test_thermal_settings_are_amplitudes_and_phase():
    still = Thermal(100.0, expansion=0.0, bend=0.0, scale=0.0)
    np.testing.assert_allclose(numbers(still(NORMAL, 25)), numbers(NORMAL))
    shifted = Thermal(100.0, phase_shift=np.pi / 2.0)
    np.testing.assert_allclose(
        numbers(shifted(NORMAL, 0)), numbers(Thermal(100.0)(NORMAL, 25)), rtol=1e-14
    )


@pytest.mark.parametrize("axis", ["alpha", "beta", "gamma"])
@given(trial=trials)
def test_a_step_moves_one_offset_from_its_trial_on(axis, trial):
    step = OffsetStep(axis, size=0.03, at=1000)
    changed = step(NORMAL, trial)
    jump = 0.03 if trial >= 1000 else 0.0
    encoder = getattr(NORMAL, axis)
    assert getattr(changed, axis).offset == encoder.offset + jump
    assert replace(changed, **{axis: encoder}) == NORMAL


@pytest.mark.parametrize(
    "drift",
    [steady, Thermal(37.0), OffsetStep("beta", -0.1, at=5)],
    ids=["steady", "thermal", "step"],
)
def test_trials_together_are_trials_one_by_one(drift):
    n = 12
    together = sightings(NORMAL, n=n, drift=drift)
    at = np.arange(n)
    tips = PlanarWorld(NORMAL, drift=drift).tips(together.joints, at)
    for i in range(n):
        alone = drift(NORMAL, i)
        np.testing.assert_allclose(alone.tips(together.joints[i]), tips[i], rtol=0, atol=1e-15)
        row = [np.broadcast_to(value, n)[i] for value in numbers(drift(NORMAL, at))]
        np.testing.assert_allclose(row, numbers(alone), rtol=1e-15, atol=1e-17)
