"""Kinds of measurement that a fit of an arm mixes freely: one file each.

Each is a `Measurement`: rows of values, frames and points that are known or free, and derivatives.
`start` of each places its frames and points by a closed form, on an arm without errors.
"""

from handeye.calibration.arm.measurements.distances import Distances as Distances
from handeye.calibration.arm.measurements.distances import PlaneContacts as PlaneContacts
from handeye.calibration.arm.measurements.lens import lens as lens
from handeye.calibration.arm.measurements.pixels import PixelSightings as PixelSightings
from handeye.calibration.arm.measurements.poses import PoseSightings as PoseSightings
from handeye.calibration.arm.measurements.positions import PointSightings as PointSightings
from handeye.calibration.arm.measurements.positions import Touches as Touches
from handeye.calibration.arm.measurements.seats import seats as seats
from handeye.calibration.arm.measurements.seeing import Instrument as Instrument
from handeye.calibration.arm.measurements.settling import agreeing as agreeing
from handeye.calibration.arm.measurements.settling import settled as settled
from handeye.calibration.arm.measurements.sight import Sight as Sight
from handeye.calibration.arm.measurements.stereo import StereoSightings as StereoSightings
from handeye.calibration.arm.measurements.unknowns import Frame as Frame
from handeye.calibration.arm.measurements.unknowns import Numbers as Numbers
from handeye.calibration.arm.measurements.unknowns import Points as Points
