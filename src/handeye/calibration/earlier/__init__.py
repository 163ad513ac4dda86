"""Hand-eye learners that came before: what section 3.2 tells of, to be compared with."""

from handeye.calibration.earlier.albus import albus_correction as albus_correction
from handeye.calibration.earlier.kuperstein import KupersteinMap as KupersteinMap
from handeye.calibration.earlier.murphy import MurphyTable as MurphyTable
