"""What allocation schedules and grids are said to do."""

import numpy as np

from handeye.arrays import Array
from handeye.thesis.records import Records
from handeye.thesis.shapes.comparing import clearly_below, plateau, spread
from handeye.thesis.shapes.finding import Finding, Limits, Shape
from handeye.thesis.units import show

EQUATIONS = tuple(f"3.{number}" for number in range(47, 57))
FAST = ("3.47", "3.48", "3.49", "3.54", "3.55")
GAUSSIAN = "3.50"

_STEPS = 20


def error_at(records: Records, path: str, counts: Array) -> Array:
    """Error of a schedule when it had `counts` neurons, (replicates, counts); nan if it never had.

    `path` is experiment, setting and equation. Straight between the numbers that it had at marks,
    in logarithms; where several marks found the same number, their mean counts.
    """
    _, errors = records.curve(f"{path}-error")
    _, neurons = records.curve(f"{path}-neurons")
    return np.array([_between(counts, *pair) for pair in zip(neurons, errors, strict=True)])


def _between(counts: Array, neurons: Array, errors: Array) -> Array:
    numbers, which = np.unique(neurons[neurons > 0], return_inverse=True)
    if len(numbers) == 0:
        return np.full(len(counts), np.nan)
    means = np.bincount(which, np.log(errors[neurons > 0])) / np.bincount(which)
    logs = np.interp(np.log(counts), np.log(numbers), means, left=np.nan, right=np.nan)
    return np.exp(logs)


def distances(records: Records, noise: str, first: float) -> Array:
    """How far schedules lie apart at equal numbers of neurons, (replicates,).

    Root mean square over the numbers from `first` up, evenly in the logarithm, and over the
    schedules that reach them, of the logarithm of the error against its mean there.
    """
    last = max(float(records.values(f"allocation/{noise}/{e}-neurons").max()) for e in EQUATIONS)
    counts = np.geomspace(min(first, last), last, _STEPS)
    logs = np.log([error_at(records, f"allocation/{noise}/{e}", counts) for e in EQUATIONS])
    reached = np.isfinite(logs)
    several = reached.sum(axis=0) > 1
    logs = np.where(reached & several, logs, 0.0)
    number = np.where(several, reached.sum(axis=0), 1)
    from_mean = np.where(reached & several, logs - logs.sum(axis=0) / number, 0.0)
    squares = (from_mean**2).sum(axis=(0, 2))
    return np.sqrt(squares / np.maximum((reached & several).sum(axis=(0, 2)), 1))


def collapse(records: Records, limits: Limits) -> Finding:
    """With noise, schedules with the same number of neurons, at least `first`, err alike.

    The rms distance of their errors from the common curve is at most `apart` of it.
    """
    noisy, clean = (distances(records, noise, limits["first"]) for noise in ("noisy", "clean"))
    return Finding(
        tuple((noisy <= limits["apart"]).tolist()),
        bool(noisy.mean() <= limits["apart"]),
        f"Rms distance from the common curve: {show(noisy.mean(), 'fraction')} with noise, "
        f"{show(clean.mean(), 'fraction')} without.",
    )


def efficiency(records: Records, limits: Limits) -> Finding:
    """Without noise, schedules lie farther apart, and the Gaussian one lowest.

    Apart: as in `collapse`, compared with noise. Lowest: its error is below that of each other
    schedule at equal numbers of neurons, from `first` up to what both reach, in the mean of the
    logarithms.
    """
    noisy, clean = (distances(records, noise, limits["first"]) for noise in ("noisy", "clean"))
    against = {e: _against(records, e, limits["first"]) for e in EQUATIONS if e != GAUSSIAN}
    against = {equation: ratio for equation, ratio in against.items() if len(ratio)}
    lowest = all(clearly_below(ratio, np.zeros_like(ratio)) for ratio in against.values())
    held = (clean > noisy) & np.all([ratio < 0.0 for ratio in against.values()], axis=0)
    listed = ", ".join(f"{e} {np.exp(ratio.mean()):.2f}" for e, ratio in against.items())
    ends = {e: _against(records, e, limits["many"]) for e in against}
    many = ", ".join(f"{e} {np.exp(ratio.mean()):.2f}" for e, ratio in ends.items() if len(ratio))
    return Finding(
        tuple(np.broadcast_to(held, clean.shape).tolist()),
        bool(lowest and clearly_below(noisy, clean)),
        f"Its error over that of others with as many neurons: {listed}; from "
        f"{limits['many']:,.0f} neurons up: {many or 'never so many'}.",
    )


def _against(records: Records, equation: str, first: float) -> Array:
    """Mean logarithm of the Gaussian schedule's error over another's, (replicates,), or (0,)."""
    paths = [f"allocation/clean/{e}" for e in (GAUSSIAN, equation)]
    last = min(float(records.values(f"{path}-neurons").min()) for path in paths)
    if last < first:
        return np.empty(0)
    counts = np.geomspace(first, last, _STEPS)
    ratio = np.log(error_at(records, paths[0], counts) / error_at(records, paths[1], counts))
    known = np.isfinite(ratio).all(axis=0)
    return ratio[:, known].mean(axis=1) if known.any() else np.empty(0)


def fast_five(records: Records, limits: Limits) -> Finding:
    """With noise, each of five schedules errs less over the run than any other, and they are alike.

    Over the run: the mean over the marks after the first. Alike: the largest of the five is at
    most `alike` above the smallest.
    """

    def over_run(equation: str) -> Array:
        return records.curve(f"allocation/noisy/{equation}-error")[1][:, 1:].mean(axis=1)

    fast = {equation: over_run(equation) for equation in FAST}
    slow = {equation: over_run(equation) for equation in EQUATIONS if equation not in FAST}
    apart, each = spread(list(fast.values()))
    ahead = all(clearly_below(f, s) for f in fast.values() for s in slow.values())
    held = np.max(list(fast.values()), axis=0) < np.min(list(slow.values()), axis=0)
    listed = ", ".join(f"{e} {show(v.mean(), 'm')}" for e, v in {**fast, **slow}.items())
    return Finding(
        tuple((held & (each <= limits["alike"])).tolist()),
        ahead and apart <= limits["alike"],
        f"Mean error over the run: {listed}.",
    )


def grids(records: Records, limits: Limits) -> Finding:
    """Random placement beats the grids without noise, the variable one narrowly; with noise not.

    Narrowly: by less than the variable grid beats the fixed one. With noise the largest of the
    three errors is at most `alike` above the smallest.
    """

    def levels(noise: str, reading: str = "") -> list[Array]:
        names = ("random", "variable", "fixed")
        return [plateau(records, f"grids/{name}-{noise}{reading}/error") for name in names]

    def listed(noise: str, reading: str = "") -> str:
        return ", ".join(show(level.mean(), "m") for level in levels(noise, reading))

    random, variable, fixed = levels("clean")
    apart, each = spread(levels("noisy"))
    order = clearly_below(random, variable) and clearly_below(variable, fixed)
    narrow = variable.mean() - random.mean() < fixed.mean() - variable.mean()
    held = (random < variable) & (variable - random < fixed - variable) & (each <= limits["alike"])
    on_grid = float(records.values("grids/variable-clean/on_grid").mean())
    return Finding(
        tuple(held.tolist()),
        bool(order and narrow and apart <= limits["alike"]),
        f"Random, variable, fixed without noise: {listed('clean')}; with noise: "
        f"{listed('noisy')}; with h = 0.8: {listed('clean', '-h-0.8')} and "
        f"{listed('noisy', '-h-0.8')}. The variable grid takes {show(on_grid, 'neurons')} "
        "without noise.",
    )


ALLOCATION: dict[str, Shape] = {
    "alloc-noisy-collapse": collapse,
    "alloc-clean-efficiency": efficiency,
    "alloc-fast-five": fast_five,
    "alloc-grid": grids,
}
"""The predicates of the claims about allocation, by claim."""
