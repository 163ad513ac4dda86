"""How fast does a trained network correct heat that stays?

Section 3.5.7, figure 3.39. The phases of the thermal drift at which it stays are those of the
thesis, and 270 degrees, where it displaces the hand as far as at 90, the other way.
"""

import numpy as np

from handeye.calibration.drift import Thermal
from handeye.thesis.experiment import Experiment
from handeye.thesis.learning import Learning
from handeye.thesis.plants import NORMAL
from handeye.thesis.tracking import step_response

PHASES = {"180": 180.0, "21.6": 21.6, "90": 90.0, "270": 270.0}

STEP_EXTREMES = Experiment(
    id="step-extremes",
    settings={
        name: Learning(
            NORMAL, 200, drift=Thermal(np.inf, phase_shift=np.radians(degrees)), tests=200
        )
        for name, degrees in PHASES.items()
    },
    measure=step_response,
)
