"""Eyes: what they measure, how noisily, and how they distort it."""

from handeye.sensors.retina import Retina as Retina
from handeye.sensors.stereo import StereoHead as StereoHead
