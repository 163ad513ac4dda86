"""How fast does a trained network correct a slipped encoder, and does its size matter?

Section 3.5.7, figures 3.33, 3.34, 3.40, 3.41.
"""

import numpy as np

from handeye.calibration.drift import OffsetStep
from handeye.networks import GradientDescent
from handeye.thesis.experiment import Experiment
from handeye.thesis.learning import Learning
from handeye.thesis.plants import NORMAL
from handeye.thesis.tracking import step_response

SLIP = OffsetStep("alpha", np.radians(2.0), at=0)

VIRTUAL = (200, 500, 1000, 1500, 2000, 2500, 3000)
GRADIENT = (200, 1000, 3000)

STEP = Experiment(
    id="step",
    settings={
        **{f"virtual-{n}": Learning(NORMAL, n, drift=SLIP, tests=200) for n in VIRTUAL},
        **{
            f"gradient-{n}": Learning(
                NORMAL, n, adaptation=GradientDescent(), drift=SLIP, tests=200
            )
            for n in GRADIENT
        },
    },
    measure=step_response,
)
