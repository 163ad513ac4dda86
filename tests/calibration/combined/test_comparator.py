"""Outliers, changes and drift: told apart, attributed, and followed."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.calibration.combined.robots import (
    MODEL,
    mean_error,
    spoiled,
    stream,
    taught,
)

from handeye.calibration.combined import (
    Combined,
    Event,
    combined_from_arrays,
    combined_to_arrays,
    floor,
)
from handeye.calibration.drift import OffsetStep
from handeye.calibration.session import WorldStreams
from handeye.calibration.world import PlanarWorld
from handeye.thesis.plants import NORMAL


def a_copy(combined):
    return combined_from_arrays(MODEL, *combined_to_arrays(combined))


def changes(combined):
    return [event for event in combined.events if event.kind == "change"]


@settings(max_examples=10)
@given(place=st.integers(0, 30), far=st.floats(0.3, 2.0), sign=st.sampled_from([-1.0, 1.0]))
def test_one_wild_observation_teaches_nothing(place, far, sign):
    combined = a_copy(taught())
    before = combined.engine.x.copy()
    one = stream(200)[160 + place]
    combined.observe(replace(one, range=np.abs(one.range + sign * far) + 0.1))
    np.testing.assert_allclose(combined.engine.x, before, atol=1e-12)
    assert combined.events[-1].kind == "outlier"
    assert not changes(combined)


BUMPS = {
    "encoder offset of alpha": replace(NORMAL, alpha=replace(NORMAL.alpha, offset=0.035)),
    "encoder offset of beta": replace(NORMAL, beta=replace(NORMAL.beta, offset=0.018 + 0.035)),
    "encoder offset of gamma": replace(NORMAL, gamma=replace(NORMAL.gamma, offset=0.035 - 0.035)),
    "range scale": NORMAL.with_range_scale(1.1),
    "place of the camera": replace(NORMAL, v_x=NORMAL.v_x + 0.1, v_y=NORMAL.v_y - 0.1),
}


@pytest.mark.parametrize("part", BUMPS)
def test_a_change_is_attributed_to_its_part_and_learned_at_once(part):
    combined = a_copy(taught())
    combined.observe_many(stream(15, replicate=7, plant=BUMPS[part]))
    (change,) = changes(combined)
    assert change.part == part
    assert 150 <= change.observation <= 155
    assert abs(change.amount) > 5.0 * change.std > 0.0
    least = floor(PlanarWorld(BUMPS[part]), 0, WorldStreams.of(0), 200).mean()
    assert mean_error(combined, BUMPS[part]) < 1.1 * least
    assert part in combined.health()


@pytest.mark.parametrize("replicate", [0, 16, 17, 24, 30])
def test_a_slip_seen_near_the_eye_is_not_taken_for_a_remounted_camera(replicate):
    """There sightings depend on the slip so strongly that derivatives before it are misleading."""
    combined = Combined(MODEL)
    combined.observe_many(stream(510, replicate, drift=OffsetStep("alpha", 0.035, at=500)))
    (change,) = changes(combined)
    assert change.part == "encoder offset of alpha"
    assert abs(change.amount - 0.035) < 4.0 * change.std


def test_the_amount_of_a_change_is_right_within_its_deviation():
    combined = a_copy(taught())
    combined.observe_many(stream(15, replicate=3, plant=BUMPS["encoder offset of alpha"]))
    (change,) = changes(combined)
    assert change.unknown == "O_alpha"
    assert change.unit == "rad"
    assert abs(change.amount - 0.035) < 4.0 * change.std + 1e-3


@pytest.mark.parametrize("replicate", range(3))
def test_a_steady_robot_never_changes(replicate):
    combined = Combined(MODEL)
    combined.observe_many(stream(300, replicate))
    assert not changes(combined)
    assert sum(event.kind == "outlier" for event in combined.events) <= 3


@pytest.mark.parametrize("replicate", range(2))
def test_outliers_from_the_start_are_found_and_cost_little(replicate):
    rng = np.random.default_rng(replicate)
    seen = stream(150, replicate)
    bad = rng.choice(150, 30, replace=False)
    combined, undisturbed = Combined(MODEL), Combined(MODEL)
    combined.observe_many(spoiled(seen, bad, rng))
    undisturbed.observe_many(seen)
    assert not changes(combined)
    assert mean_error(combined) < 1.05 * mean_error(undisturbed)
    inside = np.array([n for n in bad if n >= 150 - 64])
    assert not combined.engine.bank.weights[inside % 64].any()
    assert "left out" in combined.health()


def test_it_starts_again_when_all_that_was_learned_is_wrong():
    combined = a_copy(taught())
    other = replace(
        NORMAL,
        v_x=-1.2,
        v_y=0.15,
        alpha=replace(NORMAL.alpha, offset=0.15),
        gamma=replace(NORMAL.gamma, offset=-0.2),
        beta=replace(NORMAL.beta, offset=-0.15),
    )
    combined.observe_many(stream(120, replicate=5, plant=other))
    least = floor(PlanarWorld(other), 0, WorldStreams.of(0), 200).mean()
    assert mean_error(combined, other) < 1.2 * least


def test_events_are_one_line_each():
    event = Event(7, "change", "range scale", "re-learned", 0.1, 0.01, "", "range_scale")
    assert str(event) == (
        "observation 7: change of range scale by +0.1 +- 0.01 (range_scale); re-learned"
    )
    assert str(Event(3, "outlier", "", "left out")) == "observation 3: outlier; left out"
