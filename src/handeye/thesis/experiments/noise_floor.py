"""What error does noise alone leave?

Section 3.5.5, figure 3.28.
"""

from handeye.thesis.experiment import Experiment
from handeye.thesis.learning import Learning, learning_curve
from handeye.thesis.plants import NOMINAL

NOISE_FLOOR = Experiment(
    id="noise-floor",
    settings={
        "noisy": Learning(NOMINAL, capacity=200),
        "clean": Learning(NOMINAL.without_noise(), capacity=200),
    },
    measure=learning_curve,
)
