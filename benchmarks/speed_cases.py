"""Arms with positions to learn from, and others to judge by, for `speed.py`."""

from typing import Any, NamedTuple

import numpy as np

from handeye.calibration.arm_world import ArmWorld
from handeye.calibration.placed import place
from handeye.calibration.placed_arm import PlacedArm
from handeye.io.convert import convert
from handeye.observations import PointObservation
from handeye.robots.urdf import UrdfArm, load_arm
from handeye.thesis.real_data import ABSENT, real_data


class Case(NamedTuple):
    """What is learned, and what a fit is judged by."""

    name: str
    arm: UrdfArm
    model: PlacedArm
    learned: PointObservation
    judged: PointObservation


def ur10() -> Case:
    """The measured one."""
    folder = real_data("ur10_joint_configurations")
    if folder is None:
        raise SystemExit(ABSENT)
    seen: Any = convert(folder / "measurements_joint_configurations.csv").observations
    seen = PointObservation(seen.time, seen.joints, seen.position)
    n = len(seen)
    middle = (np.arange(n) >= 2 * n // 5) & (np.arange(n) < 3 * n // 5)
    return case_of("UR10, measured", load_arm("ur10"), seen[~middle], seen[middle])


def panda() -> Case:
    """The simulated one."""
    world = ArmWorld.of(load_arm("panda", "panda_hand"), replicate=0)
    times = np.arange(1500) / 2.0
    joints, rng = world.motion(times), np.random.default_rng(0)
    learned = world.observe(times[:1000], joints[:1000], rng)
    true = PointObservation(times[1000:], joints[1000:], world.positions(joints[1000:]))
    return case_of("Panda, simulated", world.nominal, learned, true)


def case_of(name: str, arm: UrdfArm, learned: Any, judged: Any) -> Case:
    """With the frames placed from the learned rows."""
    model: Any = place(arm, learned)[0]
    return Case(name, arm, model, learned, judged)
