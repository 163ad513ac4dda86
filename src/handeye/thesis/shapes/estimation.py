"""What is said of nonlinear estimation."""

import numpy as np

from handeye.arrays import Array
from handeye.thesis.records import Records
from handeye.thesis.shapes.finding import Finding, Limits, Shape
from handeye.thesis.units import show

DISTURBANCES = {"noise": "noise", "perturbations": "perturbations", "heat": "drift by heat"}


def large_residual(records: Records, limits: Limits) -> Finding:
    """The thesis's forward objective copes with none of noise, perturbations and drift.

    Under each of them alone, solved over all trials so far, it leaves more than `share` of the
    uncorrected error over trials 50 to 100. The verdict is on the means over replicates.
    """

    def errors(disturbance: str, method: str, when: str) -> Array:
        return records.values(f"comparison/{disturbance}-{method}/{when}")

    shares = np.array(
        [errors(d, "forward", "soon") / errors(d, "forward", "uncorrected") for d in DISTURBANCES]
    )
    texts = [
        f"{words}: {_mean(errors(d, 'forward', 'few'))} after ten trials, "
        f"{_mean(errors(d, 'forward', 'soon'))} over trials 50 to 100 (today's estimator "
        f"{_mean(errors(d, 'modern', 'few'))}, {_mean(errors(d, 'modern', 'soon'))})"
        for d, words in DISTURBANCES.items()
    ]
    uncorrected = _mean(errors("noise", "forward", "uncorrected"))
    local, modern = (_mean(errors("local-both", name, "soon")) for name in ("forward", "modern"))
    return Finding(
        tuple(np.all(shares > limits["share"], axis=0).tolist()),
        bool(np.all(shares.mean(axis=1) > limits["share"])),
        f"Left of {uncorrected} by the forward objective, with {'; '.join(texts)}. In the small "
        f"region with noise and perturbations: {local} ({modern}).",
    )


def _mean(values: Array) -> str:
    return show(float(values.mean()), "m")


ESTIMATION: dict[str, Shape] = {"lm-large-residual": large_residual}
"""The predicates of the claims about estimation, by claim."""
