"""The visual error at one pose, and what learning makes of it.

Eq 3.96, figures 3.29, 3.30.
"""

import numpy as np

from handeye.calibration.calibrators import Nominal
from handeye.calibration.models import PlanarModel
from handeye.calibration.results import ErrorSummary
from handeye.calibration.session import WorldStreams, learn_in_world, position_errors
from handeye.calibration.world import PlanarWorld, Region
from handeye.thesis.experiment import Curve, Effort, Experiment, Quantities
from handeye.thesis.learning import Learning
from handeye.thesis.plants import NOMINAL

ALPHA, BETA = -np.pi / 3.0, 2.0 * np.pi / 3.0

POSE = Region(alpha=(ALPHA, ALPHA), beta=(BETA, BETA), eccentricity=0.0)


def errors_at_pose(setting: Learning, replicate: int, effort: Effort) -> Quantities:
    """Visual and learned position errors with the hand at alpha, beta and straight ahead.

    visual_rms           root mean square distance between the hand and where it is seen
    visual_rms_expected  the same from eq 3.24 and 3.28: sqrt(sigma_r^2 + (r sigma_eps)^2)
    visual_mean          mean distance
    visual               curve of the distances in the first 100 trials
    visual_average       curve of mean distances, each of fresh trials
    learned_average      curve of mean position errors in the same trials, learning at this pose
                         alone in between
    learned_here         its end
    learned_everywhere   mean position error here after learning over the whole region
    """
    model, tests = PlanarModel(NOMINAL), effort.of(setting.tests)
    here = PlanarWorld(setting.plant, POSE)

    streams = WorldStreams.of(replicate)
    (misses,) = position_errors(here, [Nominal(model)], 0, streams, effort.of(5000))
    visual = ErrorSummary.of(misses)

    first = effort.of(100)
    streams, trials = WorldStreams.of(replicate), effort.of(setting.trials)
    everywhere = setting.calibrator(replicate)
    everywhere.observe_many(
        PlanarWorld(setting.plant).observe(
            np.arange(trials), streams.train_poses, streams.train_noise
        )
    )
    (errors,) = position_errors(here, [everywhere], trials, streams, tests)
    # Nominal kinematics are exact here: their position error is the visual one.
    curve = learn_in_world(
        here, setting.calibrator(replicate), Nominal(model), WorldStreams.of(replicate),
        trials=trials, every=effort.of(setting.every, least=1), tests=tests,
    )  # fmt: skip

    tip, straight = setting.plant.tips(np.array([ALPHA, BETA])), np.zeros(())
    _, r, _ = setting.plant.sight(tip, straight, np.zeros(2))
    along = setting.plant.head.range_std(r, straight)
    across = r * setting.plant.head.eccentricity_std(straight)
    return {
        "visual_rms": visual.rms,
        "visual_rms_expected": float(np.hypot(along, across)),
        "visual_mean": visual.mean,
        "visual": Curve(np.arange(1.0, first + 1.0), np.linalg.norm(misses[:first], axis=1)),
        "visual_average": Curve(curve.trials.astype(float), curve.uncorrected),
        "learned_average": Curve(curve.trials.astype(float), curve.mean),
        "learned_here": float(curve.mean[-1]),
        "learned_everywhere": ErrorSummary.of(errors).mean,
    }


NOISE_EXAMPLE = Experiment(
    id="noise-example",
    settings={"perfect": Learning(NOMINAL, capacity=200)},
    measure=errors_at_pose,
)
