"""How should neurons be adjusted, and how fast?

Section 3.5.3, figures 3.16, 3.18, 3.20, 3.21. The text does not say with which h: as in the
preferred network, and beside it as in the allocation tests just before.
"""

from handeye.networks import CMAC, GradientDescent, VirtualNeuron
from handeye.thesis.experiment import Experiment
from handeye.thesis.learning import Learning, learning_curve
from handeye.thesis.plants import NORMAL

RULES = {"gradient": GradientDescent, "virtual-neuron": VirtualNeuron, "cmac": CMAC}
RATES = (1.0, 0.1, 0.06, 0.02, 0.01)

ADAPTATION = Experiment(
    id="adaptation",
    settings={
        f"{name}-{rate}{suffix}": Learning(
            NORMAL,
            capacity=200,
            placed=200,
            adaptation=rule(rate=rate),
            half_max_fraction=h,
            tests=500,
        )
        for h, suffix in ((1.2, ""), (0.8, "-h-0.8"))
        for name, rule in RULES.items()
        for rate in RATES
    },
    measure=learning_curve,
)
