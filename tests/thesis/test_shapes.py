import pytest

from handeye.thesis.claims import load_claims
from handeye.thesis.records import Record, Records
from handeye.thesis.shapes import SHAPES, Finding, in_every_replicate

LIMITS = {claim.id: claim.limits for claim in load_claims()}


def finding(claim: str, path: str, *replicates: dict[str, float]) -> Finding:
    """The predicate of a claim over made-up quantities."""
    experiment, setting = path.split("/")
    rows = [
        Record(experiment, setting, i, name, None, value)
        for i, quantities in enumerate(replicates)
        for name, value in quantities.items()
    ]
    return SHAPES[claim](Records(rows), LIMITS[claim])


SIZES = {"alpha": 0.008, "beta": 0.009, "gamma": 0.0119, "eccentricity": 0.01, "range": 0.02}


@pytest.mark.parametrize(
    ("change", "holds"),
    [
        ({}, True),
        ({"gamma": 0.0121}, False),
        ({"alpha": 0.0121}, False),
        ({"beta": 0.0121}, False),
        ({"eccentricity": 0.0121}, False),
        ({"range": 0.0239}, True),
        ({"range": 0.0241}, False),
        ({"range": 0.0159}, False),
    ],
)
def test_perturbations_are_about_as_large_as_stated(change: dict[str, float], holds: bool):
    found = finding("plant-perturbation-size", "perturbations/normal", SIZES | change)
    assert found.holds is holds
    assert found.held == (holds,)


def test_perturbation_note_gives_the_sizes():
    note = finding("plant-perturbation-size", "perturbations/normal", SIZES).note
    assert "gamma 11.9 mm" in note
    assert "range at 3 m: 20.0 mm" in note


@pytest.mark.parametrize(
    ("radius", "area", "holds"),
    [(0.019, 0.029, True), (0.02, 0.029, False), (0.019, 0.03, False)],
)
def test_excluded_region_costs_less_than_stated(radius: float, area: float, holds: bool):
    lost = {"radius": radius, "area": area}
    assert finding("plant-excluded-region", "excluded-region/nominal", lost).holds is holds


@pytest.mark.parametrize(
    ("change", "held"),
    [
        ({}, True),
        ({"neurons": 1.0}, False),
        ({"largest_error": 2e-11}, False),
        ({"change": 1e-16}, False),
        ({"change_without_threshold": 1e-12}, True),
        ({"change_without_threshold": 2e-11}, False),
    ],
)
def test_exact_plant_needs_no_neuron_and_no_correction(change: dict[str, float], held: bool):
    names = ("neurons", "largest_error", "change", "change_without_threshold")
    fine: dict[str, float] = dict.fromkeys(names, 0.0)
    found = finding("exact-plant-stays-empty", "exact/clean", fine, fine | change)
    assert found.held == (True, held)
    assert found.holds is held


def test_what_was_never_tried_does_not_hold():
    assert not in_every_replicate((), "").holds
