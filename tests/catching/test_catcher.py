import numpy as np
import pytest
from tests.catching.trained import SETTINGS, WORLD, copied, throws, trained

from handeye.catching import practice
from handeye.catching.learner import Learner
from handeye.catching.play import play
from handeye.catching.settings import IMPROVED, SMOOTH, THESIS


@pytest.mark.parametrize("name", SETTINGS)
def test_before_any_learning_the_arm_does_not_move(name):
    thrown = throws(8)
    for arm, ball in ((thrown.arm, thrown.ball), (None, None)):
        seen = practice.test(Learner(SETTINGS[name]), WORLD, thrown, arm=arm, ball=ball)
        assert np.nanmax(np.abs(seen.voltage)) == 0.0
        np.testing.assert_array_equal(seen.final.arm_x, thrown.arm_x)


def test_with_the_arm_alone_or_the_ball_alone_it_does_not_move_either():
    for untrained in ({"pursuits": 0, "tosses": 8}, {"pursuits": 8, "tosses": 0}):
        learner = trained("thesis", **untrained)
        thrown = throws(8)
        seen = practice.test(learner, WORLD, thrown, arm=thrown.arm, ball=thrown.ball)
        assert np.nanmax(np.abs(seen.voltage)) == 0.0


def test_it_catches_what_it_has_practised_and_identifies_arm_and_ball():
    thrown = throws(60, 1)
    seen = practice.test(trained(), WORLD, thrown)
    assert seen.caught.mean() > 0.7
    before_contact = seen.sensed.time < np.minimum(seen.contact_time, seen.final.time)
    last = np.where(before_contact, np.arange(len(before_contact))[:, None], 0).max(axis=0)
    trials = np.arange(60)
    assert np.mean(seen.traces["ball"][last, trials] == thrown.ball) > 0.9
    assert np.mean(seen.traces["arm"][last, trials] == thrown.arm) > 0.9


def test_a_wrong_ball_and_a_wrong_arm_are_found_out_in_mid_trial():
    thrown = throws(40, 2)
    seen = practice.test(trained(), WORLD, thrown, arm=1 - thrown.arm, ball=1 - thrown.ball)
    for thing, right in (("ball", thrown.ball), ("arm", thrown.arm)):
        assert np.mean((seen.traces[thing] == right).any(axis=0)) == 1.0
    assert seen.caught.mean() > 0.6


@pytest.mark.parametrize("name", ["thesis", "improved", "smooth"])
def test_a_batch_equals_its_throws_one_by_one(name):
    thrown = throws(5, 3)
    learner = trained(name)
    together = practice.test(learner, WORLD, thrown)
    for i in range(5):
        alone = practice.test(learner, WORLD, thrown[i : i + 1])
        ticks = len(alone.voltage)
        np.testing.assert_array_equal(together.voltage[:ticks, i], alone.voltage[:, 0])
        for trace, values in alone.traces.items():
            np.testing.assert_array_equal(together.traces[trace][:ticks, i], values[:, 0], trace)


def test_a_controller_can_play_again():
    catcher = trained().catcher()
    first, second = (play(WORLD, throws(4, 4), catcher) for _ in range(2))
    np.testing.assert_array_equal(first.voltage, second.voltage)


def test_an_incomprehensible_ball_leaves_the_arm_in_the_safe_state():
    seen = practice.test(trained("thesis"), WORLD, throws(20, 5, arms=(1,)), arm=1)
    lost = (seen.traces["ball_comprehended"] == 0.0) & seen.sensed.active
    assert lost.any()
    assert np.all(seen.voltage[lost] == 0.0)


def test_a_surprising_arm_goes_on_being_moved_by_the_net_believed_in(tmp_path):
    learner = copied(trained("thesis"), tmp_path)
    learner.repertoire.arm_recogniser.threshold = 9.0  # never recognises
    thrown = throws(20, 6, arms=(0,))
    seen = practice.test(learner, WORLD, thrown, arm=1, ball=thrown.ball)
    unsure = (seen.traces["arm"] == -1.0) & (seen.traces["pursuing"] == 1.0)
    assert unsure.any()
    assert np.all(seen.voltage[unsure & seen.sensed.active] != 0.0)


def test_the_goal_is_the_predicted_crossing_plus_the_corrections(tmp_path):
    learner = copied(trained("thesis"), tmp_path)
    grid = np.stack(np.meshgrid([-2.0, 0.0, 2.0], [-1.0, 0.0, 1.0], [0.0, 0.5, 1.0]), -1)
    inputs = grid.reshape(-1, 3)
    learner.repertoire.corrections[1].practise(inputs, np.tile([0.04, -0.08], (len(inputs), 1)))
    traces = practice.test(learner, WORLD, throws(6, 7), arm=1, ball=0).traces
    for name in ("correction_x", "correction_time"):
        assert np.nanmax(np.abs(traces[name])) > 0.02
    np.testing.assert_array_equal(traces["stop_x"], traces["crossing_x"] + traces["correction_x"])
    np.testing.assert_array_equal(
        traces["stop_time"], traces["crossing_time"] + traces["correction_time"]
    )


def test_only_the_improved_learner_shakes_an_unknown_arm():
    first = [
        practice.test(trained(name), WORLD, throws(4, 8)).voltage[0]
        for name in ("thesis", "improved")
    ]
    assert np.all(first[0] == 0.0)
    assert np.all(np.abs(first[1]) == IMPROVED.excitation)
    assert THESIS.excitation == 0.0


def test_a_lead_asks_the_arm_to_be_there_earlier_as_long_as_it_can():
    seen = practice.test(trained("smooth"), WORLD, throws(6, 9), arm=1, ball=0)
    traces, time = seen.traces, seen.sensed.time
    early = traces["crossing_time"] - SMOOTH.lead
    known = np.isfinite(early)
    assert (early > time)[known].any()
    assert (early <= time)[known].any()
    np.testing.assert_array_equal(
        traces["stop_time"][known], np.where(early > time, early, traces["crossing_time"])[known]
    )


def test_an_unknown_arm_is_moved_as_the_first_until_it_is_recognised(tmp_path):
    learner = copied(trained("thesis"), tmp_path)
    learner.repertoire.arm_recogniser.threshold = 9.0  # never recognises
    thrown = throws(6, 10, arms=(1,))
    unknown, first = (practice.test(learner, WORLD, thrown, arm=a, ball=1) for a in (None, 0))
    assert np.nanmax(np.abs(unknown.voltage)) > 0.0
    np.testing.assert_array_equal(unknown.voltage, first.voltage)
