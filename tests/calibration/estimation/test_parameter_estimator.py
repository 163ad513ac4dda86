"""The estimator as a calibrator: what it promises, what it reaches, what it refuses."""

import inspect
from typing import Any

import numpy as np
import pytest
from tests.calibration import test_calibrators as promises
from tests.calibration.cases import Case
from tests.calibration.cases import sightings as world_sightings
from tests.calibration.estimation.estimators import (
    CLEAN,
    EVERY_METHOD,
    MODEL,
    PLANAR,
    arrays,
    assert_same,
    learned,
)

from handeye.calibration.calibrators import NetworkCorrection, Nominal
from handeye.calibration.drift import Thermal
from handeye.calibration.estimation import (
    NAMES,
    ParameterEstimator,
    Recursive,
    Refit,
)
from handeye.calibration.estimation.parameters import vector
from handeye.calibration.models import PlanarMap, PlanarModel
from handeye.calibration.world import PlanarWorld
from handeye.errors import InvalidInput
from handeye.thesis.plants import NOMINAL, NORMAL

# ------------------------------------------------- what every calibrator promises


@EVERY_METHOD
@pytest.mark.parametrize("case", PLANAR, ids=str)
@pytest.mark.parametrize(
    "promise",
    [
        promises.test_observing_reports_the_error_made_before_learning,
        promises.test_many_at_once_is_one_by_one_in_any_parts,
        promises.test_errors_are_what_observing_would_report_and_teach_nothing,
        promises.test_commands_are_pure_and_one_is_as_many,
    ],
)
def test_it_promises_what_every_calibrator_does(promise: Any, method, case: Case, monkeypatch):
    monkeypatch.setattr(promises, "state", arrays)
    promise(kind=lambda model: ParameterEstimator(model, method), case=case)


@EVERY_METHOD
@pytest.mark.parametrize("case", PLANAR, ids=str)
def test_observations_of_the_wrong_kind_are_refused_and_change_nothing(method, case):
    estimator = ParameterEstimator(case.model, method)
    estimator.observe_many(case.seen[:20])
    before = [a.copy() for a in arrays(estimator)]
    with pytest.raises(InvalidInput):
        estimator.observe(case.seen[20:30])
    with pytest.raises(InvalidInput, match="leading axis"):
        estimator.observe_many(case.seen[20])
    assert_same(arrays(estimator), before)


def test_it_has_the_methods_of_a_calibrator():
    for name in ("observe", "observe_many", "command"):
        ours = inspect.signature(getattr(ParameterEstimator, name)).parameters
        theirs = inspect.signature(getattr(NetworkCorrection, name)).parameters
        assert list(ours) == list(theirs)


@EVERY_METHOD
def test_a_fresh_estimator_commands_like_the_nominal_model(method):
    seen = world_sightings(NORMAL, 20)
    fresh, nominal = ParameterEstimator(MODEL, method), Nominal(MODEL)
    np.testing.assert_allclose(
        fresh.command(seen.target), nominal.command(seen.target), rtol=0.0, atol=1e-14
    )
    np.testing.assert_allclose(
        fresh.observe(seen[0]).error, nominal.observe(seen[0]).error, rtol=0.0, atol=1e-13
    )
    assert not fresh.observe_many(seen).allocated.any()


@EVERY_METHOD
def test_commands_are_those_of_the_estimated_plant(method):
    seen = world_sightings(NORMAL, 30)
    estimator = ParameterEstimator(MODEL, method)
    estimator.observe_many(seen)
    np.testing.assert_array_equal(
        estimator.command(seen.target), estimator.plant.joints_for(seen.target)
    )
    np.testing.assert_array_equal(vector(estimator.plant), estimator.parameters)
    assert MODEL.nominal == NOMINAL


def test_its_name_says_method_and_changes():
    assert repr(ParameterEstimator(MODEL)) == "ParameterEstimator(Recursive, nominal)"
    estimator = learned(Refit("forward"), PlanarWorld(CLEAN), 10)
    assert repr(estimator).startswith("ParameterEstimator(Refit, a +0.005, b +0.003, v_x -0.01")


# ------------------------------------------------- section 3.4.6: exact kinematics


def test_with_exact_kinematics_a_threshold_keeps_the_parameters_exactly_nominal():
    seen = world_sightings(NOMINAL.without_noise(), 200)
    for objective in ("forward", "reverse", "residuals"):
        estimator = ParameterEstimator(MODEL, Refit(objective))
        estimator.observe_many(seen)
        np.testing.assert_array_equal(estimator.parameters, vector(NOMINAL))
        assert estimator.last_fit is None, "a solve was called for"


@pytest.mark.parametrize("objective", ["forward", "reverse", "residuals"])
def test_with_exact_kinematics_and_threshold_zero_they_stay_within_1e_minus_11(objective):
    seen = world_sightings(NOMINAL.without_noise(), 60)
    estimator = ParameterEstimator(MODEL, Refit(objective, error_threshold=0.0))
    estimator.observe_many(seen)
    assert estimator.last_fit is not None
    assert estimator.last_fit.solution.converged
    np.testing.assert_allclose(estimator.parameters, vector(NOMINAL), rtol=0.0, atol=1e-11)


def test_the_recursion_leaves_an_exact_robot_alone():
    estimator = ParameterEstimator(MODEL)
    estimator.observe_many(world_sightings(NOMINAL.without_noise(), 200))
    np.testing.assert_allclose(estimator.parameters, vector(NOMINAL), rtol=0.0, atol=1e-11)


def test_a_solve_comes_when_the_error_reaches_the_threshold_and_rows_suffice():
    seen = world_sightings(CLEAN, 12)
    estimator = ParameterEstimator(MODEL, Refit("forward", error_threshold=1e-6))
    solves: list[bool] = []
    for one in seen:
        before = estimator.last_fit
        error = np.linalg.norm(estimator.observe(one).error)
        solved = estimator.last_fit is not before
        assert solved == (error >= 1e-6 and len(solves) >= 5)
        solves.append(solved)
    assert solves[:6] == [False] * 5 + [True]
    assert not solves[-1]


def test_a_window_keeps_the_latest_sightings():
    seen = world_sightings(CLEAN, 20)
    estimator = ParameterEstimator(MODEL, Refit("forward", window=7))
    estimator.observe_many(seen)
    (rows, _) = arrays(estimator)
    np.testing.assert_array_equal(rows[:, :2], seen.joints[-7:])
    everything = ParameterEstimator(MODEL, Refit("forward"))
    everything.observe_many(seen)
    assert len(arrays(everything)[0]) == 20


# ------------------------------------------------- misuse


def test_models_without_these_parameters_are_refused():
    wrong: Any = PlanarMap(NOMINAL)
    with pytest.raises(InvalidInput, match="NetworkCorrection"):
        ParameterEstimator(wrong)
    drifting = PlanarModel(Thermal(100)(NOMINAL, np.arange(5)))
    with pytest.raises(InvalidInput, match="changes from trial to trial"):
        ParameterEstimator(drifting)


WRONG: Any = {
    "drift 1": (Recursive, {"drift": 1.0}),
    "drift < 0": (Recursive, {"drift": -0.1}),
    "drift nan": (Recursive, {"drift": np.nan}),
    "threshold": (Refit, {"objective": "forward", "error_threshold": -1.0}),
    "few rows": (Refit, {"objective": "forward", "window": 5}),
    "no rows": (Refit, {"objective": "residuals", "window": 0}),
    "objective": (Refit, {"objective": "sideways"}),
}


@pytest.mark.parametrize(("kind", "settings"), WRONG.values(), ids=WRONG.keys())
def test_settings_that_make_no_sense_raise(kind, settings):
    with pytest.raises(InvalidInput):
        kind(**settings)


def test_parameters_handed_out_are_a_copy():
    estimator = ParameterEstimator(MODEL, Refit("forward"))
    estimator.parameters[0] = 7.0
    np.testing.assert_array_equal(estimator.parameters, vector(NOMINAL))
    assert len(NAMES) == len(estimator.parameters)
