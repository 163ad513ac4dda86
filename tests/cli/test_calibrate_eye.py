"""A log of a sensor that the robot itself carries, from the command line."""

import json
from typing import Any

import numpy as np
import pytest
from tests.cli.running import done, refused
from tests.robots.made import TORSO

from handeye.calibration.arm_world import ArmWorld
from handeye.calibration.storage import load_model
from handeye.io.logs import Log, write_log
from handeye.robots.urdf import UrdfArm


@pytest.fixture
def robot(tmp_path):
    path = tmp_path / "torso.urdf"
    path.write_text(TORSO)
    return path


@pytest.fixture
def log(robot, tmp_path):
    """What a camera on the head sees of the left hand, on an arm with ordinary errors."""
    world = ArmWorld.of(UrdfArm.from_file(robot, "left_hand", "camera"))
    assert world.actual.eye == "camera"
    times = np.arange(160.0)
    seen = world.observe(times, world.motion(times), np.random.default_rng(0))
    path = tmp_path / "head.csv"
    write_log(path, Log("head", world.nominal.joint_names, seen, np.arange(len(times)) + 2))
    return path


def test_a_hand_seen_by_a_head_that_moves_is_calibrated(robot, log, tmp_path):
    out = ("--out", tmp_path, "--validate", "random", "--json", "-")
    result = json.loads(
        done("calibrate", log, "--robot", robot, "--tip", "left_hand", "--eye", "camera", *out)
        .stdout
    )  # fmt: skip
    assert result["error_before"]["mean"] > 1e-3
    assert result["error_after"]["mean"] < 5e-4
    calibrator: Any = load_model(tmp_path / "head.model.safetensors").calibrator
    arm = calibrator.model.arm
    assert (arm.eye, arm.tip) == ("camera", "left_hand")


def test_a_chain_to_the_wrong_end_is_refused_by_the_names_of_links(robot, log, tmp_path):
    out = ("--robot", robot, "--out", tmp_path)
    said = refused("calibrate", log, *out, "--tip", "left_hand", "--eye", "cam")
    assert "no link 'cam': choose one of camera" in said
    said = refused("calibrate", log, *out, "--tip", "head", "--eye", "camera")
    assert "no joint moves the link 'head' against 'camera'" in said
    # Without the eye, other joints are on the way.
    assert "lift" in refused("calibrate", log, *out, "--tip", "left_hand")
