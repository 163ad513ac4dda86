"""What is believed before any sample, and when it counts."""

from dataclasses import dataclass, field

import numpy as np

from handeye.arrays import Array, scalar
from handeye.calibration.hand_eye.samples import poses


@dataclass(frozen=True, eq=False)
class Mounting:
    """Where camera or target is expected on the flange; decides only what no sample decides.

    pose            (4, 4), default the flange itself
    turn_std        [rad], default half a turn: any orientation
    position_std    [m], default 1: somewhere within reach of a hand
    """

    pose: Array = field(default_factory=lambda: np.eye(4))
    turn_std: float = np.pi
    position_std: float = 1.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "pose", poses(np.asarray(self.pose)[None], "pose")[0])
        scalar(self.turn_std, "turn_std", above=0.0)
        scalar(self.position_std, "position_std", above=0.0)


@dataclass(frozen=True)
class Tolerances:
    """How far the links of an arm may depart from its model, as standard deviations.

    angle [rad] and length [m]. The defaults, 0.1 degrees and half a millimetre, are those of an
    industrial arm as it comes from the maker; samples that say otherwise change them.
    """

    angle: float = 1.7e-3
    length: float = 0.5e-3

    def __post_init__(self) -> None:
        scalar(self.angle, "angle", above=0.0)
        scalar(self.length, "length", above=0.0)
