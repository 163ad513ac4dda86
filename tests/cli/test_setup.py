"""`handeye calibrate --setup`, and what other commands make of its model."""

import csv
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from tests.calibration.setups.setups import described
from typer.testing import CliRunner, Result

from handeye.cli import app

CAMERAS = "pixels of one point in two cameras"


def run(*arguments: object) -> Result:
    return CliRunner().invoke(app, [str(a) for a in arguments], env={"COLUMNS": "200"})


def done(*arguments: object) -> Result:
    result = run(*arguments)
    assert result.exit_code == 0, result.output
    return result


def refused(*arguments: object) -> str:
    result = run(*arguments)
    assert result.exit_code == 2, result.output
    assert "Traceback" not in result.output
    return " ".join(result.stderr.split())


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two cameras beside an arm, calibrated with everything that can be written."""
    place = tmp_path_factory.mktemp("setup")
    described(CAMERAS, place, 5)
    shown = done(
        "calibrate", "--setup", place / "setup.yaml", "--out", place / "out",
        "--json", place / "r.json", "--urdf", place / "arm.urdf", "--joints-yaml", place / "j.yaml",
        "--camera-info", place / "cameras", "--hand-eye", place / "eyes",
    )  # fmt: skip
    (place / "shown.txt").write_text(shown.stdout, encoding="utf-8")
    return place


@pytest.fixture(scope="module")
def data(folder: Path) -> dict[str, Any]:
    return json.loads((folder / "r.json").read_text(encoding="utf-8"))


def test_every_key_is_documented_and_every_documented_key_is_there(
    data: dict[str, Any], repository: Path
):
    text = (repository / "docs" / "reference" / "json.md").read_text(encoding="utf-8")
    part = text[text.index("`handeye calibrate --setup ... --json`") :].split("\n\n")[0]
    named = set(re.findall(r"`(\w+)`", part.split(" A channel")[0])) - {"setup"}
    named -= {"held_out", "fitted"}
    assert named == set(data)
    channel, _ = data["channels"].values()
    rows, _ = data["influence"]
    for key in (*channel, *rows):
        assert f"`{key}`" in text, key


def test_results_are_those_of_rows_held_out(data: dict[str, Any]):
    assert data["status"] == "improved"
    assert data["judged_by"] == "held_out"
    assert data["robot"] == "ur10"
    assert data["error_before"] is None
    for name, rows in zip(("left", "right"), data["influence"], strict=True):
        pixels = data["channels"][f"pixels of {name}"]
        assert pixels["unit"] == "px"
        assert pixels["after"]["mean"] < 0.3
        assert pixels["before"]["mean"] > 1.0
        assert pixels["after"]["interval"][0] < pixels["after"]["mean"]
        assert 0.1 < pixels["noise"] < 0.2
        assert rows["channel"] == f"pixels of {name}"
        assert len(rows["row"]) == pixels["after"]["n"]
        assert {Path(file).name for file in rows["file"]} == {f"{name}.csv"}
    assert data["n_observations"] == sum(len(rows["row"]) for rows in data["influence"])
    assert all(p["std"] > 0.0 for p in data["parameters"])


def test_a_person_is_told_the_same(folder: Path, data: dict[str, Any]):
    shown = (folder / "shown.txt").read_text(encoding="utf-8")
    for words in (
        "errors of blocks of rows held out", "pixels of left [px], nominal",
        "What was found beside the arm", "frame of left", "turn about z [°]", "open",
        "Which part of the arm was off", "Rows to look at first", "left.csv",
        "trust the held-out rows",
    ):  # fmt: skip
        assert words in shown, words
    assert f"{data['channels']['pixels of left']['after']['mean']:#.3g}" in shown


def test_every_file_is_written(folder: Path, data: dict[str, Any]):
    for key in ("model", "page", "urdf", "joints", "camera_info", "hand_eye"):
        assert Path(data[key]).exists(), key
    assert (folder / "arm.urdf").read_text(encoding="utf-8").startswith("<?xml")
    assert "kinematics" in yaml.safe_load((folder / "j.yaml").read_text(encoding="utf-8"))
    assert sorted(p.name for p in (folder / "cameras").iterdir()) == ["left.yaml", "right.yaml"]
    names = ["frame_of_left.yaml", "frame_of_right.yaml"]
    assert sorted(p.name for p in (folder / "eyes").iterdir()) == names
    page = (folder / "out" / "setup.html").read_text(encoding="utf-8")
    for words in (
        "Pixels of left: the middle error is now",
        "What was found beside the arm",
        "left.csv",
    ):
        assert words in page, words


def test_a_model_writes_the_same_files_later(folder: Path, tmp_path: Path):
    model = folder / "out" / "setup.model.safetensors"
    done(
        "export", model, "--urdf", tmp_path / "arm.urdf", "--joints-yaml", tmp_path / "j.yaml",
        "--camera-info", tmp_path / "cameras", "--hand-eye", tmp_path / "eyes",
    )  # fmt: skip
    for name in ("arm.urdf", "j.yaml", "cameras/left.yaml", "eyes/frame_of_right.yaml"):
        assert (tmp_path / name).read_bytes() == (folder / name).read_bytes(), name
    assert "say what to write" in refused("export", model)
    assert "give a folder, not" in refused("export", model, "--hand-eye", tmp_path / "one.yaml")
    assert "it holds a handeye.setup" in refused("export", model, "--c", tmp_path)


def test_a_model_commands_the_arm(folder: Path, tmp_path: Path):
    model = folder / "out" / "setup.model.safetensors"
    with (folder / "left.csv").open(newline="", encoding="utf-8") as file:
        row = next(csv.DictReader(file))
    joints = {name: float(value) for name, value in row.items() if name.endswith("_rad")}
    made = done("apply", model, _target(tmp_path, joints), "--sensor", "base").stdout.splitlines()
    assert made[0].split(",") == list(joints)
    assert np.all(np.abs(np.array(made[1].split(","), float) - list(joints.values())) < 1.0)
    assert "no sensor is called eye" in refused(
        "apply", model, _target(tmp_path, joints), "--sensor", "eye"
    )


def _target(folder: Path, joints: dict[str, float]) -> Path:
    """A place near which the arm is, in the base's frame."""
    from tests.calibration.arm.arms import arm  # noqa: PLC0415

    x, y, z = arm().poses([list(joints.values())])[0, :3, 3]
    head = ["x_m", "y_m", "z_m", *joints]
    values = [x, y, z, *joints.values()]
    text = f"{','.join(head)}\n{','.join(map(str, values))}\n"
    (folder / "targets.csv").write_text(text, encoding="utf-8")
    return folder / "targets.csv"


REFUSED: dict[str, tuple[tuple[str, ...], str]] = {
    "a log as well": (("log.csv",), "leave out LOG and --method"),
    "a method": (("--method", "network"), "leave out LOG and --method"),
    "a random third": (("--validate", "random"), "choose --validate blocks or none"),
    "the planar robot": (("--robot", "planar"), "needs an arm from a URDF file"),
    "a tip alone": (("--tip", "tool0"), "go with --robot"),
    "one file for two": (("--camera-info", "one.yaml"), "there are 2 of them: give a folder"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_does_not_go_with_a_set_up_is_refused(folder: Path, tmp_path: Path, case: str):
    options, message = REFUSED[case]
    setup = ("calibrate", "--setup", folder / "setup.yaml", "--out", tmp_path / "out")
    assert message in refused(*setup, *options)
    assert not (tmp_path / "out").exists()


def test_what_does_not_go_without_one_is_refused(tmp_path: Path):
    assert "give a LOG and its --robot" in refused("calibrate", "--out", tmp_path)
    assert "give a LOG and its --robot" in refused("calibrate", tmp_path / "log.csv")
    options = ("--robot", "ur10", "--camera-info", tmp_path / "c.yaml")
    assert "go with --setup" in refused("calibrate", tmp_path / "log.csv", *options)
    assert "cannot be read" in refused("calibrate", "--setup", tmp_path / "absent.yaml")


def test_sizes_and_sensors_must_be_there_to_be_written(tmp_path: Path):
    described("a plane", tmp_path, 0)
    setup = ("calibrate", "--setup", tmp_path / "setup.yaml", "--out", tmp_path / "out")
    assert "no measurement is of `pixels`" in refused(*setup, "--camera-info", tmp_path / "c.yaml")
    assert "nothing is of `points`" in refused(*setup, "--hand-eye", tmp_path / "h.yaml")
    described(CAMERAS, tmp_path, 0)
    text = (tmp_path / "setup.yaml").read_text(encoding="utf-8").replace(", size: [1920, 1200]", "")
    (tmp_path / "setup.yaml").write_text(text, encoding="utf-8")
    assert "size of the pictures of left, right" in refused(*setup, "--camera-info", tmp_path)
