"""Sessions: the alternating protocol of section 3.4.6, and logs tested before they are learned."""

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.calibration.cases import CASES, sightings

from handeye.calibration.calibrators import NetworkCorrection, Nominal
from handeye.calibration.drift import OffsetStep, Thermal
from handeye.calibration.models import PlanarModel
from handeye.calibration.session import (
    WorldStreams,
    learn_from_log,
    learn_in_world,
    position_errors,
)
from handeye.calibration.world import PlanarWorld
from handeye.errors import InvalidInput
from handeye.thesis.plants import NOMINAL, NORMAL

MODEL = PlanarModel(NOMINAL)
WORLD = PlanarWorld(NORMAL)


class Recorder(Nominal):
    """Nominal, and a diary of what it was asked."""

    def __init__(self):
        super().__init__(MODEL)
        self.diary = []

    def observe_many(self, observations):
        self.diary.append(("learn", observations.time.astype(int).tolist()))
        return super().observe_many(observations)

    def command(self, target):
        self.diary.append(("test", len(target)))
        return super().command(target)


def run(calibrator=None, *, replicate=0, world=WORLD, streams=None, **settings):
    learner = NetworkCorrection(MODEL) if calibrator is None else calibrator
    streams = streams or WorldStreams.of(replicate)
    protocol: Any = {"trials": 60, "every": 20, "tests": 8} | settings
    return learner, learn_in_world(world, learner, Nominal(MODEL), streams, **protocol)


def curve_rows(curve):
    return np.transpose([curve.trials, curve.mean, curve.std, curve.uncorrected, curve.neurons])


@given(
    trials=st.integers(1, 50), every=st.integers(1, 60), tests=st.integers(2, 5),
    start=st.integers(0, 9),
)  # fmt: skip
def test_tests_and_training_alternate(trials, every, tests, start):
    recorder, done = Recorder(), []
    _, curve = run(
        recorder, trials=trials, every=every, tests=tests, start=start, after_each=done.append
    )
    end = start + trials
    marks = [*range(start, end, every), end]
    assert curve.trials.tolist() == marks
    expected = [("test", tests)]
    for first, last in pairwise(marks):
        expected += [("learn", [*range(first, last)]), ("test", tests)]
    assert recorder.diary == expected
    assert done == marks[1:]
    assert not curve.neurons.any()


def test_a_row_is_the_mean_and_sample_deviation_of_error_lengths():
    # Eq 3.43 and 3.44, from the same poses drawn again.
    _, curve = run()
    again = WorldStreams.of(0)
    first = position_errors(WORLD, [NetworkCorrection(MODEL)], 0, again, 8)[0]
    lengths = np.hypot(first[:, 0], first[:, 1])
    np.testing.assert_allclose(curve.mean[0], lengths.sum() / 8)
    np.testing.assert_allclose(curve.std[0], np.sqrt(np.sum((lengths - lengths.mean()) ** 2) / 7.0))
    assert curve.mean[0] == curve.uncorrected[0]


def test_position_errors_are_where_the_hand_was_minus_where_the_command_brings_it():
    streams, trial = WorldStreams.of(3), 40
    world = replace(WORLD, drift=OffsetStep("alpha", 0.2, at=40))
    learner = NetworkCorrection(MODEL)
    learner.observe_many(sightings(n=30))
    (nominal, learned) = position_errors(world, [Nominal(MODEL), learner], trial, streams, 15)
    again = WorldStreams.of(3)
    seen = world.observe(np.full(15, trial), again.test_poses, again.test_noise)
    bent = OffsetStep("alpha", 0.2, at=0)(NORMAL, 0)
    for found, calibrator in ((nominal, Nominal(MODEL)), (learned, learner)):
        expected = bent.tips(seen.joints) - bent.tips(calibrator.command(seen.target))
        np.testing.assert_allclose(found, expected, atol=1e-15)


def test_tests_teach_nothing():
    # As many neurons, at the same places, as after the same training trials alone.
    learner, curve = run()
    alone, streams = NetworkCorrection(MODEL), WorldStreams.of(0)
    alone.observe_many(WORLD.observe(np.arange(60), streams.train_poses, streams.train_noise))
    np.testing.assert_array_equal(learner.network.centers, alone.network.centers)
    np.testing.assert_array_equal(learner.network.weights, alone.network.weights)
    assert learner.network.trials == 60
    assert curve.neurons[-1] == alone.network.n_neurons


def test_how_much_is_tested_does_not_change_what_is_learned():
    rarely, _ = run(every=60, tests=2)
    often, _ = run(every=7, tests=30)
    np.testing.assert_array_equal(rarely.network.weights, often.network.weights)


def test_a_replicate_is_the_same_and_another_is_not():
    np.testing.assert_array_equal(curve_rows(run()[1]), curve_rows(run()[1]))
    assert not np.any(curve_rows(run()[1])[:, 1] == curve_rows(run(replicate=1)[1])[:, 1])


def test_methods_meet_the_same_poses_and_noise():
    _, learner = run()
    _, nominal = run(Nominal(MODEL))
    np.testing.assert_array_equal(learner.uncorrected, nominal.uncorrected)
    np.testing.assert_array_equal(nominal.mean, nominal.uncorrected)


def test_two_sessions_learn_what_one_long_session_learns():
    world = replace(WORLD, drift=Thermal(30.0))
    long, whole = run(world=world, trials=80)
    short, streams = NetworkCorrection(MODEL), WorldStreams.of(0)
    _, first = run(short, world=world, streams=streams, trials=40)
    _, second = run(short, world=world, streams=streams, trials=40, start=40)
    np.testing.assert_array_equal(long.network.weights, short.network.weights)
    np.testing.assert_array_equal(long.network.centers, short.network.centers)
    np.testing.assert_array_equal(curve_rows(first), curve_rows(whole)[:3])
    np.testing.assert_array_equal(second.trials, whole.trials[2:])
    # Neurons are those allocated since the start of a session, and where two sessions meet both
    # measure, so that later tests fall on other poses.
    np.testing.assert_array_equal(first.neurons[-1] + second.neurons, whole.neurons[2:])
    assert not np.any(second.mean == whole.mean[2:])


def test_a_mark_is_measured_on_the_plant_of_the_last_trial_and_a_start_on_its_own():
    world = replace(WORLD, drift=OffsetStep("alpha", 0.5, at=40))
    _, whole = run(Nominal(MODEL), world=world, trials=60)
    bent = whole.mean > 0.3
    assert bent.tolist() == [False, False, False, True]
    _, after = run(Nominal(MODEL), world=world, trials=20, start=40)
    assert np.all(after.mean > 0.3)


def test_a_drifting_plant_is_learned_as_it_is_in_each_trial():
    world = replace(WORLD, drift=Thermal(30.0))
    learner, _ = run(world=world)
    alone, streams = NetworkCorrection(MODEL), WorldStreams.of(0)
    joints, eccentricity = world.region.sample(60, streams.train_poses)
    noise = streams.train_noise.standard_normal((60, 2))
    for i in range(60):
        plant = Thermal(30.0)(NORMAL, i)
        sight = plant.sight(plant.tips(joints[i]), eccentricity[i], noise[i])
        seen = sightings(n=1)[0]
        pointing, r, measured = sight
        alone.observe(
            replace(seen, joints=joints[i], pointing=pointing, range=r, eccentricity=measured)
        )
    np.testing.assert_allclose(learner.network.weights, alone.network.weights, atol=1e-9)


def test_learning_lowers_the_error_of_the_hand():
    _, curve = run(trials=150, every=50, tests=60)
    assert curve.mean[-1] < 0.6 * curve.mean[0]
    assert curve.neurons[-1] > 50


@pytest.mark.parametrize("wrong", [{"trials": 0}, {"every": 0}, {"tests": 1}, {"every": 2.5}])
def test_protocols_that_make_no_sense_are_refused_before_anything_is_learned(wrong):
    learner = NetworkCorrection(MODEL)
    with pytest.raises(InvalidInput, match=next(iter(wrong))):
        run(learner, **wrong)
    assert learner.network.trials == 0


@pytest.mark.parametrize("case", CASES, ids=str)
@given(changed=st.integers(1, 39), every=st.integers(1, 50))
def test_the_error_of_a_row_depends_only_on_it_and_on_those_before(case, changed, every):
    seen = case.seen[:40]
    whole = learn_from_log(NetworkCorrection(case.model), seen, every=100)
    order = np.r_[:changed, changed + np.random.default_rng(0).permutation(40 - changed)]
    other = learn_from_log(NetworkCorrection(case.model), seen[order], every=every)
    np.testing.assert_allclose(whole.error[:changed], other.error[:changed], atol=1e-11)
    np.testing.assert_array_equal(whole.allocated[:changed], other.allocated[:changed])
    assert len(other.error) == len(other.allocated) == 40


def test_each_row_is_tested_before_it_is_learned():
    learner, tested = NetworkCorrection(MODEL), NetworkCorrection(MODEL)
    seen = sightings()
    feedback = learn_from_log(learner, seen, every=7)
    for i, one in enumerate(seen):
        commanded = tested.command(one.target)
        missed = NOMINAL.tips(one.joints) - NOMINAL.tips(commanded)
        np.testing.assert_allclose(feedback.error[i], missed, atol=1e-12)
        tested.observe(one)


@given(n=st.integers(1, 30), every=st.integers(1, 40))
def test_progress_is_told_after_each_part(n, every):
    done = []
    learn_from_log(Nominal(MODEL), sightings(n=n), every=every, after_each=done.append)
    assert done == [*range(every, n, every), n]


def test_the_streams_of_training_and_testing_are_apart():
    streams = WorldStreams.of(2)
    drawn = [
        generator.random(3).tolist()
        for generator in (
            streams.train_poses, streams.train_noise, streams.test_poses, streams.test_noise
        )
    ]  # fmt: skip
    assert len({*map(tuple, drawn)}) == 4
    assert WorldStreams.of(2).train_poses.random(3).tolist() == drawn[0]
