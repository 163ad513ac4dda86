"""`handeye suggest` for a sensor that the robot itself carries."""

import numpy as np
from tests.cli.running import refused
from tests.robots.made import TORSO

from handeye.calibration.arm_world import ArmWorld
from handeye.errors import InvalidInput
from handeye.io.logs import Log, write_log
from handeye.robots.urdf import UrdfArm


def test_the_arm_of_a_log_ends_at_the_eye_that_is_named(tmp_path, monkeypatch):
    robot, log = tmp_path / "torso.urdf", tmp_path / "head.csv"
    robot.write_text(TORSO)
    arm = UrdfArm.from_file(robot, "left_hand", "camera")
    world, times = ArmWorld.of(arm), np.arange(20.0)
    seen = world.observe(times, world.motion(times), np.random.default_rng(0))
    write_log(log, Log("head", arm.joint_names, seen, np.arange(len(times)) + 2))

    def calibrate(log, robot, **_):
        raise InvalidInput(f"{len(log)} rows of {robot.tip} as {robot.eye} sees it")

    # To learn from the log takes long, and is tested elsewhere.
    monkeypatch.setattr("handeye.cli.suggest.calibrate_log", calibrate)
    named = ("--robot", robot, "--tip", "left_hand")
    said = refused("suggest", log, *named, "--eye", "camera")
    assert "20 rows of left_hand as camera sees it" in said
    # Without the eye other joints are on the way; of a model everything is known.
    assert "lift" in refused("suggest", log, *named)
    model = tmp_path / "head.model.safetensors"
    assert "leave out --robot, --tip and --eye" in refused("suggest", model, "--eye", "camera")
