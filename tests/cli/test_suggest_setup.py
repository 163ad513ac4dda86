"""`handeye suggest` for set-ups: described, or calibrated before."""

import csv
import json
import re
from pathlib import Path

import numpy as np
import pytest
from tests.calibration.setups.fits import END, PLAIN, fitted, of_case
from tests.calibration.setups.two_arms import TwoArms, chains, described_torso
from tests.cli.running import done, refused

from handeye.calibration.setups.description import load_description
from handeye.calibration.setups.storage import save_setup

STEREO = "the stereo head"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two chains of a robot, described and calibrated."""
    place = tmp_path_factory.mktemp("suggest")
    rows = {"sees left": 30, "elbow": 20}
    setup = load_description(described_torso(place, TwoArms(0, PLAIN), rows, END))
    save_setup(place / "setup.model.safetensors", fitted(setup), setup.sizes)
    return place


def test_a_table_names_the_measurement_and_has_the_joints_that_it_needs(folder: Path):
    model, places = folder / "setup.model.safetensors", folder / "next.csv"
    shown = done("suggest", model, "-n", 8, "--out", places).stdout
    with places.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 8
    ends = {"left marker by eye": "sees left", "elbow marker by tracker": "elbow"}
    assert {row["measurement"] for row in rows} == set(ends)
    for row in rows:
        joints = {f"{name}_rad" for name in chains()[ends[row["measurement"]]].joint_names}
        assert {name for name, cell in row.items() if cell} == {"measurement", *joints}
    # Of the elbow the first joint lifts, in millimetres.
    elbow = next(row for row in rows if row["measurement"].startswith("elbow"))
    assert f"{1e3 * float(elbow['lift_rad']):.1f}" in shown
    assert f"{np.degrees(float(elbow['left_1_rad'])):.1f}" in shown
    for words in ("to link [°, mm]", "[px]", "[mm]", "now", "left marker by eye"):
        assert words in shown, words


def test_a_description_is_fitted_and_says_the_same(folder: Path):
    shown = done("suggest", "--setup", folder / "setup.yaml", "-n", 2).stdout
    model = folder / "setup.model.safetensors"
    assert shown == done("suggest", model, "-n", 2).stdout


def test_every_key_is_documented_and_every_documented_key_is_there(
    tmp_path: Path, repository: Path
):
    setup, fit = of_case(STEREO, tmp_path)
    save_setup(tmp_path / "m.safetensors", fit, setup.sizes)
    places = tmp_path / "next.csv"
    model = tmp_path / "m.safetensors"
    data = json.loads(done("suggest", model, "-n", 2, "--out", places, "--json", "-").stdout)
    text = (repository / "docs" / "reference" / "json.md").read_text(encoding="utf-8")
    part = text[text.index("Of a set-up `handeye suggest --json`") :].split("\n\n")[0]
    assert set(re.findall(r"`(\w+)`", part)) == {*data, *data["suggestions"][0]}
    assert data["units"] == {"range": "m", "eccentricity": "rad"}
    with places.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for row, one in zip(rows, data["suggestions"], strict=True):
        assert float(row["pointing_rad"]) == one["pointing"]
        assert [float(row[f"{name}_rad"]) for name in one["joint_names"]] == one["joints"]
        assert one["uncertainty_after"]["range"] < data["uncertainty_before"]["range"]
    assert "pan axis" in done("suggest", model, "-n", 1).stdout


def test_what_is_left_out_is_told(tmp_path: Path):
    setup, fit = of_case("a draw-wire and a ball bar", tmp_path)
    save_setup(tmp_path / "m.safetensors", fit, setup.sizes)
    shown = done("suggest", tmp_path / "m.safetensors", "-n", 1).stdout
    assert "left out  bar: its distance is always the same" in shown


def test_what_does_not_go_together_is_refused(folder: Path):
    model, setup = folder / "setup.model.safetensors", folder / "setup.yaml"
    assert "give a model or a log, or else --setup" in refused("suggest")
    assert "give a model or a log, or else --setup" in refused("suggest", model, "--setup", setup)
    assert "knows its robot: leave out --robot" in refused("suggest", model, "--tip", "base")
    assert "--tip and --eye go with --robot" in refused("suggest", "--setup", setup, "--tip", "a")
    assert "no such file" in refused("suggest", folder / "none.safetensors")
    assert "none.yaml" in refused("suggest", "--setup", folder / "none.yaml")
    said = refused("suggest", model, "--near", 50)
    assert "none of 10000 poses tried is in view" in said
    assert "leave out facing" in refused("suggest", model, "--facing", 60)
