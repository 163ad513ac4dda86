"""What `handeye calibrate` and `handeye suggest` write, key by key and file by file."""

import csv
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.cli.running import done, refused

from handeye.calibration import load_model
from handeye.cli.console import check_places
from handeye.errors import InvalidInput
from handeye.io.logs import read_log


@pytest.fixture(scope="module")
def slipped(tmp_path_factory) -> Path:
    """A log of 200 rows, with a slip at row 102, and its shuffled copy."""
    path = tmp_path_factory.mktemp("slipped") / "work.csv"
    done("simulate", path, "--rows", 200, "--slip", 2)
    header, *rows = path.read_text().splitlines()
    np.random.default_rng(0).shuffle(rows)
    path.with_name("shuffled.csv").write_text("\n".join([header, *rows]) + "\n")
    return path


@pytest.fixture(scope="module")
def data(slipped, tmp_path_factory) -> dict[str, Any]:
    out = tmp_path_factory.mktemp("out")
    return json.loads(
        done("calibrate", slipped, "--robot", "planar", "--out", out, "--json", "-").stdout
    )


def documented(repository: Path, section: int) -> set[str]:
    """The keys that a part of docs/reference/json.md names."""
    text = (repository / "docs" / "reference" / "json.md").read_text()
    if section == 0:
        firsts = re.findall(r"^\| (`.*?) \|", text, re.MULTILINE)
        return {key for first in firsts for key in re.findall(r"`(\w+)`", first)}
    part = text[text.index(f"`handeye {['', 'hand-eye', 'suggest'][section]} --json`") :]
    return set(re.findall(r"`(\w+)`", part.split("\n\n")[0]))


def test_every_key_is_documented_and_every_documented_key_is_there(data, repository):
    optional = {"urdf", "joints", "recording"}
    assert documented(repository, 0) - optional == set(data)


def test_errors_are_those_of_rows_that_fit_the_robot_as_it_is(data):
    assert data["status"] == "improved"
    assert data["judged_by"] == "held_out"
    assert 102 <= data["changed_at_row"] <= 105
    assert f"row {data['changed_at_row']}" in data["advice"]
    for key in ("error_before", "error_after"):
        errors = data[key]
        assert errors["n"] == 200 - (data["changed_at_row"] - 2)
        low, high = errors["interval"]
        assert low < errors["mean"] < high
        assert errors["mean"] <= errors["rms"] <= errors["max"]
        assert errors["p95"] <= errors["max"]
    assert data["error_after"]["mean"] < 0.4 * data["error_before"]["mean"]
    assert data["orientation_after"] is None
    assert len(data["validation"]["moves"]) == 5
    assert data["validation"]["row"] == list(range(data["changed_at_row"], 202))


def test_parameters_parts_and_rows_are_listed(data):
    names = [p["name"] for p in data["parameters"]]
    assert names[:2] == ["a", "b"]
    assert all(p["std"] > 0.0 for p in data["parameters"])
    moves = [part["moves"] for part in data["parts"]]
    assert moves == sorted(moves, reverse=True)
    rows = data["influence"]
    assert rows["row"] == list(range(2, 202))
    assert rows["residual"][0] is None  # before the change
    assert sum(rows["left_out"]) < 10


def test_a_shuffled_file_gives_the_same_result(slipped, data, tmp_path):
    other = slipped.with_name("shuffled.csv")
    out = ("--robot", "planar", "--out", tmp_path, "--json", "-")
    shuffled = json.loads(done("calibrate", other, *out).stdout)
    for key in ("errors", "error_after", "parameters", "parts", "findings", "status"):
        assert shuffled[key] == data[key]
    # Rows are those of each file.
    assert sorted(shuffled["influence"]["row"]) == data["influence"]["row"]
    assert shuffled["influence"]["row"] != data["influence"]["row"]


def test_the_ways_to_validate(slipped, tmp_path):
    out = ("--robot", "planar", "--method", "nominal", "--out", tmp_path, "--json", "-")
    none = json.loads(done("calibrate", slipped, *out, "--validate", "none").stdout)
    assert none["validation"] is None
    assert none["judged_by"] == "online"
    assert none["status"] == "unchanged"
    drawn = [
        json.loads(done("calibrate", slipped, *out, "--validate", "random", *more).stdout)
        for more in ((), ("--replicate", 1))
    ]
    assert all(len(d["validation"]["row"]) == 66 for d in drawn)
    assert drawn[0]["validation"]["row"] != drawn[1]["validation"]["row"]


def test_places_are_checked_before_any_work(slipped, tmp_path):
    calibrate = ("calibrate", slipped, "--robot", "planar", "--out", tmp_path / "new")
    message = refused(*calibrate, "--json", tmp_path / "absent" / "r.json")
    assert f"there is no folder {tmp_path / 'absent'}" in message
    assert "is a folder" in refused(*calibrate, "--json", tmp_path)
    (tmp_path / "file").write_text("")
    with pytest.raises(InvalidInput, match="cannot be read or written"):
        check_places(tmp_path / "file" / "deep" / "deeper")
    for option in ("--urdf", "--joints-yaml"):
        assert "there is no folder" in refused(*calibrate, option, tmp_path / "absent" / "x")
        assert "method combined" in refused(*calibrate, option, tmp_path / "x")
    # Nothing was made.
    assert sorted(path.name for path in tmp_path.iterdir()) == ["file"]


def test_poses_are_suggested_from_a_model_and_from_a_log(slipped, tmp_path, repository):
    done("calibrate", slipped, "--robot", "planar", "--validate", "none", "--out", tmp_path)
    model = tmp_path / "work.model.safetensors"
    out = ("-n", 2, "--json", "-")
    found = json.loads(done("suggest", model, *out).stdout)
    assert set(found) == documented(repository, 2)
    assert found["joint_names"] == ["alpha", "beta"]
    assert np.shape(found["joints"]) == (2, 2)
    assert (
        found["uncertainty_before"] > found["uncertainty_after"][0] > found["uncertainty_after"][1]
    )
    assert json.loads(done("suggest", slipped, "--robot", "planar", *out).stdout) == found
    shown = done("suggest", model, "-n", 2, "--out", tmp_path / "poses.csv").stdout
    assert "the hand is now known to" in shown
    with (tmp_path / "poses.csv").open(newline="") as file:
        header, *rows = list(csv.reader(file))
    assert header == ["alpha_rad", "beta_rad"]
    np.testing.assert_array_equal(np.array(rows, dtype=float), found["joints"])


def test_suggestions_that_cannot_be_made_are_explained(slipped, tmp_path):
    assert "needs --robot" in refused("suggest", slipped)
    out = ("--robot", "planar", "--method", "nominal", "--validate", "none", "--out", tmp_path)
    done("calibrate", slipped, *out)
    model = tmp_path / "work.model.safetensors"
    assert "Nominal does not know how certain it is" in refused("suggest", model)
    place = ("--out", tmp_path / "absent" / "poses.csv")
    assert "there is no folder" in refused("suggest", model, *place)
    assert load_model(model).observed == 200


def test_another_arm_is_simulated_as_a_log_and_as_a_recording(tmp_path):
    pytest.importorskip("pinocchio")
    pytest.importorskip("mcap")
    done("simulate", tmp_path / "run.csv", "--robot", "ur10", "--rows", 30)
    log: Any = read_log(tmp_path / "run.csv").log
    assert len(log) == 30
    done("simulate", tmp_path / "run.mcap", "--robot", "ur10", "--rows", 30)
    done("convert", tmp_path / "run.mcap", tmp_path / "back.csv", "--delay", 0.04)
    back: Any = read_log(tmp_path / "back.csv").log
    assert set(back.joint_names) == set(log.joint_names)
    order = [back.joint_names.index(name) for name in log.joint_names]
    # Joints are interpolated between recorded states, 40 ms before the camera's stamps.
    joints = back.observations.joints[:, order]
    np.testing.assert_allclose(joints, log.observations.joints, atol=1e-4)
    np.testing.assert_array_equal(back.observations.position, log.observations.position)
    out = ("--robot", "ur10", "--method", "nominal", "--out", tmp_path, "--json", "-")
    data = json.loads(done("calibrate", tmp_path / "run.csv", *out).stdout)
    # An arm with errors of ordinary size: millimetres.
    assert 0.2e-3 < data["error_before"]["mean"] < 20e-3
    assert "only rows" in refused("simulate", tmp_path / "x.csv", "--robot", "ur10", "--slip", 1)
    assert "--robot" in refused("simulate", tmp_path / "x.mcap")
