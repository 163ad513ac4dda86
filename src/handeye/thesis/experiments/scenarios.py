"""What do the several sources of error do to the network, and what can it do without?

Sections 3.5.8, 3.5.9, figures 3.42 to 3.45, 3.48. Beside them belong the curves of the preferred
network on the normal plant.
"""

import numpy as np

from handeye.thesis.experiment import Effort, Experiment, Quantities
from handeye.thesis.learning import Learning, performance
from handeye.thesis.plants import LARGE, NORMAL

TESTS, EARLY = 300, 1000
CLEAN = NORMAL.without_noise()


def early_and_late(setting: Learning, replicate: int, effort: Effort) -> Quantities:
    """The curves of `learning_curve`, and `early_error` and `early_neurons` after 1000 trials."""
    curves = performance(setting, setting.calibrator(replicate), replicate, effort)
    mark = int(np.searchsorted(curves["error"].at, effort.of(EARLY)))
    early = {f"early_{name}": float(curves[name].value[mark]) for name in ("error", "neurons")}
    return {**curves, **early}


SCENARIOS = Experiment(
    id="scenarios",
    settings={
        **{
            f"{name}-{size}": Learning(plant, capacity, tests=TESTS)
            for name, plant in (
                ("unperturbed", CLEAN.without_perturbations()),
                ("scale-0.9", CLEAN.with_range_scale(0.9)),
                ("scale-0.5", CLEAN.with_range_scale(0.5)),
            )
            for size, capacity in (("200", 200), ("free", None))
        },
        "foveate-noisy": Learning(NORMAL, foveate=True, tests=TESTS),
        "foveate-clean": Learning(CLEAN, foveate=True, tests=TESTS),
        "whole-map-noisy": Learning(NORMAL, whole_map=True, tests=TESTS),
        "whole-map-clean": Learning(CLEAN, whole_map=True, tests=TESTS),
        "large-noisy": Learning(LARGE, tests=TESTS),
        "large-clean": Learning(LARGE.without_noise(), tests=TESTS),
    },
    measure=early_and_late,
)
