"""Scores: counts, Wilson's interval, and errors of the cup's position."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import binomtest
from tests.reports.made_up_catching import made_up_recording

from handeye.catching.learner import Learner
from handeye.catching.results import ANY, Score, network_name, scores_of, sum_of, total_of
from handeye.errors import InvalidInput

RECORDING = made_up_recording(40, skill=0.5)


@given(st.integers(1, 1000), st.floats(0.0, 1.0))
def test_the_interval_is_wilsons(n, share):
    caught = round(share * n)
    score = Score(0, 0, n, caught, 0.0)
    expected = binomtest(caught, n).proportion_ci(method="wilson")
    np.testing.assert_allclose(score.interval, (expected.low, expected.high), atol=1e-12)
    low, high = score.interval
    assert 0.0 <= low <= score.share <= high <= 1.0


def test_twenty_of_twenty_is_no_certainty():
    low, high = Score(0, 0, 20, 20, 0.0).interval
    assert low == pytest.approx(0.839, abs=1e-3)
    assert high == 1.0


def test_each_pair_of_ball_and_arm_is_counted_for_itself():
    throws = RECORDING.throws
    scores = scores_of(RECORDING)
    assert [(s.ball, s.arm) for s in scores] == [(0, 0), (0, 1), (1, 0), (1, 1)]
    for score in scores:
        rows = [i for i in range(40) if throws.ball[i] == score.ball and throws.arm[i] == score.arm]
        assert score.n == len(rows) == 10
        assert score.caught == sum(bool(RECORDING.caught[i]) for i in rows)
        errors = [RECORDING.position_error[i] ** 2 for i in rows]
        assert score.rms == pytest.approx((sum(errors) / 10) ** 0.5)


def test_the_total_is_over_all_throws():
    total = total_of(RECORDING)
    assert (total.ball, total.arm, total.n) == (ANY, ANY, 40)
    assert total.caught == sum(score.caught for score in scores_of(RECORDING))
    assert total.rms == pytest.approx(np.sqrt(np.mean(RECORDING.position_error**2)))
    assert total.name == "any ball, any arm"
    added = sum_of(scores_of(RECORDING))
    assert (added.n, added.caught) == (total.n, total.caught)
    assert added.rms == pytest.approx(total.rms)


def test_a_score_as_data_has_every_number_by_name():
    data = Score(1, 0, 50, 49, 0.031).to_json()
    assert (data["ball"], data["arm"]) == ("heavy", "light")
    assert (data["n"], data["caught"], data["share"]) == (50, 49, 0.98)
    assert data["low"] < 0.98 < data["high"]
    assert data["rms_position_error"] == 0.031


def test_no_throws_have_no_score():
    with pytest.raises(InvalidInput, match="no throws"):
        total_of(RECORDING[:0])
    assert scores_of(RECORDING[:0]) == ()


def test_a_throw_out_of_bounds_is_no_catch():
    none = replace(RECORDING, caught=np.zeros(40, bool))
    assert total_of(none).share == 0.0


def test_every_network_of_a_learner_has_a_name_of_its_own():
    keys = list(Learner().neurons)
    names = [network_name(key) for key in keys]
    assert len(set(names)) == len(keys) == 12
    assert network_name("motors.1") == "motor command, heavy arm"
    assert network_name("ball_recogniser") == "ball recognition"
