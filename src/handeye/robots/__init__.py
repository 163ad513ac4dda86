"""Arms and the encoders of their joints."""

from handeye.robots.arm import Arm as Arm
from handeye.robots.encoder import AxisEncoder as AxisEncoder
from handeye.robots.planar import TwoLinkArm as TwoLinkArm
from handeye.robots.shipped import shipped_robots as shipped_robots
from handeye.robots.urdf import UrdfArm as UrdfArm
from handeye.robots.urdf import load_arm as load_arm
