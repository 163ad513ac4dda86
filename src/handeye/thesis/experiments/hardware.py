"""How many bits does a chip need, and can its virtual neurons all have one width?

Appendix B. Rates are those of figure 3.21; the one virtual width and the ranges of words were
chosen on other replicates.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from handeye.arrays import Array
from handeye.calibration.calibrators import NetworkCorrection
from handeye.networks import CMAC, VirtualNeuron, fixed_grid
from handeye.networks.hardware import FixedPoint, FixedVirtualNeuron, HardwareNetwork
from handeye.networks.hardware.costs import count_trial, phases_in_a_row
from handeye.networks.hardware.operations import KINDS
from handeye.networks.inputs import InputSpace
from handeye.observations import StereoObservation, StereoTarget
from handeye.thesis.experiment import Effort, Experiment, Quantities
from handeye.thesis.learning import Learning, learning_curve
from handeye.thesis.plants import NOMINAL, NORMAL

NEURONS = 200
PER_AXIS = 6
"""Grid points along alpha, beta and eccentricity."""

ONE_WIDTH = 0.6
"""Half-maximum distance of the one virtual neuron, in radians and metres: the best of 0.2, 0.4,
0.6, 0.8, 1.0, 1.3 and 1.8 on replicates 100 and 101, with noise and without."""

WEIGHT_RANGE, OUTPUT_RANGE = 0.25, 0.5
"""Where weights and corrections saturate [rad]."""

WORD_LENGTHS = (8, 10, 12, 14, 16, 20, 24)

_ROUNDING = 1e-9


@dataclass(frozen=True)
class OnChip(Learning):
    """Neurons at random poses, or on a grid of poses, and a chip that adjusts their weights.

    fixed    the arithmetic of the chip, or None for the network itself in double precision
    on_grid  neurons stand where the nominal robot sees a regular grid of poses
    """

    placed: int = NEURONS
    capacity: int | None = NEURONS
    fixed: FixedPoint | None = None
    on_grid: bool = False
    every: int = 250
    tests: int = 500

    def calibrator(self, replicate: int) -> NetworkCorrection[StereoObservation, StereoTarget]:
        """A fresh one."""
        calibrator = super().calibrator(replicate)
        learner = calibrator.network
        if self.on_grid:
            inputs = calibrator.model.features(grid_of_poses(self))
            empty = Learning(
                self.plant, len(inputs), self.half_max_fraction, adaptation=self.adaptation
            )
            learner = empty.calibrator(replicate).network
            learner.place(inputs, weight=self.weight)
        if self.fixed is not None:
            learner = HardwareNetwork.of(learner, self.fixed)
        return NetworkCorrection(calibrator.model, learner)


def grid_of_poses(setting: Learning) -> StereoObservation:
    """What the nominal robot sees at a regular grid of poses, singular ones left out."""
    region = setting.region
    travel = (region.alpha, region.beta, (-region.eccentricity, region.eccentricity))
    box = InputSpace.box([low for low, _ in travel], [high for _, high in travel])
    poses = fixed_grid(box, PER_AXIS)
    poses = poses[np.abs(poses[:, 1]) >= region.singular_beta - _ROUNDING]
    joints, eccentricity = poses[:, :2], poses[:, 2]
    seen = NOMINAL.sight(NOMINAL.tips(joints), eccentricity, np.zeros((len(poses), 2)))
    return StereoObservation(np.arange(len(poses), dtype=np.float64), joints, *seen)


def on_chip(setting: OnChip, replicate: int, effort: Effort) -> Quantities:
    """The curves of learning, and what one trial of the chip costs.

    multiply, add, ...   operations of the first trial, counted while it runs
    phases, phases_single
                         phases in a row of a trial, with paired and with single neurons
    """
    curves = learning_curve(setting, replicate, effort)
    if setting.fixed is None:
        return curves
    chip = setting.calibrator(replicate).network
    x, target = _one_sample(chip)
    counts = count_trial(chip, x, target).sum(axis=0)
    rule = type(setting.adaptation)
    return {
        **curves,
        **{kind.replace(" ", "_"): float(n) for kind, n in zip(KINDS, counts, strict=True)},
        "phases": float(phases_in_a_row(rule, paired=True)),
        "phases_single": float(phases_in_a_row(rule, paired=False)),
    }


def _one_sample(chip: HardwareNetwork) -> tuple[Array, Array]:
    """The middle of the inputs, and a target that is worth learning."""
    middle = 0.5 * (chip.design.inputs.low + chip.design.inputs.high)
    return middle, chip.predict(middle) + 0.1


CLEAN = NORMAL.without_noise()
RULES = {"virtual-neuron": VirtualNeuron(), "cmac": CMAC()}
ONE = FixedVirtualNeuron(half_distance=ONE_WIDTH)


def _words(bits: int, rounding: Any = "nearest") -> FixedPoint:
    return FixedPoint(bits, WEIGHT_RANGE, OUTPUT_RANGE, rounding)


HARDWARE = Experiment(
    id="hardware",
    settings={
        **{
            f"{name}-{noise}-{bits or 'float'}": OnChip(
                plant, adaptation=rule, fixed=_words(bits) if bits else None
            )
            for noise, plant in (("clean", CLEAN), ("noisy", NORMAL))
            for name, rule in RULES.items()
            for bits in (*WORD_LENGTHS, None)
        },
        **{
            f"{name}-random-{noise}-{bits}": OnChip(
                plant, adaptation=rule, fixed=_words(bits, "random")
            )
            for noise, plant in (("clean", CLEAN), ("noisy", NORMAL))
            for name, rule in RULES.items()
            for bits in WORD_LENGTHS
        },
        **{
            f"grid-{name}-{noise}-{bits or 'float'}": OnChip(
                plant, adaptation=rule, fixed=_words(bits) if bits else None, on_grid=True
            )
            for noise, plant in (("clean", CLEAN), ("noisy", NORMAL))
            for name, rule in (("nearest", VirtualNeuron()), ("one-width", ONE))
            for bits in (16, None)
        },
    },
    measure=on_chip,
)
