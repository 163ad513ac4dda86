"""Small worlds and fresh learners for the tests of earlier hand-eye learners."""

import numpy as np

from handeye.calibration.earlier import KupersteinMap, MurphyTable, albus_correction
from handeye.calibration.models import PlanarMap, PlanarModel
from handeye.calibration.session import WorldStreams
from handeye.calibration.world import PlanarWorld
from handeye.thesis.plants import NOMINAL, NORMAL

MAP = PlanarMap(NOMINAL)
MAKERS = {
    "kuperstein": lambda: KupersteinMap(MAP),
    "murphy": lambda: MurphyTable(MAP, joint_units=24, image_step=0.2),
    "albus": lambda: albus_correction(PlanarModel(NOMINAL)),
}


def sightings(n, replicate=100, plant=NORMAL):
    streams = WorldStreams.of(replicate)
    return PlanarWorld(plant).observe(np.arange(n), streams.train_poses, streams.train_noise)
