"""How a robot is named on the command line."""

from handeye.calibration.log_run import Robot
from handeye.robots.urdf import load_arm
from handeye.thesis.plants import NOMINAL

ROBOT_HELP = (
    "[bold]planar[/] (the two-link arm with a stereo eye), a .urdf file, or the name of a robot "
    "that example-robot-data ships, such as [bold]ur10[/]."
)


def load_robot(spec: str, tip: str | None = None) -> Robot:
    """The nominal robot of that name.

    Raises InvalidInput, FileFormatError or MissingExtra as `load_arm` does.
    """
    return NOMINAL if spec == "planar" else load_arm(spec, tip)
