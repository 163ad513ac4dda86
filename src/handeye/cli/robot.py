"""How a robot is named on the command line."""

from collections.abc import Collection
from pathlib import Path

from handeye.calibration.placed import Robot
from handeye.errors import InvalidInput
from handeye.robots.tip_of_joints import tip_of_joints
from handeye.robots.urdf import UrdfArm, load_arm, shipped_robots
from handeye.thesis.plants import NOMINAL

ROBOT_HELP = (
    "[bold]planar[/] (the two-link arm with a stereo eye), a .urdf file, or the name of a robot "
    "that example-robot-data ships, such as [bold]ur10[/]."
)


def load_robot(
    spec: str,
    tip: str | None = None,
    eye: str | None = None,
    *,
    joints: Collection[str] | None = None,
) -> Robot:
    """The nominal robot of that name.

    joints: those that a log names. Without a `tip`, the arm ends where they do, if the usual end
    has others or is not clear: a log of an arm need not know its gripper.

    Raises InvalidInput, FileFormatError or MissingExtra as `load_arm` does.
    """
    if spec == "planar":
        return NOMINAL
    if tip is not None or joints is None:
        return load_arm(spec, tip, eye)
    try:
        arm = load_arm(spec, None, eye)
        if set(arm.joint_names) <= set(joints):
            return arm
        found = tip_of_joints(arm.urdf, joints)
    except InvalidInput:
        found = _tip(spec, joints)
        if found is None:
            raise
        return load_arm(spec, found, eye)
    return arm if found is None else _matching(spec, found, eye, arm)


def _matching(spec: str, tip: str, eye: str | None, usual: UrdfArm) -> UrdfArm:
    """The arm that ends at the tip, if it has most of the usual one's joints."""
    arm = load_arm(spec, tip, eye)
    return arm if 2 * len(arm.joint_names) > len(usual.joint_names) else usual


def _tip(spec: str, joints: Collection[str]) -> str | None:
    path = Path(spec) if Path(spec).is_file() else shipped_robots().get(spec)
    return None if path is None else tip_of_joints(path.read_text(encoding="utf-8"), joints)
