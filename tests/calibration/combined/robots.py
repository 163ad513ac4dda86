"""Robots to learn from, and short ways to run a stream through the calibrator."""

from dataclasses import replace
from functools import cache

import numpy as np

from handeye.calibration.combined import Combined, DataSheet
from handeye.calibration.combined.planar.chain import planar_chain
from handeye.calibration.models import PlanarModel
from handeye.calibration.session import WorldStreams, position_errors
from handeye.calibration.world import PlanarWorld
from handeye.observations import StereoObservation
from handeye.thesis.plants import NOMINAL, NORMAL

MODEL = PlanarModel(NOMINAL)
CLEAN_MODEL = PlanarModel(NOMINAL.without_noise())
CHAIN = planar_chain(MODEL, DataSheet())


def stream(n, replicate=0, plant=NORMAL, **world):
    streams = WorldStreams.of(replicate)
    return PlanarWorld(plant, **world).observe(
        np.arange(n), streams.train_poses, streams.train_noise
    )


@cache
def taught(n=150, replicate=0):
    """A calibrator that has seen n sightings of the normal plant; copy before use."""
    combined = Combined(MODEL)
    combined.observe_many(stream(n, replicate))
    return combined


def joined(*parts):
    """Streams one after the other."""
    names = ("time", "joints", "pointing", "range", "eccentricity")
    return StereoObservation(
        *(np.concatenate([getattr(part, name) for part in parts]) for name in names)
    )


def spoiled(seen, bad, rng):
    """Sightings whose range and eccentricity, at places bad, are those of anything in view."""
    r, eps = seen.range.copy(), seen.eccentricity.copy()
    r[bad] = rng.uniform(0.2, 3.2, len(bad))
    eps[bad] = rng.uniform(-0.5, 0.5, len(bad))
    return replace(seen, range=r, eccentricity=eps)


def mean_error(combined, plant=NORMAL, n=200, replicate=0, **world):
    streams = WorldStreams.of(replicate)
    (errors,) = position_errors(PlanarWorld(plant, **world), [combined], 0, streams, n)
    return float(np.linalg.norm(errors, axis=1).mean())
