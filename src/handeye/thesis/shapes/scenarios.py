"""What is said of the several sources of error."""

from collections.abc import Callable

import numpy as np

from handeye.arrays import Array, Booleans
from handeye.thesis.records import Records
from handeye.thesis.shapes.comparing import plateau
from handeye.thesis.shapes.finding import Finding, Limits, Shape
from handeye.thesis.units import digits, show


def _millimetres(values: Array) -> str:
    return f"{digits(float(values.mean()) * 1e3, 2)} mm"


def _by_means(holds: Callable[..., Booleans], values: tuple[Array, ...], note: str) -> Finding:
    """What holds of values (replicates,), with the verdict on their means."""
    (verdict,) = holds(*(each.mean(keepdims=True) for each in values))
    return Finding(tuple(holds(*values).tolist()), bool(verdict), note)


def perturbations_cost(records: Records, limits: Limits) -> Finding:
    """Without perturbations the error is a few millimetres smaller, the uncorrected one the same.

    With 200 neurons and without limit the error falls by `least` to `most`, and the uncorrected
    one changes by no more than `alike` of itself. The verdict is on the means over replicates.
    """

    def holds(small: Array, free: Array, uncorrected: Array) -> Booleans:
        gains = np.array([small, free])
        few = np.all((gains >= limits["least"]) & (gains <= limits["most"]), axis=0)
        return few & (np.abs(uncorrected) <= limits["alike"])

    small, free = (
        plateau(records, f"preferred/{size}-clean/error")
        - plateau(records, f"scenarios/unperturbed-{size}/error")
        for size in ("200", "free")
    )
    uncorrected = (
        plateau(records, "scenarios/unperturbed-free/uncorrected")
        / plateau(records, "preferred/free-clean/uncorrected")
        - 1.0
    )
    return _by_means(
        holds,
        (small, free, uncorrected),
        f"The error falls by {_millimetres(small)} with 200 neurons and {_millimetres(free)} "
        f"without limit; the uncorrected error changes by {100.0 * uncorrected.mean():+.1f} %.",
    )


def scale_match(records: Records, limits: Limits) -> Finding:
    """With range scale 0.9 it takes some 1900 neurons to do as well as 200 with the right scale.

    The first tested number of neurons with which the unlimited network is as good as the 200 are
    at last is `neurons` within `slack` of it. The verdict is on the mean over replicates.
    """
    _, error = records.curve("scenarios/scale-0.9-free/error")
    _, neurons = records.curve("scenarios/scale-0.9-free/neurons")
    reached = error <= plateau(records, "preferred/200-clean/error")[:, np.newaxis]
    first = np.argmax(reached, axis=1)
    needed = np.where(reached.any(axis=1), neurons[np.arange(len(first)), first], np.inf)

    def holds(count: Array) -> Booleans:
        return np.abs(count - limits["neurons"]) <= limits["slack"] * limits["neurons"]

    never = int(np.sum(~reached.any(axis=1)))
    return _by_means(
        holds,
        (needed,),
        f"{never} of {len(needed)} networks never do as well as the 200."
        if never
        else f"It takes {show(float(needed.mean()), 'neurons')} to do as well as the 200.",
    )


def foveation_accuracy(records: Records, limits: Limits) -> Finding:
    """Foveating improves accuracy by about a millimetre without noise, and not at all with it.

    Without noise the error falls by `least` to `most`; with noise it changes by less than `alike`
    of itself. The verdict is on the means over replicates.
    """

    def holds(gain: Array, change: Array) -> Booleans:
        about = (gain >= limits["least"]) & (gain <= limits["most"])
        return about & (np.abs(change) <= limits["alike"])

    levels = {
        noise: (
            plateau(records, f"preferred/free-{noise}/error"),
            plateau(records, f"scenarios/foveate-{noise}/error"),
        )
        for noise in ("noisy", "clean")
    }
    gain = levels["clean"][0] - levels["clean"][1]
    change = levels["noisy"][1] / levels["noisy"][0] - 1.0
    return _by_means(
        holds,
        (gain, change),
        f"The error falls by {_millimetres(gain)} without noise, and changes by "
        f"{100.0 * change.mean():+.1f} % with noise.",
    )


SCENARIOS: dict[str, Shape] = {
    "perturbation-accuracy": perturbations_cost,
    "scale-match": scale_match,
    "foveation-accuracy": foveation_accuracy,
}
"""The predicates of the claims about sources of error, by claim."""
