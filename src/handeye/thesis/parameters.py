"""How well the combined calibrator knows parameters, and how well it knows that, as a measure.

Some parameters no sighting can tell apart: the arm's base may turn together with the eye and both
zeros, and every length may grow together. What can be told is a, b, v_x, v_y, O_beta and O_gamma of
the same robot with O_alpha = 0 and a range scale of 1 (table 3.1); these six are judged.
"""

from dataclasses import dataclass

import numpy as np

from handeye.arrays import Array
from handeye.calibration.combined import Combined
from handeye.calibration.estimation.kernels import residual_rows
from handeye.calibration.estimation.parameters import plant_with, vector
from handeye.calibration.models import PlanarModel
from handeye.calibration.plant import PlanarPlant
from handeye.calibration.session import WorldStreams
from handeye.calibration.world import PlanarWorld
from handeye.observations import StereoObservation
from handeye.thesis.estimating import settled
from handeye.thesis.experiment import Effort, Quantities
from handeye.thesis.plants import NOMINAL

JUDGED = np.array([0, 1, 2, 3, 5, 6])
"""Places of the six in the parameter vector (8,)."""

_STEP = 1e-6


@dataclass(frozen=True)
class Knowing:
    """A combined calibrator on a plant that nothing perturbs.

    plant         the actual robot, with noise
    observations  learned
    seeds         repetitions that make one replicate
    """

    plant: PlanarPlant
    observations: int = 200
    seeds: int = 10


def parameter_knowledge(setting: Knowing, replicate: int, effort: Effort) -> Quantities:
    """Errors of the six parameters that sightings can tell, over all seeds of the replicate.

    variance  mean square of the errors over the reported standard deviations
    to_bound  root mean square of the errors over the Cramer-Rao bound's standard deviations
    """
    normalised: list[Array] = []
    bounded: list[Array] = []
    for seed in range(effort.of(setting.seeds, least=1)):
        streams = WorldStreams.of(setting.seeds * replicate + seed)
        trials = np.arange(effort.of(setting.observations, least=50))
        world = PlanarWorld(setting.plant)
        seen = world.observe(trials, streams.train_poses, streams.train_noise)
        calibrator = Combined(PlanarModel(NOMINAL))
        calibrator.observe_many(seen)
        error = settled(calibrator.plant) - settled(setting.plant)
        normalised.append(error / reported_std(calibrator))
        bounded.append(error / cramer_rao(setting.plant, seen))
    return {
        "variance": float(np.mean(np.square(normalised))),
        "to_bound": float(np.sqrt(np.mean(np.square(bounded)))),
    }


def reported_std(calibrator: Combined) -> Array:
    """Standard deviations (6,) that a calibrator reports for the six, [m] and [rad]."""
    p = calibrator.parameters
    slopes = np.empty((6, len(p)))
    for k in range(len(p)):
        step = _STEP * np.eye(len(p))[k]
        ends = [settled(plant_with(NOMINAL, p + side * step)) for side in (1.0, -1.0)]
        slopes[:, k] = (ends[0] - ends[1]) / (2.0 * _STEP)
    reported = slopes @ _without_gauges(calibrator)
    return np.sqrt(np.sum(reported**2, axis=1))


def _without_gauges(calibrator: Combined) -> Array:
    """A root (8, 8) of the covariance of the parameters, given that gauges stay where they are.

    Along a gauge the calibrator learns nothing and reports the prior; the six do not depend on it,
    but to first order only at the nominal parameters, where its direction is taken.
    """
    chain, n = calibrator.engine.chain, len(calibrator.parameters)
    tolerance = chain.tolerance[:n]
    basis = np.linalg.qr(np.array([gauge.direction[:n] for gauge in chain.gauges]).T).Q
    away = np.eye(n) - basis @ basis.T
    scaled = calibrator.knowledge().covariance[:n, :n] / np.outer(tolerance, tolerance)
    sizes, directions = np.linalg.eigh(away @ scaled @ away)
    return tolerance[:, np.newaxis] * directions * np.sqrt(np.maximum(sizes, 0.0))


def cramer_rao(plant: PlanarPlant, seen: StereoObservation) -> Array:
    """Least standard deviations (6,) of any unbiased estimate from N sightings of a plant.

    The inverse of the Fisher information `sum J^T J`, J the slopes of the two residuals of a
    sighting over their standard deviations (eq 3.24, 3.28) at the actual parameters.
    """
    rows = np.column_stack([
        seen.joints, seen.range, seen.pointing + seen.eccentricity,
        plant.head.range_std(seen.range, seen.eccentricity),
        plant.head.eccentricity_std(seen.eccentricity),
    ])  # fmt: skip
    values, slopes = np.empty(2 * len(seen)), np.empty((2 * len(seen), 8))
    residual_rows(vector(plant), rows, values, slopes)
    J = slopes[:, JUDGED]
    return np.sqrt(np.diag(np.linalg.inv(J.T @ J)))
