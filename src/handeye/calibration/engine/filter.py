"""Several readings of a robot's data sheet, followed at once through a window of observations.

Each hypothesis is a square-root information filter over the same unknowns in its own units: d
(n,), deviations from nominal in standard deviations of its priors. `olds` is what is known from
observations that have left the window, `roots` what is known with those in it. Observations in the
window can be linearised again, taken out and put back; older ones cannot, so cost and memory stay
the same for ever.
"""

from typing import NamedTuple

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array, Booleans, Integers
from handeye.calibration.engine.chain import residuals
from handeye.calibration.engine.roots import (
    absorb,
    absorb_threes,
    fade,
    loosen,
    minimum,
    spread_of,
    surprise,
    wander,
)


class Rules(NamedTuple):
    """What stays the same, for H hypotheses over n unknowns.

    spreads (H, n) standard deviations of the priors; gauges (H, g, n) orthonormal
    directions in which nothing is learned; walks (H,) how far the first `moving` unknowns wander
    from one observation to the next, in standard deviations; keeps (H,) how much of the old
    information is left after `block` observations; walk_every: observations from one move to the
    next; changes (c, m) places of the unknowns of each possible change, filled up with -1; bend: a
    residual that has moved off its tangent by so many standard deviations calls for a new one;
    memory: share of the old evidence for a hypothesis that counts after each observation.
    """

    spreads: Array
    gauges: Array
    walks: Array
    keeps: Array
    moving: int
    walk_every: int
    block: int
    changes: Integers
    bend: float
    memory: float


class Bank(NamedTuple):
    """What is known, and the window of W observations, a ring.

    roots, olds (H, n, n + 1); d (H, n); lines (H, W, k, n + 1) the linearised observations; gains
    (H, W) log likelihood of each when it was folded in; evidence (H,) of those that left;
    seen (W, w); weights (W,) of each observation, 0 if it was rejected; doubts (W,) standard
    deviation of what the model leaves unexplained there; changed (W,) place in `changes` of what
    changed just before it, -1 if nothing; asleep (H,) hypotheses that are given up; counts (1,)
    observations so far.
    """

    roots: Array
    olds: Array
    d: Array
    lines: Array
    gains: Array
    evidence: Array
    seen: Array
    weights: Array
    doubts: Array
    changed: Integers
    asleep: Booleans
    counts: Integers


def empty_bank(hypotheses: int, n: int, window: int, k: int, w: int) -> Bank:
    """Nothing but the priors."""
    roots = np.zeros((hypotheses, n, n + 1))
    roots[:, np.arange(n), np.arange(n)] = 1.0
    return Bank(
        roots=roots,
        olds=roots.copy(),
        d=np.zeros((hypotheses, n)),
        lines=np.zeros((hypotheses, window, k, n + 1)),
        gains=np.zeros((hypotheses, window)),
        evidence=np.zeros(hypotheses),
        seen=np.zeros((window, w)),
        weights=np.zeros(window),
        doubts=np.zeros(window),
        changed=np.full(window, -1),
        asleep=np.zeros(hypotheses, np.bool_),
        counts=np.zeros(1, np.int64),
    )


@compiled
def unknowns(rules: Rules, h: int, d: Array, x: Array) -> None:
    """x (n,), overwritten, as deviations from nominal in their own units."""
    for i in range(len(x)):
        x[i] = rules.spreads[h, i] * d[i]


@compiled
def linearise(
    kernel: NamedTuple, rules: Rules, h: int, d: Array, seen: Array, doubt: float,
    values: Array, lines: Array,
) -> None:  # fmt: skip
    """Residuals values (k,) at d, and the lines (k, n + 1) on which they would vanish.

    A gauge bends: linearised here and then there, observations would seem to tell it after all. So
    lines have no part along the gauges.
    """
    n = len(d)
    x = np.empty(n)
    slopes = np.empty((len(values), n))
    unknowns(rules, h, d, x)
    residuals(kernel, x, seen, doubt, values, slopes)
    for i in range(len(values)):
        line = lines[i]
        for j in range(n):
            line[j] = slopes[i, j] * rules.spreads[h, j]
        for g in range(rules.gauges.shape[1]):
            gauge = rules.gauges[h, g]
            along = 0.0
            for j in range(n):
                along += gauge[j] * line[j]
            for j in range(n):
                line[j] -= along * gauge[j]
        line[n] = -values[i]
        for j in range(n):
            line[n] += line[j] * d[j]


@compiled
def advance(rules: Rules, h: int, root: Array, number: int, change: int) -> bool:
    """What may have changed before observation `number`; tells whether anything was done."""
    done = False
    if change >= 0:
        loosen(root, rules.changes[change], 1.0)
        done = True
    if rules.walks[h] > 0.0 and number % rules.walk_every == 0:
        wander(root, rules.moving, rules.walks[h] * np.sqrt(float(rules.walk_every)))
        done = True
    if rules.keeps[h] < 1.0 and number > 0 and number % rules.block == 0:
        fade(root, rules.keeps[h])
        done = True
    return done


@compiled
def fold(bank: Bank, h: int, root: Array, slot: int) -> float:
    """Fold the observation in a slot into a root; returns its log likelihood before."""
    weight = bank.weights[slot]
    if weight <= 0.0:
        return 0.0
    lines = bank.lines[h, slot].copy()
    for i in range(lines.shape[0]):
        for j in range(lines.shape[1]):
            lines[i, j] *= np.sqrt(weight)
    left, growth = absorb_threes(root, lines) if len(lines) % 3 == 0 else absorb(root, lines)
    return -0.5 * left - growth


@compiled
def relearn(kernel: NamedTuple, rules: Rules, bank: Bank, h: int, rounds: int) -> None:
    """Gauss-Newton over the window: linearise its observations again and fold them in anew.

    Those before a change in the window keep their tangents: the robot was another one.
    """
    n, W = bank.d.shape[1], len(bank.weights)
    so_far = bank.counts[0]
    first = max(so_far - W, 0)
    last_change = first
    for number in range(first, so_far):
        if bank.changed[number % W] >= 0:
            last_change = number
    values, d = np.empty(bank.lines.shape[2]), np.empty(n)
    for _ in range(rounds):
        root = bank.olds[h].copy()
        for number in range(first, so_far):
            slot = number % W
            advance(rules, h, root, number, bank.changed[slot])
            if number >= last_change:
                linearise(
                    kernel, rules, h, bank.d[h], bank.seen[slot], bank.doubts[slot],
                    values, bank.lines[h, slot],
                )  # fmt: skip
            bank.gains[h, slot] = fold(bank, h, root, slot)
        minimum(root, d)
        moved = 0.0
        for i in range(n):
            moved = max(moved, abs(d[i] - bank.d[h, i]))
            bank.d[h, i] = d[i]
            for j in range(n + 1):
                bank.roots[h, i, j] = root[i, j]
        if moved < 1e-6:
            break


@compiled
def predicted(
    kernel: NamedTuple, rules: Rules, bank: Bank, h: int, seen: Array, doubt: float, lines: Array
) -> tuple[float, float]:
    """Squared surprise of an observation and log sqrt(det S); lines (k, n + 1) are overwritten."""
    values, spread = np.empty(len(lines)), np.empty((len(lines), bank.d.shape[1]))
    linearise(kernel, rules, h, bank.d[h], seen, doubt, values, lines)
    spread_of(bank.roots[h], lines, spread)
    return surprise(values, spread)


@compiled
def bent(kernel: NamedTuple, rules: Rules, bank: Bank, h: int, slot: int) -> bool:
    """Whether the residuals of an observation in the window have left their tangent."""
    n = bank.d.shape[1]
    k = bank.lines.shape[2]
    values, x, slopes = np.empty(k), np.empty(n), np.empty((k, n))
    unknowns(rules, h, bank.d[h], x)
    residuals(kernel, x, bank.seen[slot], bank.doubts[slot], values, slopes)
    for i in range(k):
        line = bank.lines[h, slot, i]
        off = values[i] + line[n]
        for j in range(n):
            off -= line[j] * bank.d[h, j]
        if abs(off) > rules.bend:
            return True
    return False
