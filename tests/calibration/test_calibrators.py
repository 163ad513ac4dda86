"""What every calibrator promises, over every calibrator and every model."""

import inspect
from dataclasses import fields, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.calibration.cases import CASES, KINDS

from handeye.calibration import calibrators, models, placed_arm
from handeye.calibration.calibrators import NetworkCorrection, Nominal
from handeye.errors import InvalidInput
from handeye.networks import ResourceAllocatingNetwork
from handeye.observations import PointObservation

EVERY_CASE = pytest.mark.parametrize("case", CASES, ids=str)
EVERY_KIND = pytest.mark.parametrize("kind", KINDS)


def state(calibrator):
    """Everything that learning changes."""
    if isinstance(calibrator, Nominal):
        return []
    network = calibrator.network
    return [network.centers, network.widths, network.weights, np.array(network.trials)]


def assert_same(some, others):
    assert len(some) == len(others)
    for one, other in zip(some, others, strict=True):
        np.testing.assert_array_equal(one, other)


def miss(calibrator, seen):
    """Where the hand was seen minus where the calibrator puts it, by another way than `observe`."""
    model = calibrator.model
    if isinstance(seen, PointObservation):
        predicted = model.placement.predict(model.arm, seen.joints)
        if isinstance(calibrator, NetworkCorrection):
            predicted = predicted + calibrator.network.predict_many(seen.joints)
        return seen.position - predicted
    commanded = calibrator.command(seen.target)
    return model.nominal.tips(seen.joints) - model.nominal.tips(commanded)


def test_no_calibrator_and_no_model_is_left_out():
    def offering(module, *methods):
        return {
            cls
            for cls in vars(module).values()
            if inspect.isclass(cls)
            and not getattr(cls, "_is_protocol", False)
            and all(hasattr(cls, method) for method in methods)
        }

    assert offering(calibrators, "observe", "observe_many", "errors", "command") == set(KINDS)
    known = offering(models, "needed", "features") | offering(placed_arm, "needed", "features")
    assert known == {type(case.model) for case in CASES}


@EVERY_CASE
@EVERY_KIND
def test_observing_reports_the_error_made_before_learning(kind, case):
    calibrator = kind(case.model)
    for i in range(25):
        expected = miss(calibrator, case.seen[[i]])[0]
        feedback = calibrator.observe(case.seen[i])
        np.testing.assert_allclose(feedback.error, expected, atol=1e-12)
        assert feedback.error.shape == expected.shape
        assert np.shape(feedback.allocated) == ()


@EVERY_CASE
@EVERY_KIND
def test_many_at_once_is_one_by_one_in_any_parts(kind, case):
    whole, single, parts = (kind(case.model) for _ in range(3))
    errors, allocated = whole.observe_many(case.seen)
    one_by_one = [single.observe(one) for one in case.seen]
    assert_same([errors], [np.stack([f.error for f in one_by_one])])
    np.testing.assert_array_equal(allocated, [f.allocated for f in one_by_one])
    for part in (slice(0, 7), slice(7, 8), slice(8, 8), slice(8, 60)):
        feedback = parts.observe_many(case.seen[part])
        assert_same([feedback.error], [errors[part]])
        np.testing.assert_array_equal(feedback.allocated, allocated[part])
    assert_same(state(whole), state(single))
    assert_same(state(whole), state(parts))


@EVERY_CASE
@EVERY_KIND
def test_errors_are_what_observing_would_report_and_teach_nothing(kind, case):
    calibrator, rest = kind(case.model), case.seen[40:]
    calibrator.observe_many(case.seen[:40])
    before = state(calibrator)
    errors = calibrator.errors(rest)
    np.testing.assert_allclose(errors, miss(calibrator, rest), atol=1e-12)
    assert_same(state(calibrator), before)
    np.testing.assert_array_equal(errors[0], calibrator.observe(rest[0]).error)


@EVERY_CASE
@EVERY_KIND
def test_commands_are_pure_and_one_is_as_many(kind, case):
    calibrator = kind(case.model)
    calibrator.observe_many(case.seen[:40])
    before, targets = state(calibrator), case.seen[40:].target
    together = calibrator.command(targets)
    assert together.shape == case.seen.joints[40:].shape
    np.testing.assert_array_equal(calibrator.command(targets), together)
    alone = np.stack([calibrator.command(target) for target in targets])
    np.testing.assert_allclose(alone, together, rtol=0.0, atol=1e-9)
    if not isinstance(case.seen, PointObservation):
        np.testing.assert_array_equal(alone, together)
    assert_same(state(calibrator), before)


@EVERY_CASE
def test_nominal_never_changes(case):
    nominal = Nominal(case.model)
    before = nominal.command(case.seen.target)
    first = nominal.observe_many(case.seen)
    again = nominal.observe_many(case.seen)
    np.testing.assert_array_equal(first.error, again.error)
    np.testing.assert_array_equal(nominal.command(case.seen.target), before)
    assert not first.allocated.any()


@EVERY_CASE
def test_a_fresh_network_corrects_nothing(case):
    # Section 3.4.6: the network initially has no neurons, hence the corrections are zero.
    nominal, fresh = Nominal(case.model), NetworkCorrection(case.model)
    assert fresh.network.n_neurons == 0
    np.testing.assert_array_equal(
        fresh.command(case.seen.target), nominal.command(case.seen.target)
    )
    np.testing.assert_array_equal(
        fresh.observe(case.seen[0]).error, nominal.observe(case.seen[0]).error
    )


@pytest.mark.parametrize("case", [case for case in CASES if case.exact], ids=str)
@EVERY_KIND
def test_an_exact_robot_leaves_nothing_to_learn(kind, case):
    model, seen = case.exact
    calibrator = kind(model)
    feedback = calibrator.observe_many(seen)
    assert np.abs(feedback.error).max() < 1e-7 if case.name == "planar, foveating" else 1e-13
    assert not feedback.allocated.any()
    if isinstance(calibrator, NetworkCorrection):
        assert calibrator.network.n_neurons == 0


@EVERY_CASE
def test_what_was_learned_once_is_commanded_exactly(case):
    for i in range(5):
        learner, seen = NetworkCorrection(case.model), case.noise_free[i]
        feedback = learner.observe(seen)
        assert feedback.allocated, "the robot is right here: choose another row"
        np.testing.assert_allclose(learner.command(seen.target), seen.joints, atol=1e-12)


@EVERY_CASE
def test_learning_helps_where_it_was_learned(case):
    learner = NetworkCorrection(case.model)
    learner.observe_many(case.noise_free)
    before = np.linalg.norm(Nominal(case.model).observe_many(case.noise_free).error, axis=1)
    after = np.linalg.norm(learner.observe_many(case.noise_free).error, axis=1)
    assert after.mean() < 0.5 * before.mean()


def spoilt(seen, how):
    """Fields of an observation with one that cannot be used."""
    given_ = {f.name: getattr(seen, f.name) for f in fields(seen)}
    given_ = {name: value for name, value in given_.items() if value is not None}
    name = "position" if "position" in given_ else "range"
    good = given_[name]
    bad = {
        "nan": np.full_like(good, np.nan),
        "text": np.full(np.shape(good), "1.0"),
        "longer": np.concatenate([good, good]),
        "deeper": good[np.newaxis, np.newaxis],
        "absent": None,
    }
    return type(seen)(**(given_ | {name: bad[how]}))


@EVERY_CASE
@EVERY_KIND
@pytest.mark.parametrize("how", ["nan", "text", "longer", "deeper", "absent"])
def test_refused_observations_change_nothing(kind, case, how):
    calibrator = kind(case.model)
    calibrator.observe_many(case.seen[:20])
    before = state(calibrator)
    with pytest.raises(InvalidInput):
        calibrator.observe_many(spoilt(case.seen[20:30], how))
    assert_same(state(calibrator), before)


@EVERY_CASE
def test_one_for_many_and_many_for_one_are_refused_and_change_nothing(case):
    learner = NetworkCorrection(case.model)
    learner.observe_many(case.seen[:20])
    before = state(learner)
    with pytest.raises(InvalidInput):
        learner.observe(case.seen[20:30])
    with pytest.raises(InvalidInput):
        learner.observe_many(case.seen[20])
    assert_same(state(learner), before)


@pytest.mark.parametrize("case", [c for c in CASES if c.name == "ur10"], ids=str)
@EVERY_KIND
def test_joints_of_another_arm_are_refused(kind, case):
    calibrator = kind(case.model)
    other = replace(case.seen, joints=case.seen.joints[:, :5])
    with pytest.raises(InvalidInput, match="joints must have shape"):
        calibrator.observe_many(other)
    with pytest.raises(InvalidInput, match=r"posture must have shape \(N, 6\)"):
        calibrator.command(other.target)


@EVERY_CASE
def test_the_default_network_is_the_preferred_one_over_the_models_inputs(case):
    # Section 3.5.4, with thresholds at the resolution of the model.
    network, model = NetworkCorrection(case.model).network, case.model
    assert network.n_inputs == model.features(case.seen).shape[1] == model.space.n_inputs
    assert network.n_outputs == model.needed(case.seen).shape[1]
    assert network.settings.error_threshold == model.resolution
    assert network.settings.learning_threshold == model.resolution
    np.testing.assert_array_equal(network.inputs.low, model.space.low)
    np.testing.assert_array_equal(network.inputs.high, model.space.high)
    assert network.settings.half_max_fraction == 1.2
    assert network.capacity is None


@EVERY_CASE
@given(n_inputs=st.integers(1, 8), n_outputs=st.integers(1, 4))
def test_a_network_that_does_not_fit_is_refused(case, n_inputs, n_outputs):
    network = ResourceAllocatingNetwork(n_inputs, n_outputs)
    fits = (n_inputs, n_outputs) == (case.model.space.n_inputs, case.model.n_outputs)
    if fits:
        assert NetworkCorrection(case.model, network).network is network
    else:
        with pytest.raises(InvalidInput, match=f"got {n_inputs} and {n_outputs}"):
            NetworkCorrection(case.model, network)


@EVERY_CASE
@EVERY_KIND
def test_a_name_for_reports_is_the_same_in_every_run(kind, case):
    text = repr(kind(case.model))
    assert text.startswith(f"{kind.__name__}({type(case.model).__name__}")
    assert " at 0x" not in text
