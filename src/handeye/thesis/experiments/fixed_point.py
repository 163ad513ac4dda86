"""Does a network at one noisy input do what the simplified model says?

Section 3.5.5, eq 3.76 to 3.83.
"""

from dataclasses import dataclass, replace

import numpy as np

from handeye.arrays import Array
from handeye.calibration.drift import OffsetStep
from handeye.calibration.plant import PlanarPlant
from handeye.calibration.results import ErrorSummary
from handeye.networks import ResourceAllocatingNetwork, VirtualNeuron
from handeye.observations import StereoObservation
from handeye.randomness import stream
from handeye.thesis.analysis.fixed_point import outputs
from handeye.thesis.experiment import Curve, Effort, Experiment, Quantities
from handeye.thesis.experiments.noise_example import ALPHA, BETA
from handeye.thesis.learning import Learning
from handeye.thesis.plants import NORMAL
from handeye.thesis.tracking import trained

RULE = VirtualNeuron()
BEFORE = Learning(NORMAL, 200, adaptation=RULE, trials=1000)
"""What a network has learned before."""

TRIALS = 1000
SHOWN = 5
PROBE = 1e-3
"""Part of an input's noise by which the slope along it is measured."""


@dataclass(frozen=True)
class OneInput:
    """A trained network that is taught one target at one pose, seen with noise.

    bias       mean noise of the range, in its standard deviations
    threshold  errors below are not learned [rad]; the model has none
    """

    bias: float = 0.0
    threshold: float = 0.0
    before: Learning = BEFORE


def one_noisy_input(setting: OneInput, replicate: int, effort: Effort) -> Quantities:
    """Output at the noise-free input against the recursion of eq 3.80.

    The target is the correction that is right there once the alpha encoder has slipped by two
    degrees; it is the same in every trial, whatever the noise.

    output, predicted  curves over the trials: first component [rad]; `target` is its goal
    misfit             rms distance of output and prediction over the distance from start to target
    mean_noise         length of the mean nu of the later half of the trials [rad]
    mean_distance      length of their mean output's distance from the target
    mean_gap           the same from the target less the mean noise
    curved_gap         the same if the curvature that the model leaves out is counted as noise too
    """
    n = effort.of(TRIALS, least=4)
    learner, _ = trained(setting.before, replicate, effort)
    model, network = learner.model, learner.network
    network.settings = network.settings._replace(learning_threshold=setting.threshold)
    plant = OffsetStep("alpha", np.radians(2.0), at=0)(NORMAL, 0)
    clean = _look(plant, np.zeros((1, 2)))
    (x,), (target,) = model.features(clean), model.needed(clean)
    noise = stream("world: noise at one pose", replicate).standard_normal((n, 2))
    inputs = model.features(_look(plant, noise + np.array([setting.bias, 0.0])))
    o, nu, curved = _teach(network, x, target, inputs)
    predicted = outputs(o[0], target, nu, RULE.rate)

    late_output, late_noise, late_curved = (
        rows[-(n - n // 2) :].mean(axis=0) for rows in (o, nu, curved)
    )
    away = o - predicted
    shown = np.arange(0, n + 1, SHOWN)
    return {
        "output": Curve(shown.astype(float), o[shown, 0]),
        "predicted": Curve(shown.astype(float), predicted[shown, 0]),
        "target": float(target[0]),
        "misfit": ErrorSummary.of(away).rms / float(np.linalg.norm(o[0] - target)),
        "mean_noise": float(np.linalg.norm(late_noise)),
        "mean_distance": float(np.linalg.norm(late_output - target)),
        "mean_gap": float(np.linalg.norm(late_output - target + late_noise)),
        "curved_gap": float(np.linalg.norm(late_output - target + late_noise + late_curved)),
    }


def _look(plant: PlanarPlant, unit_noise: Array) -> StereoObservation:
    """The pose seen straight ahead with given noise (N, 2)."""
    n = len(unit_noise)
    joints = np.tile([ALPHA, BETA], (n, 1))
    return StereoObservation(
        np.arange(float(n)), joints, *plant.sight(plant.tips(joints), np.zeros(n), unit_noise)
    )


def _teach(
    network: ResourceAllocatingNetwork, x: Array, target: Array, inputs: Array
) -> tuple[Array, Array, Array]:
    """Outputs (N + 1, m) at x while the target is taught at inputs (N, d).

    And, for each input, the slope's part (N, m), which is nu, and the even part (N, m), mostly
    curvature, of how the output there differs from that at x.
    """
    o = [network.predict(x)]
    nu: list[Array] = []
    curved: list[Array] = []
    parts = np.array([[PROBE], [-PROBE], [1.0], [-1.0]])
    for one in inputs:
        ahead, behind, there, opposite = network.predict_many(x + parts * (one - x))
        nu.append((ahead - behind) / (2.0 * PROBE))
        curved.append(0.5 * (there + opposite) - o[-1])
        network.learn(one, target)
        o.append(network.predict(x))
    return np.array(o), np.array(nu), np.array(curved)


FIXED_POINT = Experiment(
    id="fixed-point",
    settings={
        "centered": OneInput(),
        "biased": OneInput(bias=1.0),
        "threshold": replace(OneInput(bias=1.0), threshold=1e-3),
    },
    measure=one_noisy_input,
)
