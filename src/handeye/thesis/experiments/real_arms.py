"""How well are real arms known, and what does each part of the model contribute?"""

from handeye.thesis.experiment import Experiment
from handeye.thesis.real_arms import BLOCKS, FR3, UR10, Knowing, fr3, ur10

_PARTS = ("placement", "network", "geometry", "curves", "combined")

REAL_UR10 = Experiment(
    id="real-ur10",
    settings={
        f"{split}-{part}": Knowing(part, split) for split in ("random", "blocks") for part in _PARTS
    },
    measure=ur10,
    replicates=BLOCKS,
    needs=UR10,
)

REAL_UR10_ORDER = Experiment(
    id="real-ur10-order",
    settings={part: Knowing(part, "order") for part in ("placement", "network", "combined")},
    measure=ur10,
    deterministic=True,
    needs=UR10,
)

REAL_FR3 = Experiment(
    id="real-fr3",
    settings={part: Knowing(part) for part in _PARTS},
    measure=fr3,
    deterministic=True,
    needs=FR3,
)
