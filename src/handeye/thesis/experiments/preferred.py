"""How well does the preferred network do?

Section 3.5.4, figures 3.22, 3.23.
"""

from handeye.thesis.experiment import Experiment
from handeye.thesis.learning import Learning, learning_curve
from handeye.thesis.plants import NORMAL

PREFERRED = Experiment(
    id="preferred",
    settings={
        "200-noisy": Learning(NORMAL, capacity=200),
        "200-clean": Learning(NORMAL.without_noise(), capacity=200),
        "free-noisy": Learning(NORMAL),
        "free-clean": Learning(NORMAL.without_noise()),
    },
    measure=learning_curve,
)
