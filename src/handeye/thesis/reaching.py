"""How many trials a learner needs for how much accuracy, as a measure for experiments."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from handeye.arrays import Array
from handeye.calibration.calibrators import NetworkCorrection
from handeye.calibration.combined import Combined
from handeye.calibration.earlier import KupersteinMap, MurphyTable, albus_correction
from handeye.calibration.estimation import ParameterEstimator
from handeye.calibration.models import PlanarMap
from handeye.calibration.plant import PlanarPlant
from handeye.calibration.session import AnyCalibrator, WorldStreams, position_errors
from handeye.calibration.world import PlanarWorld
from handeye.observations import StereoObservation
from handeye.thesis.combining import model_for
from handeye.thesis.experiment import Curve, Effort, Quantities
from handeye.thesis.plants import NOMINAL

LEARNERS: dict[str, Callable[[PlanarPlant], AnyCalibrator]] = {
    "kuperstein": lambda _: KupersteinMap(PlanarMap(NOMINAL)),
    "murphy": lambda _: MurphyTable(PlanarMap(NOMINAL)),
    "albus": lambda plant: albus_correction(model_for(plant)),
    "network": lambda plant: NetworkCorrection(model_for(plant)),
    "estimator": lambda plant: ParameterEstimator(model_for(plant)),
    "combined": lambda plant: Combined(model_for(plant)),
}
"""Each as a user gets it, for a plant about as drawn; the first two know no kinematics."""

_STEPS = (1, 2, 3, 5, 7)


@dataclass(frozen=True)
class Reaching:
    """A learner on an unknown plant.

    plant    the actual robot
    learner  a name in LEARNERS
    trials   training trials
    tests    fresh poses of a test
    """

    plant: PlanarPlant
    learner: str
    trials: int
    tests: int = 500

    @property
    def marks(self) -> tuple[int, ...]:
        """Trials after which it is tested: none, 1, 2, 3, 5, 7, 10, 20, ... and all."""
        steps = (step * 10**decade for decade in range(9) for step in _STEPS)
        return (0, *(step for step in steps if step < self.trials), self.trials)


def reaching_curve(setting: Reaching, replicate: int, effort: Effort) -> Quantities:
    """The learning curve over the trials, and what section 3.2 quotes of the earlier learners.

    error        mean position error [m]
    activation   of the Kuperstein-type map: mean difference of generated and actual muscle
                 activations over their range, at the end
    connections  of the MURPHY-type table, at the end
    """
    world, streams = PlanarWorld(setting.plant), WorldStreams.of(replicate)
    learner = LEARNERS[setting.learner](setting.plant)
    tests = effort.of(setting.tests)
    marks = sorted({effort.of(mark, least=1) if mark else 0 for mark in setting.marks})
    errors: list[float] = []
    learned = 0
    for mark in marks:
        if mark > learned:
            trials = np.arange(learned, mark)
            learner.observe_many(world.observe(trials, streams.train_poses, streams.train_noise))
            learned = mark
        (miss,) = position_errors(world, [learner], mark, streams, tests)
        errors.append(float(np.linalg.norm(miss, axis=1).mean()))
    curve = Curve(np.array(marks, np.float64), np.array(errors))
    fresh = world.observe(np.full(tests, learned), streams.test_poses, streams.test_noise)
    return {"error": curve, **_quoted(learner, fresh)}


def _quoted(learner: AnyCalibrator, fresh: StereoObservation) -> Quantities:
    match learner:
        case KupersteinMap():
            wrong = learner.activations(fresh.target) - learner.muscles(fresh.joints)
            return {"activation": float(np.abs(wrong).mean())}
        case MurphyTable():
            return {"connections": float(learner.n_connections)}
        case _:
            return {}


def trials_to(at: Array, values: Array, level: float) -> Array:
    """The trials (replicates,) after which curves (replicates, M) stay at or below `level`.

    Infinite where the end is still above. A level that is passed by luck and lost again does not
    count.
    """
    padded = np.append(at, np.inf)
    above = values > level
    last = np.where(above.any(axis=1), values.shape[1] - 1 - above[:, ::-1].argmax(axis=1), -1)
    return padded[last + 1]
