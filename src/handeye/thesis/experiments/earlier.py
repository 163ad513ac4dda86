"""How many trials do earlier hand-eye learners need, and today's?

Section 3.2 tells of Kuperstein's map and of MURPHY, which learn the whole map from sight to joints;
section 3.7 argues that a correction of known kinematics is learned sooner.
"""

from handeye.thesis.experiment import Experiment
from handeye.thesis.plants import NORMAL
from handeye.thesis.reaching import Reaching, reaching_curve

TRIALS = {
    "kuperstein": 10_000,
    "murphy": 10_000,
    "albus": 5000,
    "network": 5000,
    "estimator": 500,
    "combined": 500,
}
"""As many as a learner can make use of."""

PLANTS = {"noisy": NORMAL, "clean": NORMAL.without_noise()}

EARLIER = Experiment(
    id="earlier",
    settings={
        f"{learner}-{noise}": Reaching(plant, learner, trials)
        for noise, plant in PLANTS.items()
        for learner, trials in TRIALS.items()
    },
    measure=reaching_curve,
)
