"""Measurements whose rows are in recordings of ROS."""

import json
from pathlib import Path

import numpy as np
import pytest
from tests.calibration.arm.arms import arm
from tests.calibration.arm.measured import pose
from tests.calibration.setups.described import EYE, MARKER, tables, written
from tests.io.bags.recordings import Bag
from typer.testing import CliRunner

from handeye.arrays import Array
from handeye.calibration.arm.measurements import PointSightings, PoseSightings
from handeye.calibration.setups.description import Description, load_description
from handeye.cli import app
from handeye.errors import InvalidInput, LogError
from handeye.geometry import invert, transform, wxyz_from_matrix

NAMES = arm().joint_names
DELAY = 0.03
TARGET = pose(np.random.default_rng(6))
POINTS = "measurements:\n  - {kind: points, file: run, sensor: tracker, target: ball"
POSES = "measurements:\n  - {kind: poses, file: run, sensor: camera"


def motion(t: Array) -> Array:
    """Joints (N, 6) of an arm that swings about."""
    rates, phases = np.array([0.7, 0.5, 0.9, 1.1, 0.8, 0.6]), np.arange(6.0)
    return np.sin(np.multiply.outer(t, rates) + phases) * [1.2, 0.8, 0.9, 1.0, 0.7, 1.1]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A tracker that is late sees a ball, and a camera a target."""
    place = tmp_path_factory.mktemp("recorded")
    bag = Bag()
    for t in np.arange(0.0, 20.0, 0.02):
        bag.joints(t, NAMES, motion(np.array([t]))[0])
    seen = np.arange(0.5, 19.5, 0.1)
    for t, A in zip(seen, arm().poses(motion(seen)), strict=True):
        bag.point(t + DELAY, transform(invert(EYE) @ A, MARKER))
        S = invert(EYE) @ A @ TARGET
        bag.pose(t, S[:3, 3], wxyz_from_matrix(S[:3, :3]))
    bag.write(place, "mcap")
    return place


def read(folder: Path, text: str) -> Description:
    return load_description(written(folder, text), arm())


def test_points_of_a_recording_are_those_of_a_table(folder: Path):
    text = POINTS + ", recording: {points_topic: /marker}}\n"
    found = read(folder, text)
    (one,), (source,) = found.measurements, found.sources
    assert isinstance(one, PointSightings)
    assert one.joints.shape == (190, 6)
    (own,) = one.blocks[1:]
    assert own.name == "ball"
    np.testing.assert_allclose(one.sight.points.reference[0], MARKER, atol=2e-3)
    seen = transform(invert(EYE) @ arm().poses(one.joints), MARKER)
    np.testing.assert_allclose(one.measured, seen, atol=3e-3)
    assert source.report is not None
    assert source.report.delay.seconds == pytest.approx(DELAY, abs=3e-3)
    assert source.rows.tolist() == sorted(source.rows.tolist())


def test_poses_of_a_recording_too(folder: Path):
    (one,) = read(
        folder, POSES + ", recording: {points_topic: /tag_pose, delay: 0}}\n"
    ).measurements
    assert isinstance(one, PoseSightings)
    S = invert(EYE) @ arm().poses(one.joints) @ TARGET
    np.testing.assert_allclose(one.measured, S, atol=2e-3)


SLIPS = {
    POINTS + "}\n": r"(?s)line 2, measurements 1: file: .*/marker.*/tag_pose.*here as `recording:",
    POINTS + ", recording: {topic: /marker}}\n": "recording: topic: is not known here",
    POINTS + ", recording: {points_topic: 3.5}}\n": "points_topic: must be a whole number",
    POINTS + ", recording: {receipt_times: 1}}\n": "receipt_times: must be true or false, got 1",
    POINTS + ", recording: {tolerance: 0}}\n": "recording: tolerance must be greater than 0",
    POINTS + ", columns: {x_m: x}}\n": "columns: goes with a table: a recording has topics",
    POINTS.replace("run", "points.csv") + ", recording: {delay: 0}}\n": "recording: goes with",
    POSES + ", recording: {points_topic: /marker}}\n": "/marker has positions alone: say `kind: p",
    "measurements:\n  - {kind: plane, file: run}\n": "file: is a recording, which is read for kind",
}  # fmt: skip


@pytest.mark.parametrize("text", SLIPS)
def test_slips_are_named(folder: Path, text: str):
    tables(folder)
    with pytest.raises((InvalidInput, LogError), match=SLIPS[text]):
        read(folder, text)


def test_the_command_tells_what_became_of_a_recording(folder: Path):
    text = POINTS + ", recording: {points_topic: /marker, delay: 0.03}}\n"
    setup = written(
        folder, "robot: ur10\n" + text + "arm: {compliance: 0}\ncurves: {own: 0, others: 0}\n"
    )
    options = ("--validate", "none", "--out", folder / "out", "--json", "-")
    arguments = [str(a) for a in ("calibrate", "--setup", setup, *options)]
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 0, result.output
    assert "run: joints from /joint_states" in result.stderr
    (report,) = json.loads(result.stdout)["recordings"].values()
    assert report["delay_s"] == 0.03
