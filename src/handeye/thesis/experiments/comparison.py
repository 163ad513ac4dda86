"""Network or estimator: how far off is the hand in every scenario of chapter 3?

Section 3.7.1 with numbers; `handeye.thesis.comparison` makes a table of the records.
"""

from dataclasses import dataclass, replace

import numpy as np

from handeye.calibration.calibrators import Nominal
from handeye.calibration.drift import OffsetStep, Thermal
from handeye.calibration.estimation import Recursive, Refit
from handeye.calibration.models import PlanarModel
from handeye.calibration.plant import PlanarPlant
from handeye.calibration.session import LearningCurve, WorldStreams, learn_in_world
from handeye.calibration.world import Region
from handeye.thesis.estimating import Estimating
from handeye.thesis.experiment import Curve, Effort, Experiment, Quantities
from handeye.thesis.experiments.estimation import KINEMATIC, LARGE_KINEMATIC, LOCAL
from handeye.thesis.learning import Learning
from handeye.thesis.plants import LARGE, NOMINAL, NORMAL

FEW, SOON, LATE = 10, 100, 1000
TESTS = 20

HEAT = Thermal(500, phase_shift=0.5 * np.pi)
"""Begins hottest, so that over trials 50 to 100 it has about its mean effect."""


@dataclass(frozen=True)
class Work:
    """Where a calibrator has to prove itself; `slips` if an encoder does when it has learned."""

    plant: PlanarPlant
    region: Region = Region()
    heat: bool = False
    slips: bool = False
    kinematics: bool = True


SCENARIOS = {
    "kinematic": Work(KINEMATIC),
    "noise": Work(NORMAL.without_perturbations()),
    "perturbations": Work(NORMAL.without_noise()),
    "both": Work(NORMAL),
    "heat": Work(KINEMATIC, heat=True),
    "heat-both": Work(NORMAL, heat=True),
    "slip-both": Work(NORMAL, slips=True),
    "local": Work(KINEMATIC, LOCAL),
    "local-both": Work(NORMAL, LOCAL),
    "large": Work(LARGE_KINEMATIC),
    "large-both": Work(LARGE),
    "scale": Work(KINEMATIC.with_range_scale(0.9)),
    "scale-both": Work(NORMAL.with_range_scale(0.9)),
    "no-kinematics": Work(NORMAL, kinematics=False),
}


@dataclass(frozen=True)
class Compared:
    """A calibrator at work.

    before  trials after which the encoder slips, if it does
    after   trials from then on, or in all
    """

    learner: Learning | Estimating
    slips: bool
    before: int
    after: int


def network(work: Work, capacity: int | None) -> Compared:
    """The preferred network of section 3.5.4, with the trials that the thesis gives it."""
    drift = HEAT if work.heat else Learning(work.plant).drift
    learner = Learning(
        work.plant, capacity, region=work.region, whole_map=not work.kinematics, drift=drift
    )
    return Compared(learner, work.slips, before=2500, after=5000)


def estimator(work: Work, method: Recursive | Refit) -> Compared:
    """An estimator; one that solves over all trials so far is given only a few."""
    drift = HEAT if work.heat else Estimating(work.plant).drift
    learner = Estimating(work.plant, method, work.region, drift)
    after = SOON if isinstance(method, Refit) else 2000
    return Compared(learner, work.slips, before=SOON, after=after)


def scenario_errors(setting: Compared, replicate: int, effort: Effort) -> Quantities:
    """Mean position errors by the trials that the calibrator has had, since the slip if there is.

    error        curve over the first 100 trials
    uncorrected  of nominal kinematics, over the same
    few, soon    after ten trials, and over trials 50 to 100
    late         over the last 1000 trials, unless there are no more than the 100
    """
    learner, before = setting.learner, effort.of(setting.before) if setting.slips else 0
    world = learner.world
    if setting.slips:
        world = replace(world, drift=OffsetStep("alpha", np.radians(2.0), before))
    streams, calibrator = WorldStreams.of(replicate), learner.calibrator(replicate)

    def go_on(start: int, trials: int, every: int) -> LearningCurve:
        return learn_in_world(
            world,
            calibrator,
            Nominal(PlanarModel(NOMINAL)),
            streams,
            trials=trials,
            every=every,
            tests=effort.of(TESTS),
            start=start,
        )

    if before:
        seen = world.observe(np.arange(before), streams.train_poses, streams.train_noise)
        calibrator.observe_many(seen)
    few, soon, late = effort.of(FEW, least=1), effort.of(SOON), effort.of(LATE)
    first = go_on(before, soon, few)
    at = first.trials - before
    measured = {
        "error": Curve(at.astype(float), first.mean),
        "uncorrected": float(first.uncorrected.mean()),
        "few": float(first.mean[1]),
        "soon": float(first.mean[at > soon // 2].mean()),
    }
    rest = effort.of(setting.after) - soon - late
    if rest <= 0:
        return measured
    between = world.observe(
        np.arange(before + soon, before + soon + rest), streams.train_poses, streams.train_noise
    )
    calibrator.observe_many(between)
    last = go_on(before + soon + rest, late, effort.of(25, least=1))
    return {**measured, "late": float(last.mean[1:].mean())}


COMPARISON = Experiment(
    id="comparison",
    settings={
        **{
            f"{scenario}-{name}": network(work, capacity)
            for scenario, work in SCENARIOS.items()
            for name, capacity in (("network-200", 200), ("network-free", None))
        },
        **{
            f"{scenario}-{name}": estimator(work, method)
            for scenario, work in SCENARIOS.items()
            if work.kinematics
            for name, method in (("forward", Refit("forward")), ("modern", Recursive()))
        },
    },
    measure=scenario_errors,
)
