"""What widths and response functions of neurons are said to do."""

from collections.abc import Callable

import numpy as np

from handeye.arrays import Array, Booleans
from handeye.thesis.records import Records
from handeye.thesis.shapes.comparing import growth, plateau, spread
from handeye.thesis.shapes.finding import Finding, Limits, Shape
from handeye.thesis.units import show


def width(records: Records, limits: Limits) -> Finding:
    """Narrow neurons are unstable, from `low` to `high` they beat wide ones, and these level off.

    Unstable: for h <= `narrow` the error ends `growth` times above its lowest or higher, in most
    replicates. Level off: with the two largest h it differs by `alike` at most.
    """
    levels = _by_fraction(records, "width", "h-")
    grown = _by_fraction(records, "width", "h-", growth)
    unstable = [g >= limits["growth"] for h, g in grown.items() if h <= limits["narrow"]]
    good = [v for h, v in levels.items() if limits["low"] <= h <= limits["high"]]
    wide = {h: v for h, v in levels.items() if h > limits["high"]}
    apart, each = spread([wide[h] for h in sorted(wide)[-2:]])
    better = max(v.mean() for v in good) < min(v.mean() for v in wide.values())
    held = (
        np.all(unstable, axis=0)
        & (np.max(good, axis=0) < np.min(list(wide.values()), axis=0))
        & (each <= limits["alike"])
    )
    return Finding(
        tuple(held.tolist()),
        _mostly(unstable) and bool(better) and apart <= limits["alike"],
        f"By h: {_listed(levels)}. Grown over the lowest: {_times(grown, limits['low'])}. If "
        f"every neuron that answers is corrected: "
        f"{_listed(_by_fraction(records, 'width', 'all-active-h-'))}.",
    )


def responses(records: Records, limits: Limits) -> Finding:
    """Parabolic and cosine neurons are unstable up to h = `narrow`, else alike, and a little worse.

    Unstable as in `width`, and not above. Alike: at every larger h they differ by `alike` at most.
    A little worse: at its best h each errs more than Gaussian ones at theirs, by `behind` at most.
    """
    kinds = ("parabolic", "cosine")
    levels = {k: _by_fraction(records, "responses", f"{k}-h-") for k in (*kinds, "gaussian")}
    grown = {kind: _by_fraction(records, "responses", f"{kind}-h-", growth) for kind in kinds}
    narrow, factor = limits["narrow"], limits["growth"]
    unstable = [g >= factor for k in kinds for h, g in grown[k].items() if h <= narrow]
    stable = [g < factor for k in kinds for h, g in grown[k].items() if h > narrow]
    pairs = [[levels[k][h] for k in kinds] for h in levels["cosine"] if h > narrow]
    apart = [spread(pair) for pair in pairs]
    least = {k: min(v.values(), key=lambda level: level.mean()) for k, v in levels.items()}
    behind = [least[kind] - least["gaussian"] for kind in kinds]
    held = np.all(
        [
            *unstable,
            *stable,
            *(each <= limits["alike"] for _, each in apart),
            *((gap > 0.0) & (gap <= limits["behind"]) for gap in behind),
        ],
        axis=0,
    )
    holds = (
        _mostly(unstable)
        and _mostly(stable)
        and all(of_means <= limits["alike"] for of_means, _ in apart)
        and all(0.0 < gap.mean() <= limits["behind"] for gap in behind)
    )
    listed = "; ".join(f"{k} {_listed(levels[k])}" for k in kinds)
    gaps = ", ".join(f"{k} {show(g.mean(), 'm')}" for k, g in zip(kinds, behind, strict=True))
    every = _listed(_by_fraction(records, "responses", "all-active-parabolic-h-"))
    return Finding(
        tuple(held.tolist()),
        holds,
        f"By h: {listed}. Grown over the lowest: "
        f"{'; '.join(f'{k} {_times(grown[k], narrow)}' for k in kinds)}. At best behind "
        f"Gaussian: {gaps}. Parabolic, if every neuron that answers is corrected: {every}.",
    )


def _by_fraction(
    records: Records,
    experiment: str,
    prefix: str,
    measure: Callable[[Records, str], Array] = plateau,
) -> dict[float, Array]:
    """What settings `prefix` and h end with, by h."""
    return {
        float(name.removeprefix(prefix)): measure(records, f"{experiment}/{name}/error")
        for name in records.settings(experiment)
        if name.startswith(prefix)
    }


def _mostly(held: list[Booleans]) -> bool:
    """Whether each of these is so in more than half of the replicates."""
    return all(h.mean() > 0.5 for h in held)


def _listed(levels: dict[float, Array]) -> str:
    return ", ".join(f"{h:g} {show(float(v.mean()), 'm')}" for h, v in levels.items())


def _times(grown: dict[float, Array], most: float) -> str:
    """The median growth for h up to `most`."""
    return ", ".join(f"{h:g} {np.median(g):.2f}" for h, g in grown.items() if h <= most)


WIDTH: dict[str, Shape] = {"width-h": width, "other-responses": responses}
"""The predicates of the claims about widths, by claim."""
