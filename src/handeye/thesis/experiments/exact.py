"""Does a learner leave alone what is right?

Sections 3.4.6, 3.5.5.
"""

import numpy as np

from handeye.calibration.estimation import ParameterEstimator, Refit
from handeye.calibration.models import PlanarModel
from handeye.calibration.results import ErrorSummary
from handeye.calibration.session import WorldStreams, position_errors
from handeye.thesis.experiment import Effort, Experiment, Quantities
from handeye.thesis.learning import Learning
from handeye.thesis.plants import NOMINAL

ESTIMATES = 200


def what_changed(setting: Learning, replicate: int, effort: Effort) -> Quantities:
    """What a network and the thesis's estimator make of a plant that is as they think.

    neurons           allocated by the network
    largest_error     largest position error with it of any training or test pose
    change, change_without_threshold
                      largest change of any parameter ([m], [rad]), where the estimator solves after
                      errors beyond its threshold and after every trial
    """
    streams = WorldStreams.of(replicate)
    world, calibrator = setting.world, setting.calibrator(replicate)
    trials = np.arange(effort.of(setting.trials))
    trained = calibrator.observe_many(
        world.observe(trials, streams.train_poses, streams.train_noise)
    )
    (tested,) = position_errors(world, [calibrator], len(trials), streams, effort.of(setting.tests))
    errors = np.concatenate([trained.error, tested])
    return {
        "neurons": float(calibrator.network.n_neurons),
        "largest_error": ErrorSummary.of(errors).max,
        "change": largest_change(setting, Refit("forward"), replicate, effort),
        "change_without_threshold": largest_change(
            setting, Refit("forward", error_threshold=0.0), replicate, effort
        ),
    }


def largest_change(setting: Learning, method: Refit, replicate: int, effort: Effort) -> float:
    """Of any parameter from its nominal value, after the estimator's trials."""
    streams, estimator = (
        WorldStreams.of(replicate),
        ParameterEstimator(PlanarModel(NOMINAL), method),
    )
    nominal = estimator.parameters
    trials = np.arange(effort.of(ESTIMATES, least=10))
    estimator.observe_many(setting.world.observe(trials, streams.train_poses, streams.train_noise))
    return float(np.max(np.abs(estimator.parameters - nominal)))


EXACT = Experiment(
    id="exact",
    settings={"clean": Learning(NOMINAL.without_noise())},
    measure=what_changed,
)
