"""What networks of sigmoids are said to do (section 5.1.1 and appendix A)."""

import numpy as np

from handeye.arrays import Array
from handeye.thesis.records import Records
from handeye.thesis.shapes.comparing import clearly_below, plateau
from handeye.thesis.shapes.finding import Finding, Limits, Shape, in_every_replicate
from handeye.thesis.units import show

LAYERED = {
    "one-layer": "one layer of 100",
    "small": "two of 20",
    "two-layers": "two of 50",
    "plain": "two of 50 as in eq A.1, outputs in radians",
}
KINDS = ("triangle", "pulse", "polynomial")


def back_propagation(records: Records, limits: Limits) -> Finding:
    """Back-propagation settles only after `trials`, and then errs more than allocating networks.

    Settled: for the first time within `near` of the error that it ends with. More: that error is
    above that of the preferred network, with 200 neurons and without limit, after 5,000 trials.
    Of the layered networks the one that ends lowest is judged.
    """
    levels = {name: plateau(records, f"back-propagation/{name}/error") for name in LAYERED}
    best = min(levels, key=lambda name: float(levels[name].mean()))
    at, errors = records.curve(f"back-propagation/{best}/error")
    settled = _first(at, errors, (1.0 + limits["near"]) * levels[best])
    rivals = {n: plateau(records, f"preferred/{n}-noisy/error") for n in ("200", "free")}
    worse = [clearly_below(rival, levels[best]) for rival in rivals.values()]
    as_good = _first(at, errors, rivals["200"])
    reached = np.isfinite(as_good)
    held = settled >= limits["trials"]
    for rival in rivals.values():
        held &= levels[best] > rival
    listed = ", ".join(f"{words} {show(levels[n].mean(), 'm')}" for n, words in LAYERED.items())
    return Finding(
        tuple(held.tolist()),
        bool(settled.mean() >= limits["trials"]) and all(worse),
        f"Errors at the end: {listed}; the preferred network after 5,000 trials: "
        f"{show(rivals['200'].mean(), 'm')} with 200 neurons, {show(rivals['free'].mean(), 'm')} "
        f"without limit. The best of them settles after {show(settled.mean(), 'trials')}, and in "
        f"{reached.sum()} of {len(reached)} replicates has once been as good as 200 neurons"
        + (f", after {show(as_good[reached].mean(), 'trials')}." if reached.any() else "."),
    )


def _first(at: Array, errors: Array, level: Array) -> Array:
    """Trials (replicates,) until errors (replicates, M) are first at a level; inf if never."""
    below = errors <= level[:, np.newaxis]
    return np.where(below.any(axis=1), at[below.argmax(axis=1)], np.inf)


def paired_sigmoids(records: Records, limits: Limits) -> Finding:
    """A pair differs from 1 + sin by at most `close` of its height, and beyond is at most `little`.

    And with a large gain it is a pulse, to `little`, where the steps have been made.
    """
    inside, outside, printed = (
        records.values(f"paired-sigmoids/smooth/{name}")
        for name in ("inside", "outside", "as_printed")
    )
    pulse = records.values("paired-sigmoids/steep/pulse")
    held = (inside <= limits["close"]) & (outside <= limits["little"]) & (pulse <= limits["little"])
    return in_every_replicate(
        tuple(held.tolist()),
        f"Largest difference over the height: {show(inside[0], 'fraction')} within the period "
        f"around the pair, {show(outside[0], 'fraction')} beyond, {show(pulse[0], 'fraction')} "
        f"from a pulse with gain 50; {show(printed[0], 'fraction')} if the interval is taken as "
        "printed.",
    )


def fourier_structured(records: Records, limits: Limits) -> Finding:
    """A structured beginning errs less at the end and reaches what a random one ends with sooner.

    Sooner: in at most `sooner` of its trials. For each kind of function.
    """
    last, _ = records.curve("fourier-structured/triangle-series/error")
    held: list[Array] = []
    holds: list[bool] = []
    notes: list[str] = []
    for kind in KINDS:
        at, errors = records.curve(f"fourier-structured/{kind}-series/error")
        series, random = errors[:, -1], records.values(f"fourier-structured/{kind}-random/error")
        sooner = _first(at, errors, random) / at[-1]
        held.append((series < random) & (sooner <= limits["sooner"]))
        holds.append(clearly_below(series, random) and bool(np.median(sooner) <= limits["sooner"]))
        others = ", ".join(
            f"{words} {_digits(records.values(f'fourier-structured/{kind}-{start}/error'))}"
            for start, words in (("gaussians", "Gaussian modules"), ("allocating", "allocating"))
        )
        notes.append(
            f"{kind}: {_digits(series)} against {_digits(random)}, which it reaches "
            f"{_in_trials(float(np.median(sooner)))} ({others})"
        )
    return Finding(
        tuple(np.all(held, axis=0).tolist()),
        all(holds),
        f"Rms errors after {show(float(last[-1]), 'trials')}, functions from 0 to 1: "
        f"{'; '.join(notes)}.",
    )


def _in_trials(share: float) -> str:
    return f"in {show(share, 'fraction')} of the trials" if np.isfinite(share) else "never"


def _digits(values: Array) -> str:
    return f"{values.mean():.3f}"


FUNCTIONS: dict[str, Shape] = {
    "bep-hand-eye": back_propagation,
    "paired-sigmoids": paired_sigmoids,
    "fourier-structured": fourier_structured,
}
"""The predicates of the claims about networks of sigmoids, by claim."""
