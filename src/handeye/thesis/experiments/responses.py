"""Do other response functions do as well as Gaussian ones?

Section 3.5.9, figure 3.49.
"""

from typing import NamedTuple

from handeye.networks import Cosine, Gaussian, Parabolic, VirtualNeuron
from handeye.thesis.experiment import Experiment
from handeye.thesis.experiments.width import ALL_ACTIVE, CLEAN, RiskyLearning
from handeye.thesis.learning import learning_curve


def network(
    response: NamedTuple, h: float, adaptation: NamedTuple = VirtualNeuron()
) -> RiskyLearning:
    """The preferred network of 200 neurons, but for its response and h."""
    return RiskyLearning(
        CLEAN,
        capacity=200,
        response=response,
        half_max_fraction=h,
        adaptation=adaptation,
        tests=500,
    )


_KINDS = (
    ("parabolic", Parabolic(), (0.6, 0.8, 1.0, 1.5, 2.0, 4.0, 10.0)),
    ("cosine", Cosine(), (0.6, 0.8, 1.0, 1.5, 2.0, 4.0)),
    ("gaussian", Gaussian(), (1.0, 1.2, 1.5)),
)

RESPONSES = Experiment(
    id="responses",
    settings={
        **{f"{name}-h-{h}": network(kind, h) for name, kind, hs in _KINDS for h in hs},
        **{
            f"all-active-parabolic-h-{h}": network(Parabolic(), h, ALL_ACTIVE)
            for h in (0.6, 0.8, 1.0)
        },
    },
    measure=learning_curve,
)
