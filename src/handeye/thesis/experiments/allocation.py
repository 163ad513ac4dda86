"""When should a neuron be added?

Sections 3.5.2, 3.5.5, figures 3.10-3.14, 3.24, 3.25, 3.27.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from handeye.calibration.session import WorldStreams
from handeye.networks import Constant, GaussianDecay, Logarithmic, NoAdaptation, Power
from handeye.thesis.experiment import Curve, Effort, Experiment, Quantities
from handeye.thesis.learning import Learning, learning_curve
from handeye.thesis.plants import NORMAL

N_EFFECTIVE = 5

SCHEDULES: dict[str, NamedTuple] = {
    "3.47": Power(1.0),
    "3.48": Power(1.0 / 2.0),
    "3.49": Power(2.0),
    "3.50": GaussianDecay(),
    "3.51": Power(1.0 / 3.0),
    "3.52": Logarithmic(),
    "3.53": Power(1.0 / N_EFFECTIVE),
    "3.54": Constant(0.0),
    "3.55": Constant(0.1),
    "3.56": Constant(0.5),
}
"""The schedules of eq 3.47 to 3.56, by equation."""

HELD_BACK = "3.50"


def schedule_curves(setting: Learning, replicate: int, effort: Effort) -> Quantities:
    """What every schedule makes of the same world.

    3.47-error, 3.47-neurons, ...   curves, named after the schedule's equation
    lowest_error                    the least of the errors that the schedules end with
    3.50-delay                      trials before the second neuron; the first, which has no
                                    neighbour to be too close to, comes at once
    """
    curves = {
        equation: learning_curve(replace(setting, schedule=schedule), replicate, effort)
        for equation, schedule in SCHEDULES.items()
    }
    measured = {
        f"{equation}-{quantity}": curve[quantity]
        for equation, curve in curves.items()
        for quantity in ("error", "neurons")
    }
    errors = [q for name, q in measured.items() if name.endswith("-error")]
    lowest = min(float(error.value[-1]) for error in errors if isinstance(error, Curve))
    held_back = replace(setting, schedule=SCHEDULES[HELD_BACK])
    delay = trials_before_second_neuron(held_back, replicate, effort)
    return {**measured, "lowest_error": lowest, f"{HELD_BACK}-delay": delay}


def trials_before_second_neuron(setting: Learning, replicate: int, effort: Effort) -> float:
    """Counted over the training trials; all of them if there is never a second neuron."""
    streams = WorldStreams.of(replicate)
    trials = np.arange(effort.of(setting.trials))
    seen = setting.world.observe(trials, streams.train_poses, streams.train_noise)
    allocated = np.flatnonzero(setting.calibrator(replicate).observe_many(seen).allocated)
    return float(allocated[1] if len(allocated) > 1 else len(trials))


ALLOCATION = Experiment(
    id="allocation",
    settings={
        name: Learning(plant, half_max_fraction=0.8, adaptation=NoAdaptation(), tests=500)
        for name, plant in (("noisy", NORMAL), ("clean", NORMAL.without_noise()))
    },
    measure=schedule_curves,
)
