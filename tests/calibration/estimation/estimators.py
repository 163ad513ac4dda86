"""Every method of estimation, and short ways to let one learn and be measured."""

import numpy as np
import pytest
from tests.calibration.cases import CASES

from handeye.calibration.estimation import (
    THESIS,
    Assumptions,
    ParameterEstimator,
    Recursive,
    Refit,
)
from handeye.calibration.models import PlanarModel
from handeye.calibration.session import WorldStreams, position_errors
from handeye.thesis.plants import NOMINAL, NORMAL

MODEL = PlanarModel(NOMINAL)
METHODS = {
    "recursive": Recursive(),
    "recursive, six": Recursive(Assumptions(free=THESIS), drift=0.0),
    "forward": Refit("forward"),
    "reverse, incremental": Refit("reverse", window=8),
    "residuals": Refit("residuals", error_threshold=0.01, window=25),
}
EVERY_METHOD = pytest.mark.parametrize("method", METHODS.values(), ids=METHODS.keys())
PLANAR = [case for case in CASES if isinstance(case.model, PlanarModel)]
CLEAN = NORMAL.without_noise().without_perturbations()


def arrays(estimator):
    return list(estimator.learner.arrays().values())


def assert_same(some, others):
    for one, other in zip(some, others, strict=True):
        np.testing.assert_array_equal(one, other)


def mean_error(estimator, world, replicate, at=0, n=300):
    streams = WorldStreams.of(replicate)
    (errors,) = position_errors(world, [estimator], at, streams, n)
    return float(np.linalg.norm(errors, axis=1).mean())


def learned(method, world, n, replicate=0, model=MODEL):
    streams = WorldStreams.of(replicate)
    estimator = ParameterEstimator(model, method)
    estimator.observe_many(world.observe(np.arange(n), streams.train_poses, streams.train_noise))
    return estimator
