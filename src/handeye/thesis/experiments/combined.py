"""How soon does the combined calibrator reach the least error there can be, and does it stay?

Sections 3.7.2, 5.1.1 (4) and 5.2.1 say what should come after the thesis. It meets the scenarios
of chapter 3, with every other calibrator beside it.
"""

import numpy as np

from handeye.calibration.drift import OffsetStep, Thermal
from handeye.thesis.combining import (
    Combining,
    calibration_curves,
    following,
    recovery,
)
from handeye.thesis.experiment import Experiment
from handeye.thesis.experiments.estimation import KINEMATIC, LOCAL
from handeye.thesis.misfits import Misfit
from handeye.thesis.parameters import Knowing, parameter_knowledge
from handeye.thesis.plants import LARGE, NORMAL

CLEAN, LARGE_CLEAN = NORMAL.without_noise(), LARGE.without_noise()

SLIP, SINCE = 200, (*range(31), 40, 50, 75, 100)
PERIOD = 500

COMBINED = Experiment(
    id="combined",
    settings={
        "normal-noisy": Combining(NORMAL, quoted=(50, 200, 500)),
        "normal-clean": Combining(CLEAN, quoted=(100, 500)),
        "large-noisy": Combining(LARGE, quoted=(100, 300)),
        "large-clean": Combining(LARGE_CLEAN, quoted=(100, 300, 500)),
        "exact": Combining(KINEMATIC, marks=(0, 5, 10, 20), quoted=(10,)),
        "local": Combining(
            KINEMATIC, region=LOCAL, marks=(0, 5, 10, 20, 30, 50, 100), quoted=(30,)
        ),
        "outliers": Combining(NORMAL, outliers=0.2, marks=(0, 10, 20, 50, 100, 200), quoted=(200,)),
    },
    measure=calibration_curves,
)

MISFITS = {
    "eccentric-gears": Misfit.of(NORMAL, gear=5e-3),
    "bent-link": Misfit.of(NORMAL, sag=0.02),
    "strange-lens": Misfit.of(NORMAL, kink=0.03),
}

COMBINED_MISFIT = Experiment(
    id="combined-misfit",
    settings={
        name: Combining(
            plant,
            floor=NORMAL,
            marks=(0, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000),
            quoted=(50, 500, 5000),
        )
        for name, plant in MISFITS.items()
    },
    measure=calibration_curves,
)

COMBINED_SCALE = Experiment(
    id="combined-scale",
    settings={
        f"scale-{scale}": Combining(
            NORMAL.with_range_scale(scale), marks=(0, 10, 20, 30, 50), quoted=(50,)
        )
        for scale in (0.9, 0.5)
    },
    measure=calibration_curves,
    replicates=60,
)
"""Three times as many replicates: the first twenty were seen while priors were chosen."""

COMBINED_STEP = Experiment(
    id="combined-step",
    settings={
        "slip": Combining(
            NORMAL,
            drift=OffsetStep("alpha", np.radians(2.0), at=SLIP),
            marks=tuple(SLIP + k for k in SINCE),
            quoted=(SLIP + 5, SLIP + 15),
        )
    },
    measure=recovery,
)

COMBINED_HEAT = Experiment(
    id="combined-heat",
    settings={
        "period-500": Combining(
            NORMAL, drift=Thermal(PERIOD), marks=tuple(range(0, 4 * PERIOD + 1, 25)), tests=200
        )
    },
    measure=following,
)

COMBINED_KNOWLEDGE = Experiment(
    id="combined-knowledge",
    settings={"unperturbed": Knowing(NORMAL.without_perturbations())},
    measure=parameter_knowledge,
)
