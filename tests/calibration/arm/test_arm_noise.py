"""The sensor's noise, told from the errors of an arm that is not what its model says."""

from dataclasses import replace

import numpy as np
import pytest
from tests.calibration.arm.arms import NOISE, TURN_NOISE, errors_of, model, sightings

from handeye.calibration.arm.noise import with_noise
from handeye.calibration.arm.sheet import ArmSheet, CurveTerms
from handeye.calibration.placement import estimate_placement, sensor_of

STIFF = ArmSheet(curves=CurveTerms(0, 0), compliance=0.0)


def as_placed(seen):
    """The model as a log is placed: all that the nominal arm does not explain is noise."""
    fit = estimate_placement(model().arm, seen)
    turn_std, noise = sensor_of(fit, seen)
    return replace(model(), placement=fit.placement, turn_std=turn_std, noise=noise)


@pytest.mark.parametrize("n", [40, 900])
@pytest.mark.parametrize("seed", [0, 1])
def test_noise_is_what_constant_errors_of_the_arm_leave(n, seed):
    seen = sightings(model(), errors_of(model(), seed, STIFF), n, seed, STIFF)
    wild = np.random.default_rng(seed).random(n) < 0.1
    seen.position[wild] += 0.05
    rough = as_placed(replace(seen, position_std=None))
    fine = with_noise(rough, replace(seen, position_std=None))
    # An arm of ordinary tolerances is wrong by ten times and more of this noise.
    assert rough.noise > 10.0 * NOISE
    assert fine.noise == pytest.approx(NOISE, rel=0.35)
    assert fine.turn_std == pytest.approx(TURN_NOISE, rel=0.35)


def test_positions_that_state_their_noise_need_none():
    seen = sightings(model(), errors_of(model(), 0, STIFF), 40, 0, STIFF)
    assert with_noise(as_placed(seen), seen).noise == 0.0
    alone = replace(seen, orientation=None)
    placed = as_placed(alone)
    assert with_noise(placed, alone) is placed
    unstated = replace(alone, position_std=None)
    fine = with_noise(as_placed(unstated), unstated)
    assert fine.turn_std is None
    assert fine.noise == pytest.approx(NOISE, rel=0.35)


@pytest.mark.parametrize("n", [5, 9])
def test_few_rows_tell_of_noise_no_more_than_the_nominal_arm(n):
    seen = replace(sightings(model(), errors_of(model()), n), position_std=None)
    rough = as_placed(seen)
    fine = with_noise(rough, seen)
    assert 0.0 < fine.noise <= rough.noise
    assert 0.0 < np.float64(fine.turn_std) <= rough.turn_std


def test_orientations_of_something_else_are_not_used():
    seen = sightings(model(), errors_of(model()), 30)
    turned = seen.orientation[np.random.default_rng(0).permutation(30)]
    assert as_placed(replace(seen, orientation=turned)).turn_std is None
