"""One observation at a time through the bank of hypotheses, in compiled loops."""

from typing import NamedTuple

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array, Booleans
from handeye.calibration.engine.chain import residuals
from handeye.calibration.engine.filter import (
    Bank,
    Rules,
    advance,
    bent,
    fold,
    predicted,
    unknowns,
)
from handeye.calibration.engine.roots import minimum

# A hypothesis says whether an observation is believable once it has this share of belief.
_HEARD = 0.02
# Nor can one fall further behind the best than this: it must be able to come back.
_FURTHEST = 12.0
# Observations of the window whose tangents are looked at after each observation.
_LOOKED_AT = 2


@compiled
def beliefs(bank: Bank, shares: Array) -> int:
    """shares (H,), overwritten: posterior probability of each hypothesis; returns the best.

    From the evidence of observations that left the window and the gains of those in it.
    """
    H = len(shares)
    for h in range(H):
        shares[h] = bank.evidence[h]
        for slot in range(len(bank.weights)):
            shares[h] += bank.gains[h, slot]
        if bank.asleep[h]:
            shares[h] = -np.inf
    best = int(np.argmax(shares))
    top = shares[best]
    total = 0.0
    for h in range(H):
        shares[h] = 0.0 if bank.asleep[h] else np.exp(max(shares[h] - top, -_FURTHEST))
        total += shares[h]
    shares /= total
    return best


@compiled
def average(rules: Rules, bank: Bank, shares: Array, x: Array) -> None:
    """x (n,), overwritten: the unknowns, averaged over the hypotheses."""
    part = np.empty(len(x))
    x[:] = 0.0
    for h in range(len(shares)):
        unknowns(rules, h, bank.d[h], part)
        for i in range(len(x)):
            x[i] += shares[h] * part[i]


@compiled
def forget_one(rules: Rules, bank: Bank, slot: int) -> None:
    """The oldest observation, in a slot, becomes part of what is known for good."""
    number = bank.counts[0] - len(bank.weights)
    H = len(bank.evidence)
    for h in range(H):
        if bank.asleep[h]:
            continue
        advance(rules, h, bank.olds[h], number, bank.changed[slot])
        fold(bank, h, bank.olds[h], slot)
        bank.evidence[h] = rules.memory * (bank.evidence[h] + bank.gains[h, slot])
    top = -np.inf
    for h in range(H):
        if not bank.asleep[h]:
            top = max(top, bank.evidence[h])
    for h in range(H):
        bank.evidence[h] = max(bank.evidence[h] - top, -_FURTHEST)


@compiled
def learn_one(
    kernel: NamedTuple, rules: Rules, bank: Bank, seen: Array, doubt: float, gate: float,
    surprises: Array, off: Booleans,
) -> bool:  # fmt: skip
    """Test an observation (w,) against every hypothesis, and fold it in if one believes it.

    surprises (2, H), overwritten: squared surprise r^T S^-1 r and log sqrt(det S). Believed means
    that a hypothesis with a share of belief finds it below `gate`. off (H,), overwritten: whose
    window has left its tangents, at the latest observation or at one of a few others: `relearn`.
    """
    H, W = len(bank.evidence), len(bank.weights)
    number = bank.counts[0]
    slot = number % W
    shares = np.empty(H)
    beliefs(bank, shares)
    if number >= W:
        forget_one(rules, bank, slot)
    bank.seen[slot] = seen
    bank.doubts[slot] = doubt
    bank.changed[slot] = -1
    believed = False
    for h in range(H):
        bank.gains[h, slot] = 0.0
        if bank.asleep[h]:
            continue
        if advance(rules, h, bank.roots[h], number, -1):
            minimum(bank.roots[h], bank.d[h])
        surprises[0, h], surprises[1, h] = predicted(
            kernel, rules, bank, h, seen, doubt, bank.lines[h, slot]
        )
        believed = believed or (shares[h] > _HEARD and surprises[0, h] < gate)
    bank.weights[slot] = 1.0 if believed else 0.0
    bank.counts[0] = number + 1
    if believed:
        for h in range(H):
            if not bank.asleep[h]:
                bank.gains[h, slot] = fold(bank, h, bank.roots[h], slot)
                minimum(bank.roots[h], bank.d[h])
    inside = min(number + 1, W)
    for h in range(H):
        off[h] = False
        for i in range(_LOOKED_AT + 1):
            other = slot if i == 0 else (number * _LOOKED_AT + i) % inside
            if bank.asleep[h] or bank.weights[other] == 0.0:
                continue
            if bent(kernel, rules, bank, h, other):
                off[h] = True
    return believed


@compiled
def restart(bank: Bank, h: int) -> None:
    """Back to what is known from before the window."""
    n = bank.d.shape[1]
    for i in range(n):
        for j in range(n + 1):
            bank.roots[h, i, j] = bank.olds[h, i, j]
    minimum(bank.roots[h], bank.d[h])


@compiled
def window_squares(kernel: NamedTuple, rules: Rules, bank: Bank, h: int, squares: Array) -> None:
    """squares (W,), overwritten: the squared residual of each observation in the window."""
    values, x = np.empty(bank.lines.shape[2]), np.empty(bank.d.shape[1])
    slopes = np.empty((len(values), len(x)))
    unknowns(rules, h, bank.d[h], x)
    for slot in range(min(bank.counts[0], len(squares))):
        residuals(kernel, x, bank.seen[slot], bank.doubts[slot], values, slopes)
        squares[slot] = 0.0
        for i in range(len(values)):
            squares[slot] += values[i] * values[i]


@compiled
def window_surprises(kernel: NamedTuple, rules: Rules, bank: Bank, h: int, squares: Array) -> None:
    """squares (W,), overwritten: squared surprises, which allow for what is not yet known."""
    lines = np.empty(bank.lines.shape[2:])
    for slot in range(min(bank.counts[0], len(squares))):
        squares[slot], _ = predicted(
            kernel, rules, bank, h, bank.seen[slot], bank.doubts[slot], lines
        )
