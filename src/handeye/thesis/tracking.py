"""How a trained network follows a plant that changes (section 3.5.7), as measures for experiments.

A network is trained on the plant without drift. The setting's drift begins when that is over, so
its trial 0 is the first trial after training.
"""

from copy import deepcopy
from dataclasses import replace
from itertools import accumulate, chain, pairwise
from typing import Any, NamedTuple

import numpy as np

from handeye.arrays import Array
from handeye.calibration.calibrators import NetworkCorrection, Nominal
from handeye.calibration.drift import steady
from handeye.calibration.models import PlanarModel
from handeye.calibration.session import WorldStreams, position_errors
from handeye.calibration.world import PlanarWorld
from handeye.observations import StereoObservation
from handeye.thesis.analysis.step import fit_step
from handeye.thesis.experiment import Curve, Effort, Quantities
from handeye.thesis.learning import Learning
from handeye.thesis.plants import NOMINAL

AnyNetworkCorrection = NetworkCorrection[Any, Any]

STEP_TESTS = ((200, 10), (800, 50), (4000, 250))
"""After a step: first 200 trials with a test after every 10 of them, and so on."""

_LEAST = 1e-6
"""A change that moves the hand by less [m] tells nothing of how much of it is corrected."""


class Trained(NamedTuple):
    """A calibrator that knows the plant before it changes, and the streams where it left them."""

    calibrator: AnyNetworkCorrection
    streams: WorldStreams

    def copy(self) -> "Trained":
        """An independent one in the same state."""
        return deepcopy(self)


def trained(setting: Learning, replicate: int, effort: Effort) -> Trained:
    """Learn for the setting's trials on its plant without drift."""
    streams, calibrator = WorldStreams.of(replicate), setting.calibrator(replicate)
    trials = np.arange(effort.of(setting.trials))
    world = without_drift(setting.world)
    calibrator.observe_many(world.observe(trials, streams.train_poses, streams.train_noise))
    return Trained(calibrator, streams)


def without_drift(world: PlanarWorld) -> PlanarWorld:
    """The same world with a plant that stays as it is."""
    return replace(world, drift=steady)


def sightings(world: PlanarWorld, streams: WorldStreams, trials: int) -> StereoObservation:
    """What would be seen in the next trials; the streams stay where they are."""
    poses, noise = deepcopy((streams.train_poses, streams.train_noise))
    return world.observe(np.arange(trials), poses, noise)


def misses(calibrator: AnyNetworkCorrection, seen: StereoObservation) -> Array:
    """Error vectors (N, 2) [m] of a calibrator that learns nothing from what it sees."""
    model = calibrator.model
    wrong = model.needed(seen) - calibrator.network.predict_many(model.features(seen))
    return model.displacement(seen, wrong)


class Shares(NamedTuple):
    """How much of a displacement is left in each trial, signed (N,), and the weight of each (N,).

    `share = e d / |d|^2` for errors e and displacements d by the whole change; the curve s(t) that
    fits shares with weights |d|^2 best is the one for which `|e - s(t) d|^2` is least.
    """

    share: Array
    weight: Array

    @classmethod
    def of(cls, errors: Array, displacement: Array) -> "Shares":
        """Of error and displacement vectors (N, 2)."""
        weight = np.maximum(np.sum(displacement**2, axis=1), _LEAST**2)
        return cls(np.sum(errors * displacement, axis=1) / weight, weight)


def step_response(setting: Learning, replicate: int, effort: Effort) -> Quantities:
    """Re-learning after a change that stays.

    error, spread, uncorrected   curves over the trials since the change: mean position error [m],
                                 its standard deviation, the error of nominal kinematics
    error_before                 mean position error just before the change
    start, floor, time_constant  of the first-order response fitted to the error; `_low`, `_high`
                                 are the 95 % interval of this one replicate
    share                        curve of the signed part of the change's displacement that is left
    share_...                    the first-order response fitted to it, trial by trial
    """
    world, tests = setting.world, effort.of(setting.tests)
    learner, streams = trained(setting, replicate, effort)
    spans = [(effort.of(n), effort.of(every, least=1)) for n, every in STEP_TESTS]
    gaps = chain.from_iterable([every] * max(n // every, 1) for n, every in spans)
    marks = list(accumulate(gaps, initial=0))
    seen = sightings(world, streams, marks[-1])
    unchanged = sightings(without_drift(world), streams, marks[-1])
    displacement = misses(learner, seen) - misses(learner, unchanged)

    nominal = Nominal(PlanarModel(NOMINAL))
    (before,) = position_errors(without_drift(world), [learner], 0, streams, tests)
    errors: list[Array] = []
    rows: list[tuple[float, float, float]] = []
    for now, following in pairwise([*marks, marks[-1]]):
        missed = position_errors(world, [learner, nominal], now, streams, tests)
        corrected, uncorrected = (np.linalg.norm(m, axis=1) for m in missed)
        rows.append((corrected.mean(), corrected.std(ddof=1), uncorrected.mean()))
        errors.append(learner.observe_many(seen[now:following]).error)
    at = np.array(marks, np.float64)
    error, spread, uncorrected = np.array(rows).T
    fit = fit_step(at, error, spread)
    shares = Shares.of(np.concatenate(errors), displacement)
    left = fit_step(np.arange(marks[-1]), shares.share, shares.weight**-0.5)
    sums = np.add.reduceat(np.stack([shares.share * shares.weight, shares.weight]), marks[:-1], 1)
    return {
        "error": Curve(at, error),
        "spread": Curve(at, spread),
        "uncorrected": Curve(at, uncorrected),
        "error_before": float(np.linalg.norm(before, axis=1).mean()),
        "start": fit.start,
        "floor": fit.floor,
        "time_constant": fit.tau,
        "time_constant_low": fit.low,
        "time_constant_high": fit.high,
        "share": Curve(0.5 * (at[:-1] + at[1:]), sums[0] / sums[1]),
        "share_start": left.start,
        "share_floor": left.floor,
        "share_time_constant": left.tau,
        "share_time_constant_low": left.low,
        "share_time_constant_high": left.high,
    }
