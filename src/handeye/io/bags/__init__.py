"""Recordings of ROS 1, ROS 2 and MCAP as logs; ROS itself is not needed."""

from handeye.io.bags.delay import Delay as Delay
from handeye.io.bags.reading import read_bag as read_bag
from handeye.io.bags.recording import is_bag as is_bag
from handeye.io.bags.report import BagOptions as BagOptions
from handeye.io.bags.report import BagReading as BagReading
from handeye.io.bags.report import BagReport as BagReport
from handeye.io.bags.report import Unused as Unused
