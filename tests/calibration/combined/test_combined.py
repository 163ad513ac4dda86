"""The calibrator: protocol, files, uncertainty, suggestions, and what it does with wrong models."""

import json
from dataclasses import dataclass, replace

import numpy as np
import pytest
from tests.calibration.combined.robots import (
    CLEAN_MODEL,
    MODEL,
    mean_error,
    stream,
    taught,
)

from handeye.calibration.calibrators import Nominal
from handeye.calibration.combined import (
    Combined,
    Settings,
    combined_from_arrays,
    combined_to_arrays,
    floor,
)
from handeye.calibration.models import PlanarMap
from handeye.calibration.session import WorldStreams, position_errors
from handeye.calibration.world import PlanarWorld, Region
from handeye.errors import InvalidInput
from handeye.observations import StereoTarget
from handeye.robots.encoder import AxisEncoder
from handeye.thesis.plants import NOMINAL, NORMAL

CORNER = Region(alpha=(-1.3, -0.8), beta=(1.8, 2.3), eccentricity=0.05)


def state(combined):
    arrays, rest = combined_to_arrays(combined)
    return {name: array.tolist() for name, array in arrays.items()} | rest


def test_many_at_once_are_the_same_as_one_by_one():
    seen = stream(160)
    many, single = Combined(MODEL), Combined(MODEL)
    together = many.observe_many(seen)
    one_by_one = [single.observe(one) for one in seen]
    np.testing.assert_array_equal(together.error, [f.error for f in one_by_one])
    np.testing.assert_array_equal(together.allocated, [f.allocated for f in one_by_one])
    assert state(many) == state(single)


def test_it_reports_the_error_made_before_learning():
    combined, seen = Combined(MODEL), stream(30)
    for one in seen:
        batch = one[np.newaxis]
        expected = combined.errors(batch)[0]
        np.testing.assert_allclose(combined.observe(one).error, expected, atol=1e-12)
        after = np.linalg.norm(combined.errors(batch))
        assert after <= np.linalg.norm(expected) * 1.05 + 0.02
    np.testing.assert_allclose(Combined(MODEL).errors(seen), Nominal(MODEL).errors(seen), atol=1e-9)


def test_a_stored_calibrator_goes_on_as_if_nothing_had_happened():
    seen = stream(220)
    combined = Combined(MODEL)
    combined.observe_many(seen[:150])
    arrays, rest = combined_to_arrays(combined)
    restored = combined_from_arrays(MODEL, arrays, json.loads(json.dumps(rest)))
    assert state(restored) == state(combined)
    for one in (combined, restored):
        one.observe_many(seen[150:])
    assert state(restored) == state(combined)


@pytest.mark.parametrize("name", ["x", "bank.roots", "bank.seen", "guard.scores"])
def test_parts_that_do_not_fit_are_refused(name):
    arrays, rest = combined_to_arrays(taught())
    with pytest.raises(ValueError, match=r"shape|length"):
        combined_from_arrays(MODEL, {**arrays, name: arrays[name][..., :-1]}, rest)
    broken = arrays["bank.roots"].copy()
    broken[0, 3, 0] = 1.0
    with pytest.raises(ValueError, match="triangular"):
        combined_from_arrays(MODEL, {**arrays, "bank.roots": broken}, rest)


def test_misuse_is_refused_and_changes_nothing():
    combined, seen = Combined(MODEL), stream(3)
    with pytest.raises(InvalidInput, match="PlanarModel"):
        Combined(PlanarMap(NOMINAL))  # pyright: ignore[reportArgumentType]
    with pytest.raises(InvalidInput, match="observe_many"):
        combined.observe(seen)
    with pytest.raises(InvalidInput, match="leading axis"):
        combined.observe_many(seen[0])
    assert combined.n_observations == 0
    assert "nothing observed" in combined.health()


def test_one_command_is_the_same_as_one_of_many():
    combined, seen = taught(), stream(8)
    many = combined.command(seen.target)
    for i in range(8):
        np.testing.assert_array_equal(combined.command(seen.target[i]), many[i])


def test_it_gets_near_the_floor_in_tens_of_observations():
    for replicate in (0, 1):
        world = PlanarWorld(NORMAL)
        least = floor(world, 0, WorldStreams.of(replicate), 200).mean()
        assert mean_error(taught(150, replicate), replicate=replicate) < 1.06 * least


def test_a_robot_as_drawn_is_known_to_a_micrometre_after_ten():
    plant = NORMAL.without_perturbations().without_noise()
    combined = Combined(CLEAN_MODEL)
    combined.observe_many(stream(10, plant=plant))
    assert mean_error(combined, plant) < 1e-6


@pytest.mark.parametrize("region", [Region(), CORNER], ids=["everywhere", "corner"])
def test_errors_at_unvisited_poses_are_what_the_covariance_allows(region):
    """Squared errors over their covariance average 2; and no pose is worse than it allows."""
    ratios = []
    for replicate in range(4):
        combined = Combined(MODEL)
        combined.observe_many(stream(40, replicate, region=region))
        clean = NORMAL.without_noise()
        world, streams = PlanarWorld(clean), WorldStreams.of(50 + replicate)
        fresh = world.observe(np.zeros(150, np.int64), streams.test_poses, streams.test_noise)
        learned = world.tips(fresh.joints, np.zeros(150, np.int64)) - clean.tips(
            combined.command(fresh.target)
        )
        allowed = combined.covariance(fresh.target)
        nominal = world.tips(fresh.joints, np.zeros(150, np.int64)) - clean.tips(
            NOMINAL.joints_for(fresh.target)
        )
        deviation = np.sqrt(np.trace(allowed, axis1=1, axis2=2))
        worse = np.linalg.norm(learned, axis=1) - np.linalg.norm(nominal, axis=1)
        assert np.mean(worse <= 3.0 * deviation + 1e-3) > 0.97
        ratios.append(np.mean(np.sum(learned**2, axis=1) / deviation**2))
    assert np.mean(ratios) < 2.0


def test_uncertainty_grows_away_from_where_the_hand_has_worked():
    combined = Combined(MODEL)
    combined.observe_many(stream(40, region=CORNER))
    inside = combined.covariance(stream(30, 3, region=CORNER).target)
    outside = combined.covariance(stream(30, 3).target)
    near, far = (np.trace(c, axis1=1, axis2=2).mean() for c in (inside, outside))
    assert far > 4.0 * near
    target = stream(1, 3).target
    single = combined.covariance(target[0])
    np.testing.assert_allclose(single, combined.covariance(target)[0])
    assert np.linalg.eigvalsh(combined.covariance(target[0], noise=True) - single).min() > 0.0


def test_suggested_poses_teach_more_than_random_ones():
    after_random, after_suggested = [], []
    for replicate in range(3):
        streams = WorldStreams.of(replicate)
        random, guided = Combined(MODEL), Combined(MODEL)
        for one in (random, guided):
            one.observe_many(stream(15, replicate))
        for _ in range(5):
            pose = guided.suggest(candidates=100)
            alpha, beta, eps = *pose.joints, pose.eccentricity
            region = Region((alpha, alpha), (beta, beta), singular_beta=0.0, eccentricity=0.0)
            assert pose.after <= pose.before
            tip = NORMAL.tips(pose.joints[np.newaxis])
            noise = streams.train_noise.standard_normal((1, 2))
            pointing, r, eps_meas = NORMAL.sight(tip, np.array([eps]), noise)
            like = stream(1, region=region)
            guided.observe_many(
                replace(like, joints=pose.joints[np.newaxis], pointing=pointing, range=r,
                        eccentricity=eps_meas)
            )  # fmt: skip
        random.observe_many(stream(20, replicate)[15:])
        for errors, one in ((after_random, random), (after_suggested, guided)):
            fresh = stream(200, 77).target
            errors.append(np.trace(one.covariance(fresh), axis1=1, axis2=2).mean())
    assert np.mean(after_suggested) < np.mean(after_random)


def test_suggestions_stay_within_limits_and_serve_the_working_points():
    combined = Combined(MODEL)
    combined.observe_many(stream(20))
    pose = combined.suggest(CORNER, stream(5, 3).target, candidates=50)
    assert CORNER.alpha[0] <= pose.joints[0] <= CORNER.alpha[1]
    assert CORNER.beta[0] <= pose.joints[1] <= CORNER.beta[1]
    assert pose.best == int(np.argmax(pose.gains))
    assert (pose.gains > 0.0).all()
    nobody = np.empty(0)
    with pytest.raises(InvalidInput, match="working point"):
        combined.suggest(working_points=StereoTarget(nobody, nobody, nobody, nobody))


@dataclass(frozen=True)
class Jagged(AxisEncoder):
    """Gear teeth finer than any curve that the model has."""

    teeth: float = 12.0

    def error(self, angle):
        return 3e-3 * np.sin(self.teeth * angle) + super().error(angle)


def test_a_robot_unlike_the_model_is_learned_as_well_as_it_can_be_and_reported():
    jagged = Jagged(amplitude=-1.7e-3, frequency=1.0, phase=2.0)
    plant = replace(NORMAL.without_noise(), alpha=jagged)
    plain, networked = (Combined(CLEAN_MODEL, settings=Settings(capacity=n)) for n in (0, 200))
    seen = stream(350, plant=plant)
    plain.observe_many(seen)
    networked.observe_many(seen)
    streams = WorldStreams.of(0)
    errors = position_errors(
        PlanarWorld(plant), [plain, networked, Nominal(CLEAN_MODEL)], 0, streams, 200
    )
    without, given, nominal = (np.linalg.norm(e, axis=1).mean() for e in errors)
    # The teeth are 3 mrad, 2 mrad in the mean, at up to two metres.
    assert without < 0.006 < nominal
    assert given < 1.05 * without
    assert "unexplained" in plain.health()
