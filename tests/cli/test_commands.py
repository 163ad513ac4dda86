"""The commands as a user meets them: from a log to joint commands, and what goes wrong."""

import csv
import json
import math
import sys
from pathlib import Path

import numpy as np
import pytest
from tests.cli.running import done, refused

from handeye.calibration import load_model
from handeye.io.logs import read_log
from handeye.io.targets import read_stereo_targets
from handeye.observations import StereoObservation

Rows = list[list[str]]


def rows_of(path: Path) -> Rows:
    with path.open(newline="") as file:
        return list(csv.reader(file))


def write(path: Path, rows: Rows) -> Path:
    with path.open("w", newline="") as file:
        csv.writer(file).writerows(rows)
    return path


@pytest.fixture
def log(tmp_path: Path) -> Path:
    path = tmp_path / "work.csv"
    done("simulate", path, "--rows", 300)
    return path


def test_a_log_becomes_a_model_a_page_and_commands(log: Path, tmp_path: Path):
    folder = tmp_path / "calibrated"
    result = done("calibrate", log, "--robot", "planar", "--out", folder)
    assert "position error of the hand in mm" in result.stdout
    page = (folder / "work.html").read_text()
    assert "<svg" in page
    model = folder / "work.model.safetensors"
    assert load_model(model).observed == 300

    targets = write(
        tmp_path / "targets.csv",
        [["pointing_rad", "range_m", "eccentricity_rad", "elbow"], ["0.1", "1.9", "0.05", "-1"]],
    )
    printed = done("apply", model, targets).stdout
    done("apply", model, targets, "--out", tmp_path / "commands.csv")
    assert (tmp_path / "commands.csv").read_text() == printed
    header, values = list(csv.reader(printed.splitlines()))
    assert header == ["alpha_rad", "beta_rad"]
    expected = load_model(model).calibrator.command(read_stereo_targets(targets))[0]
    np.testing.assert_array_equal([float(v) for v in values], expected)


def test_json_has_every_number_and_nothing_else_is_printed(log: Path, tmp_path: Path):
    printed = done("calibrate", log, "--robot", "planar", "--out", tmp_path, "--json", "-").stdout
    data = json.loads(printed)
    assert data["robot"] == "planar"
    assert data["n_observations"] == 300
    for stage, n in (("before", 300), ("online", 300), ("held_out_before", 300)):
        errors = data["errors"][stage]
        assert errors["n"] == n
        assert 0.0 < errors["mean"] <= errors["rms"] <= errors["max"]
    done("calibrate", log, "--robot", "planar", "--out", tmp_path, "--json", tmp_path / "r.json")
    assert json.loads((tmp_path / "r.json").read_text())["errors"] == data["errors"]


def test_learning_helps_and_nominal_does_not_learn(tmp_path: Path):
    path = tmp_path / "clean.csv"
    done("simulate", path, "--rows", 1500, "--no-noise")
    for method, better in (("network", True), ("estimator", True), ("nominal", False)):
        out = ("--out", tmp_path, "--json", "-")
        data = json.loads(
            done("calibrate", path, "--robot", "planar", "--method", method, *out).stdout
        )
        errors = data["errors"]
        assert (
            errors["held_out_after"]["mean"] < 0.6 * errors["held_out_before"]["mean"]
        ) == better


def test_simulated_errors_are_the_ones_asked_for(tmp_path: Path):
    def seen(*options: object) -> StereoObservation:
        done("simulate", tmp_path / "log.csv", "--rows", 60, *options)
        observations = read_log(tmp_path / "log.csv").log.observations
        assert isinstance(observations, StereoObservation)
        return observations

    plain = seen()
    np.testing.assert_array_equal(seen().joints, plain.joints)
    assert not np.array_equal(seen("--replicate", 1).joints, plain.joints)
    clean, half = seen("--no-noise"), seen("--no-noise", "--range-scale", 0.5)
    assert np.all(half.range < 0.6 * clean.range)
    assert np.all(np.abs(seen("--foveate").eccentricity) < 1e-6)
    slipped = seen("--no-noise", "--slip", 2)
    np.testing.assert_array_equal(slipped.range[:30], clean.range[:30])
    assert np.all(slipped.range[30:] != clean.range[30:])
    assert np.any(seen("--no-noise", "--thermal-period", 20).range != clean.range)


def test_demo_writes_its_page_and_the_model(tmp_path: Path):
    result = done("demo", "--out", tmp_path, "--trials", 200, "--still", tmp_path / "still.png")
    assert "bent by 2 degrees" in result.stdout
    assert str(tmp_path / "demo.html") in result.stdout
    assert "<svg" in (tmp_path / "demo.html").read_text()
    assert (tmp_path / "still.png").read_bytes().startswith(b"\x89PNG")
    assert load_model(tmp_path / "demo.model.safetensors").observed == 400


def test_the_ur10_log_end_to_end(shared_data: Path, tmp_path: Path):
    pytest.importorskip("pinocchio")
    source = shared_data / "ur10_joint_configurations" / "measurements_joint_configurations.csv"
    done("convert", source, tmp_path / "ur10.csv")
    out = ("--robot", "ur10", "--out", tmp_path, "--json", "-")
    network = done("calibrate", tmp_path / "ur10.csv", "--method", "network", *out)
    data = json.loads(network.stdout)
    errors = data["errors"]
    assert data["n_observations"] == 1495
    assert errors["held_out_before"]["mean"] == pytest.approx(1.04e-3, abs=0.05e-3)
    assert errors["held_out_after"]["mean"] < 0.6e-3
    assert errors["online"]["mean"] < 0.45e-3

    rows = rows_of(tmp_path / "ur10.csv")
    part = write(tmp_path / "part.csv", rows[:201])
    combined = json.loads(done("calibrate", part, "--validate", "random", *out).stdout)
    assert combined["method"] == "combined"
    errors = combined["errors"]
    assert errors["held_out_after"]["mean"] < 0.5 * errors["held_out_before"]["mean"]

    targets = write(tmp_path / "targets.csv", [rows[0], *rows[2:12]])
    model = tmp_path / "ur10.model.safetensors"
    done("apply", model, targets, "--out", tmp_path / "commands.csv")
    commands = np.array(rows_of(tmp_path / "commands.csv")[1:], dtype=float)
    # The targets are poses that were measured: the arm was there with nearly these joints.
    np.testing.assert_allclose(commands, np.array(rows[2:12])[:, 1:7].astype(float), atol=0.02)


@pytest.mark.parametrize(
    ("damage", "said"),
    [
        (lambda rows: [r[:-1] for r in rows], "missing columns: eccentricity_rad"),
        (
            lambda rows: (
                [rows[0]]
                + [[r[0], *(str(math.degrees(float(c))) for c in r[1:4]), *r[4:]] for r in rows[1:]]
            ),
            "degrees",
        ),
        (
            lambda rows: [rows[0]] + [[*r[:4], str(1000 * float(r[4])), r[5]] for r in rows[1:]],
            "millimetres",
        ),
        (lambda rows: rows[:6], "at least 9"),
        (lambda rows: rows[:1], "no rows"),
    ],
    ids=["column missing", "degrees", "millimetres", "few rows", "no rows"],
)
def test_a_log_that_cannot_be_right_is_refused(log: Path, tmp_path: Path, damage, said: str):
    bad = write(tmp_path / "bad.csv", damage(rows_of(log)))
    folder = tmp_path / "nothing"
    message = refused("calibrate", bad, "--robot", "planar", "--out", folder)
    assert "bad.csv" in message
    assert said in message
    assert not folder.exists()


def test_bad_rows_stop_the_run_or_are_listed(log: Path, tmp_path: Path):
    rows = rows_of(log)
    rows[4][2], rows[8][0] = "nan", rows[7][0]
    bad = write(tmp_path / "bad.csv", rows)
    message = refused("calibrate", bad, "--robot", "planar", "--out", tmp_path)
    assert "row 5" in message
    assert "row 9" in message
    assert "--skip-bad" in message
    out = ("--out", tmp_path, "--skip-bad")
    shown = done("calibrate", bad, "--robot", "planar", *out).stdout
    assert "rejected  2 rows" in shown
    data = json.loads(done("calibrate", bad, "--robot", "planar", *out, "--json", "-").stdout)
    assert (data["n_observations"], data["n_rejected"]) == (298, 2)
    assert "row 5" in data["rejected"][0]


def test_misuse_is_explained(log: Path, tmp_path: Path):
    out = ("--out", tmp_path / "out")
    assert "no such" in refused("apply", tmp_path / "absent", log)
    assert "not stored by handeye" in refused("apply", log, log)
    assert "cannot be read" in refused("calibrate", tmp_path / "no.csv", "--robot", "planar", *out)
    assert "ur10" in refused("calibrate", log, "--robot", "ur1o", *out)
    assert "known kinds" in refused("convert", log, tmp_path / "converted.csv")
    assert "choose one" in refused(
        "simulate", tmp_path / "x.csv", "--slip", 1, "--thermal-period", 9
    )
    assert "elbow" in refused("apply", _model(log, tmp_path), log)


def _model(log: Path, tmp_path: Path) -> Path:
    done("calibrate", log, "--robot", "planar", "--out", tmp_path)
    return tmp_path / "work.model.safetensors"


def test_an_unwritable_place_is_named(log: Path, tmp_path: Path):
    (tmp_path / "file").write_text("")
    nowhere = ("--out", tmp_path / "file")
    for command in (("calibrate", log, "--robot", "planar"), ("demo", "--trials", 200)):
        message = refused(*command, *nowhere)
        assert "file" in message
        assert "cannot be read or written" in message


def test_without_the_report_extra_the_calibration_stands(
    log: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    for module in [name for name in sys.modules if name.startswith("handeye.reports")]:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    result = done("calibrate", log, "--robot", "planar", "--out", tmp_path)
    assert "pip install 'handeye[report]'" in result.stderr
    assert (tmp_path / "work.model.safetensors").exists()
    assert not (tmp_path / "work.html").exists()
    result = done("demo", "--trials", 200, "--out", tmp_path)
    assert "pip install 'handeye[report]'" in result.stderr
    assert str(tmp_path / "demo.model.safetensors") in result.stdout


def test_help_and_version():
    for command in ("demo", "simulate", "calibrate", "apply", "convert", "reproduce"):
        assert command in done("--help").stdout
        assert "Usage" in done(command, "--help").stdout
    assert done("--version").stdout.startswith("handeye ")
