"""What every calibrator promises, of those that came before."""

from copy import deepcopy
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from tests.calibration.earlier.worlds import MAKERS, MAP, sightings

from handeye.calibration.earlier import KupersteinMap, MurphyTable
from handeye.calibration.models import PlanarMap
from handeye.calibration.session import WorldStreams, learn_from_log, position_errors
from handeye.calibration.world import PlanarWorld
from handeye.errors import InvalidInput
from handeye.robots.planar import TwoLinkArm
from handeye.thesis.plants import NOMINAL, NORMAL

SEEN = sightings(300)
EVERY = pytest.mark.parametrize("make", MAKERS.values(), ids=MAKERS)


def miss(calibrator, seen):
    """Where the hand was seen minus where the calibrator puts it, by nominal kinematics."""
    return NOMINAL.tips(seen.joints) - NOMINAL.tips(calibrator.command(seen.target))


def same_commands(one, other):
    np.testing.assert_array_equal(one.command(SEEN.target), other.command(SEEN.target))


@EVERY
def test_observing_reports_the_error_made_before_learning(make):
    calibrator = make()
    for i in range(25):
        expected = miss(calibrator, SEEN[[i]])[0]
        feedback = calibrator.observe(SEEN[i])
        np.testing.assert_allclose(feedback.error, expected, atol=1e-12)
        assert feedback.error.shape == (2,)
        assert np.shape(feedback.allocated) == ()


@EVERY
def test_many_at_once_is_one_by_one_in_any_parts(make):
    whole, single, parts = make(), make(), make()
    errors, allocated = whole.observe_many(SEEN[:60])
    one_by_one = [single.observe(one) for one in SEEN[:60]]
    np.testing.assert_array_equal(errors, [f.error for f in one_by_one])
    np.testing.assert_array_equal(allocated, [f.allocated for f in one_by_one])
    for part in (slice(0, 7), slice(7, 8), slice(8, 8), slice(8, 60)):
        np.testing.assert_array_equal(parts.observe_many(SEEN[part]).error, errors[part])
    same_commands(whole, single)
    same_commands(whole, parts)


@EVERY
def test_errors_and_commands_teach_nothing(make):
    calibrator, rest = make(), SEEN[200:]
    calibrator.observe_many(SEEN[:200])
    before = deepcopy(calibrator)
    np.testing.assert_allclose(calibrator.errors(rest), miss(calibrator, rest), atol=1e-12)
    together = calibrator.command(rest.target)
    alone = np.stack([calibrator.command(target) for target in rest.target])
    np.testing.assert_array_equal(alone, together)
    same_commands(calibrator, before)
    np.testing.assert_array_equal(calibrator.errors(rest)[0], calibrator.observe(rest[0]).error)


@EVERY
def test_one_for_many_and_many_for_one_are_refused_and_change_nothing(make):
    calibrator = make()
    calibrator.observe_many(SEEN[:100])
    before = deepcopy(calibrator)
    for call in (
        lambda: calibrator.observe(SEEN[100:130]),
        lambda: calibrator.observe_many(SEEN[100]),
        lambda: calibrator.errors(SEEN[100]),
    ):
        with pytest.raises(InvalidInput):
            call()
    same_commands(calibrator, before)


@EVERY
def test_sightings_from_nowhere_are_borne(make):
    calibrator, far = make(), SEEN[:3]
    calibrator.observe_many(SEEN[:100])
    joints = np.array([[9.0, -7.0], [-50.0, 1e-9], [1e6, 0.0]])
    odd = replace(far, joints=joints, range=np.array([-3.0, 1e9, 0.0]))
    assert np.isfinite(calibrator.observe_many(odd).error).all()
    assert np.isfinite(calibrator.command(odd.target)).all()


@EVERY
def test_learning_helps_on_fresh_poses(make):
    calibrator, untaught = make(), make()
    calibrator.observe_many(SEEN)
    learned, before = position_errors(
        PlanarWorld(NORMAL), [calibrator, untaught], 0, WorldStreams.of(101), 200
    )
    after = np.linalg.norm(learned, axis=1).mean()
    assert after < 0.5 * np.linalg.norm(before, axis=1).mean()


@EVERY
def test_it_can_be_put_in_the_place_of_any_other(make):
    feedback = learn_from_log(make(), SEEN[:90], every=40)
    assert feedback.error.shape == (90, 2)


@pytest.mark.parametrize("kind", [KupersteinMap, partial(MurphyTable, joint_units=24)])
def test_the_whole_map_is_learned_without_kinematics(kind):
    """With other links nothing changes but the metres in which errors are stated."""
    mine, theirs = kind(MAP), kind(PlanarMap(replace(NOMINAL, arm=TwoLinkArm(0.7, 1.3))))
    mistakes = [learner.observe_many(SEEN[:100]).error for learner in (mine, theirs)]
    same_commands(mine, theirs)
    assert not np.allclose(*mistakes)
