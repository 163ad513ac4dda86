"""What a recursive network has learned, as arrays and a few numbers."""

from typing import Any

import numpy as np

from handeye.arrays import Array, count, scalar, shaped
from handeye.errors import InvalidInput
from handeye.io.tensors import Parts
from handeye.networks.recursive.learner import Learner
from handeye.networks.recursive.posterior import refactor, with_block
from handeye.networks.recursive.units import LONGEST


def learner_parts(learner: Learner) -> Parts:
    """The state of a learner, without what is never used again."""
    units, pending, information, prior = learner.posterior
    known = learner.known
    arrays = {
        "points": learner.points[: learner.waiting],
        "noise": learner.noise,
        "signal": np.zeros(0) if learner.signal is None else learner.signal,
        "coupling": pending.coupling[:known, :known],
        "innovations": pending.innovations[:known],
    }
    for b, n in enumerate(units.counts):
        upper = np.triu_indices(n)
        arrays |= {
            f"centers {b}": units.centers[b, :, :n],
            f"weights {b}": units.weights[b, :, :n],
            f"information {b}": information[b][upper],
            f"prior {b}": prior[b][upper],
            f"responses {b}": pending.responses[b, :known, :n],
            f"solved {b}": pending.solved[b, :n, :known],
        }
    rest = {
        "noise_ratio": learner.settings.noise_ratio,
        "learned": learner.trials,
        "known": known,
        "blocks": len(units.counts),
    }
    return arrays, rest


def restore_learner(learner: Learner, arrays: dict[str, Array], rest: dict[str, Any]) -> None:
    """Put the state of `learner_parts` into a fresh learner.

    Raises InvalidInput, or what Python raises, where parts are missing or do not fit together.
    """
    m, d = learner.noise.size, learner.points.shape[1]
    ratio = scalar(rest["noise_ratio"], "noise_ratio", above=0.0)
    learner.settings = learner.settings._replace(noise_ratio=ratio)
    # The first version told only all trials, which differ where scales are being estimated.
    learner.trials = count(rest.get("learned", rest["trials"]), "learned", least=0)
    learner.known = count(rest["known"], "known", least=0)
    learner.noise = shaped(arrays["noise"], (m,), "noise")
    if len(arrays["signal"]):
        learner.signal = shaped(arrays["signal"], (m,), "signal")
    points = shaped(arrays["points"], (None, d), "points")
    if max(learner.known, len(points)) > LONGEST:
        raise InvalidInput("more samples are pending than can be")
    learner.waiting = len(points)
    learner.points[: len(points)] = points
    blocks = count(rest["blocks"], "blocks")
    for _ in range(blocks - 1):
        learner.posterior = with_block(learner.posterior)
    for b in range(blocks):
        _restore_block(learner, arrays, b)
    q, pending = learner.known, learner.posterior.pending
    pending.coupling[:q, :q] = shaped(arrays["coupling"], (q, q), "coupling")
    pending.innovations[:q] = shaped(arrays["innovations"], (q, m), "innovations")
    refactor(learner.posterior)


def _restore_block(learner: Learner, arrays: dict[str, Array], b: int) -> None:
    units, pending, information, prior = learner.posterior
    q, n = learner.known, arrays[f"centers {b}"].shape[-1]
    _, d, size = units.centers.shape
    if n > size:
        raise InvalidInput(f"{n} neurons in a block of {size}")
    units.counts[b] = n
    units.centers[b, :, :n] = shaped(arrays[f"centers {b}"], (d, n), "centers")
    units.weights[b, :, :n] = shaped(arrays[f"weights {b}"], (units.weights.shape[1], n), "weights")
    upper = np.triu_indices(n)
    for matrix, name in ((information, "information"), (prior, "prior")):
        matrix[b][upper] = shaped(arrays[f"{name} {b}"], (len(upper[0]),), name)
    pending.responses[b, :q, :n] = shaped(arrays[f"responses {b}"], (q, n), "responses")
    pending.solved[b, :n, :q] = shaped(arrays[f"solved {b}"], (n, q), "solved")
