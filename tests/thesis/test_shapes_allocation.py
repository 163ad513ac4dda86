import numpy as np
import pytest
from tests.thesis.made_up import MARKS, curves, judged

from handeye.arrays import Array
from handeye.thesis.shapes.allocation import EQUATIONS, FAST, GAUSSIAN, distances, error_at
from handeye.thesis.shapes.comparing import clearly_below, growth, plateau, spread

TRIALS = np.array(MARKS)
SHARES = {e: 0.95 - 0.05 * i for i, e in enumerate(EQUATIONS)}
"""The part of the trials on which each schedule adds a neuron."""


def schedules(noise: str, factors: dict[str, float] | None = None) -> dict[str, object]:
    """Errors that fall with the number of neurons alone, times a factor for each schedule."""
    made: dict[str, object] = {}
    for equation in EQUATIONS:
        neurons = np.round(SHARES[equation] * TRIALS)
        factor = (factors or {}).get(equation, 1.0)
        made[f"allocation/{noise}/{equation}-neurons"] = neurons
        made[f"allocation/{noise}/{equation}-error"] = factor * 0.1 / np.sqrt(neurons + 5.0)
    return made


def test_error_at_a_number_of_neurons_that_marks_found_or_lie_around():
    records = curves(schedules("noisy"))
    neurons = records.curve("allocation/noisy/3.54-neurons")[1]
    errors = records.curve("allocation/noisy/3.54-error")[1]
    found = error_at(records, "allocation/noisy/3.54", neurons[0, [3, 30]])
    np.testing.assert_allclose(found[0], errors[0, [3, 30]])
    between = error_at(
        records, "allocation/noisy/3.54", np.array([np.sqrt(neurons[0, 3:5].prod())])
    )
    np.testing.assert_allclose(between[0, 0], np.sqrt(errors[0, 3:5].prod()))
    assert np.all(np.isnan(error_at(records, "allocation/noisy/3.54", np.array([1.0, 1e6]))))


def test_marks_that_found_the_same_number_count_together():
    neurons = np.where(TRIALS < 2500.0, 0.0, 100.0)
    errors = np.where(np.arange(len(TRIALS)) % 2, 0.01, 0.04)
    records = curves({"allocation/x/y-neurons": neurons, "allocation/x/y-error": errors})
    found = error_at(records, "allocation/x/y", np.array([100.0]))[0, 0]
    np.testing.assert_allclose(found, 0.02, rtol=0.03)


def test_schedules_on_one_curve_are_no_distance_apart():
    assert np.all(distances(curves(schedules("noisy")), "noisy", 100.0) < 1e-3)


def test_two_families_of_schedules_are_apart_by_half_their_ratio():
    factors = {e: 1.0 if i % 2 else 1.5 for i, e in enumerate(EQUATIONS)}
    apart = distances(curves(schedules("noisy", factors)), "noisy", 100.0)
    np.testing.assert_allclose(apart, 0.5 * np.log(1.5), rtol=0.02)


@pytest.mark.parametrize(("ratio", "holds"), [(1.0, True), (1.15, True), (1.5, False)])
def test_one_curve_with_noise(ratio: float, holds: bool):
    factors = {e: 1.0 if i % 2 else ratio for i, e in enumerate(EQUATIONS)}
    found = judged(
        "alloc-noisy-collapse", schedules("noisy", factors) | schedules("clean", factors)
    )
    assert found.holds is holds
    assert found.held == (holds,) * 4


@pytest.mark.parametrize(
    ("factors", "holds"),
    [
        ({GAUSSIAN: 0.8}, True),
        ({GAUSSIAN: 0.8, "3.56": 0.75}, False),
        ({GAUSSIAN: 1.2}, False),
        ({}, False),
    ],
)
def test_the_gaussian_schedule_gets_most_out_of_its_neurons(factors: dict[str, float], holds: bool):
    found = judged("alloc-clean-efficiency", schedules("noisy") | schedules("clean", factors))
    assert found.holds is holds


def test_schedules_that_differ_more_with_noise_are_not_told_apart_by_efficiency():
    wild = {e: 1.0 if i % 2 else 2.0 for i, e in enumerate(EQUATIONS)}
    made = schedules("noisy", wild) | schedules("clean", {GAUSSIAN: 0.8})
    assert not judged("alloc-clean-efficiency", made).holds


@pytest.mark.parametrize(
    ("change", "holds"),
    [
        ({}, True),
        ({"3.55": 0.0103}, True),
        ({"3.55": 0.0107}, False),
        ({"3.56": 0.0099}, False),
        ({"3.47": 0.0131}, False),
    ],
)
def test_five_schedules_are_fastest_and_alike(change: dict[str, float], holds: bool):
    levels = {e: 0.010 if e in FAST else 0.013 for e in EQUATIONS} | change
    found = judged("alloc-fast-five", {f"allocation/noisy/{e}-error": v for e, v in levels.items()})
    assert found.holds is holds
    assert found.held == (holds,) * 4


GRIDS = {
    "random-clean": 0.0060,
    "variable-clean": 0.0065,
    "fixed-clean": 0.0090,
    "random-noisy": 0.0120,
    "variable-noisy": 0.0120,
    "fixed-noisy": 0.0135,
}


@pytest.mark.parametrize(
    ("change", "holds"),
    [
        ({}, True),
        ({"variable-clean": 0.0059}, False),
        ({"variable-clean": 0.0085}, False),
        ({"fixed-clean": 0.0060}, False),
        ({"fixed-noisy": 0.0139}, False),
        ({"random-noisy": 0.0100}, False),
    ],
)
def test_random_placement_beats_grids_only_without_noise(change: dict[str, float], holds: bool):
    levels = GRIDS | change
    made = {f"grids/{name}{h}/error": v for name, v in levels.items() for h in ("", "-h-0.8")}
    found = judged("alloc-grid", made | {"grids/variable-clean/on_grid": 567.0})
    assert found.holds is holds
    assert found.held == (holds,) * 4
    assert "568 neurons" in found.note  # the mean of made-up replicates


def ramp(start: float, end: float) -> Array:
    return np.linspace(start, end, len(MARKS))


def test_plateau_is_the_mean_of_the_last_ten_marks_and_growth_is_over_the_lowest():
    records = curves({"x/y/z": ramp(0.0, 50.0)})
    np.testing.assert_allclose(plateau(records, "x/y/z")[0], 45.5)
    np.testing.assert_allclose(growth(records, "x/y/z"), 45.5)


@pytest.mark.parametrize(
    ("low", "high", "clear"),
    [
        ([1.0, 2.0, 3.0], [1.1, 2.1, 3.12], True),
        ([1.1, 2.1, 3.2], [1.0, 2.0, 3.0], False),
        ([1.0, 2.0, 3.0], [1.1, 2.1, 2.9], False),
        ([1.0], [1.1], True),
        ([1.0], [1.0], False),
    ],
)
def test_clearly_below_pairs_replicates(low: list[float], high: list[float], clear: bool):
    assert clearly_below(np.array(low), np.array(high)) is clear


def test_spread_of_means_and_in_each_replicate():
    apart, each = spread([np.array([1.0, 2.0]), np.array([2.0, 2.0])])
    assert apart == pytest.approx(1.0 / 3.0)
    np.testing.assert_allclose(each, [1.0, 0.0])
