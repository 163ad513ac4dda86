from collections.abc import Mapping

import numpy as np
import pytest
from tests.thesis.made_up import LIMITS, REPLICATES

from handeye.thesis.experiment import Curve, Quantities
from handeye.thesis.records import Records, flatten
from handeye.thesis.shapes import SHAPES, Finding
from handeye.thesis.watching import FRACTIONS, TICKS

LEARNED = "catching/thesis"
PURSUITS = np.array([10.0, 100.0, 500.0, 1000.0])


def finding(claim: str, measured: Mapping[str, Quantities]) -> Finding:
    """What a predicate finds where every replicate has measured the same."""
    rows = [
        row
        for path, quantities in measured.items()
        for experiment, setting in [path.split("/")]
        for replicate in range(REPLICATES)
        for row in flatten(experiment, setting, replicate, quantities)
    ]
    return SHAPES[claim](Records(rows), LIMITS[claim])


def learned(claim: str, quantities: Quantities) -> Finding:
    return finding(claim, {LEARNED: quantities})


NEURONS = {f"{n}_neurons": v for n, v in LIMITS["ball-nets"].items() if n != "factor"}


@pytest.mark.parametrize(
    ("factor", "holds"), [(1.0, True), (2.9, True), (3.1, False), (0.35, True), (0.32, False)]
)
@pytest.mark.parametrize("name", NEURONS)
def test_networks_are_about_as_large_as_stated(name: str, factor: float, holds: bool):
    found = learned("ball-nets", {**NEURONS, name: factor * NEURONS[name]})
    assert found.holds is holds
    assert found.held == (holds,) * REPLICATES


def crossing(**changes: np.ndarray) -> dict[str, Curve]:
    """Errors that fall from three times the limit to nothing and reach it at half of the flight."""
    limits = LIMITS["crossing-prediction"]
    fall = np.interp(FRACTIONS, [0.1, limits["soon"], 1.0], [3.0, 0.99, 0.0])
    errors = {
        f"{ball}_{what}_error": limits[what] * fall
        for ball in ("light", "heavy")
        for what in ("place", "time")
    }
    return {name: Curve(FRACTIONS, values) for name, values in {**errors, **changes}.items()}


def test_the_crossing_is_predicted_well_and_better_and_better():
    found = learned("crossing-prediction", crossing())
    assert found.holds
    assert "light ball: 21.0 cm, 6.93 cm, 0 cm" in found.note
    late = np.where(FRACTIONS > 0.8, 0.08, 0.0)
    growing = np.linspace(0.01, 0.02, len(FRACTIONS))
    for name, errors in (
        ("heavy_place_error", 0.13 - 0.1 * FRACTIONS), ("light_place_error", late),
        ("light_time_error", growing),
    ):  # fmt: skip
        assert not learned("crossing-prediction", crossing(**{name: errors})).holds, name


@pytest.mark.parametrize(
    ("single", "repeated", "holds"),
    [
        ([0.2, 0.3, 0.9, 0.95], [0.5, 0.7, 0.9, 0.95], True),
        ([0.2, 0.8, 0.9, 0.95], [0.5, 0.6, 0.9, 0.95], True),
        ([0.2, 0.3, 0.5, 0.5], [0.2, 0.29, 0.9, 0.95], False),
    ],
)
def test_another_pursuit_helps_while_little_is_known(
    single: list[float], repeated: list[float], holds: bool
):
    curves = {"pursuits_caught": single, "repeated_caught": repeated}
    measured = {name: Curve(PURSUITS, np.array(caught)) for name, caught in curves.items()}
    assert learned("repeated-pursuit", measured).holds is holds


@pytest.mark.parametrize(
    ("changed", "holds"),
    [
        ({}, True), ({"rms": 0.0399}, True), ({"rms": 0.0401}, False), ({"caught": 0.9}, True),
        ({"caught": 0.899}, False), ({"early": 0.149}, True), ({"early": 0.151}, False),
        ({"early": 0.049}, False),
    ],
)  # fmt: skip
def test_a_mentor_helps_only_if_the_arm_comes_nearer_in_time_and_catches(
    changed: dict[str, float], holds: bool
):
    before = {"rms": 0.04, "caught": 0.9, "early": 0.3}
    after = {"rms": 0.02, "caught": 0.95, "early": 0.1} | changed
    measured = {
        f"{way}_{name}": value
        for way, quantities in (("pursuits", before), ("mentored", after))
        for name, value in quantities.items()
    }
    found = learned("mentor", measured)
    assert found.holds is holds
    assert found.held == (holds,) * REPLICATES


@pytest.mark.parametrize("late", ["", "bounce", "collision", "changed_arm"])
def test_surprises_come_soon(late: str):
    at = TICKS.astype(float)
    soon, slow = (np.where(at >= first, 0.96, 0.5) for first in (10.0, 11.0))
    names = ("bounce", "collision", "changed_arm")
    measured = {f"{name}_noticed": Curve(at, slow if name == late else soon) for name in names}
    found = learned("surprise", {**measured, "false_alarms": 0.25})
    assert found.holds is (late == "")
    assert "25.0 %" in found.note


@pytest.mark.parametrize(
    ("voltage", "travel", "holds"), [(0.0, 0.0, True), (1e-9, 0.0, False), (0.0, 1e-9, False)]
)
def test_before_learning_nothing_moves(voltage: float, travel: float, holds: bool):
    measured = {"fresh_voltage": voltage, "fresh_travel": travel}
    assert learned("before-learning", measured).holds is holds


@pytest.mark.parametrize(
    ("rough", "smooth", "caught", "holds"),
    [(0.2, 0.1, 0.95, True), (0.2, 0.1, 0.921, True), (0.2, 0.1, 0.919, False),
     (0.1, 0.2, 0.99, False)],
)  # fmt: skip
def test_smooth_commands_must_catch_as_well(
    rough: float, smooth: float, caught: float, holds: bool
):
    spiky = {"mean_roughness": rough, "mean_caught": 0.94}
    generated = {"mean_roughness": smooth, "mean_caught": caught}
    settings = {"catch-improved/improved": spiky, "catch-improved/smooth": generated}
    found = finding("smooth-commands", settings)
    assert found.holds is holds


SETTINGS = {
    "pid-track-06": "ball-0.6",
    "pid-track-01": "ball-0.1",
    "pid-track-0018": "ball-0.018",
}


@pytest.mark.parametrize("claim", SETTINGS)
def test_the_controller_follows_as_stated(claim: str):
    stated = {n: v for n, v in LIMITS[claim].items() if n.startswith(("light", "heavy"))}
    names = [f"{b}_{q}" for b in ("light", "heavy") for q in ("caught", "rms", "mean")]
    close = {name: stated.get(name, 0.0) for name in names}

    def judged(**changes: float) -> Finding:
        values = {**close, **changes}
        fresh = {**values, **{f"{name}_20": value for name, value in values.items()}}
        ways = ("", "exact-", "mistuned-")
        return finding(claim, {f"catch-pid/{way}{SETTINGS[claim]}": fresh for way in ways})

    assert judged().holds
    for name, value in stated.items():
        room = 0.1 if name.endswith("caught") else 0.3 * abs(value)
        for side in (-1.0, 1.0):
            assert judged(**{name: value + 0.99 * side * room}).holds, name
            assert not judged(**{name: value + 1.01 * side * room}).holds, name
