"""Which change of the robot, if any, explains a run of surprises."""

from typing import NamedTuple

import numpy as np

from handeye.arrays import Array, Booleans, Integers
from handeye.calibration.engine.chain import Chain
from handeye.calibration.engine.filter import Bank, Rules, linearise
from handeye.calibration.engine.roots import spread_of

# An outlier may fall this many times as wide as a robot with its tolerances could.
_WIDE = 3.0
# Of the observations since a change, so many must have been surprising, and may be outliers.
_SURPRISING = 0.5
_OUTLIERS = 0.34
# Residuals that a change must explain beyond those that it could fit to anything; a curve counts
# as so many unknowns, since a few observations see no more of it.
_LEAST, _MOST = 4, 4
# Two observations that are off alike may be two outliers.
_FEWEST = 3
# And one of its unknowns must have moved by more than so many standard deviations: else it is a
# flaw of the model, to which a curve can bend a little anywhere.
_SURE = 5.0


NOWHERE = np.zeros(0)


class Found(NamedTuple):
    """A change: its place among the chain's, the observations since it, and which fit it.

    jump and std (m,): by how much its unknowns changed, in tolerances.
    """

    change: int
    slots: Integers
    kept: Booleans
    log_odds: float
    jump: Array
    std: Array


class Surprises:
    """Residuals of recent observations, and how they would spread under one change or another.

    With H their derivatives and P the covariance, they spread as S = I + H P H^T if nothing
    changed, as S + H_g H_g^T if part g jumped by about its tolerance (generalised likelihood
    ratio), and widely, each for itself, if they are outliers. P is small where a change can be
    told, so S is that of derivatives before it.
    """

    def __init__(self, chain: Chain, rules: Rules, bank: Bank, h: int, gate: float) -> None:
        self.chain, self.rules, self.bank, self.h, self.gate = chain, rules, bank, h, gate

    def linearised(
        self, slots: Integers, places: tuple[int, ...] = (), jump: Array = NOWHERE
    ) -> tuple[Array, Array]:
        """Residuals (m, k) and their derivatives (m, k, n) by the unknowns, in tolerances.

        If the unknowns at places jumped by jump (p,) the derivatives are those after it, and
        residuals what they would be before it by these.
        """
        k, n = self.chain.n_values, len(self.chain.names)
        at = list(places)
        d = self.bank.d[self.h].copy()
        d[at] += jump
        values, lines = np.empty((len(slots), k)), np.empty((len(slots), k, n + 1))
        for i, slot in enumerate(slots):
            linearise(
                self.chain.kernel, self.rules, self.h, d, self.bank.seen[slot],
                float(self.bank.doubts[slot]), values[i], lines[i],
            )  # fmt: skip
        return values - lines[:, :, at] @ jump, lines[:, :, :n]

    def spread(self, slopes: Array) -> Array:
        """S (m k, m k) if nothing changed."""
        flat = np.ascontiguousarray(slopes.reshape(-1, slopes.shape[-1]))
        out = np.empty_like(flat)
        spread_of(self.bank.roots[self.h], flat, out)
        return np.eye(len(flat)) + out @ out.T


def log_likelihood(values: Array, S: Array) -> float:
    """Of residuals (m,) that spread as S (m, m), but for a constant."""
    L = np.linalg.cholesky(S)
    return float(-0.5 * np.sum(np.linalg.solve(L, values) ** 2) - np.sum(np.log(np.diag(L))))


def best_change(surprises: Surprises, recent: Integers, odds: float) -> Found | None:
    """The change that explains the recent observations best, if `odds` times better than outliers.

    recent (m,) slots, oldest first; a change may have come before any that was not believed.
    """
    rejected = surprises.bank.weights[recent] == 0.0
    values, slopes = surprises.linearised(recent)
    S = surprises.spread(slopes)
    k = values.shape[1]
    wide = np.empty(len(recent))
    believed = np.empty(len(recent))
    for i in range(len(recent)):
        prior = _WIDE**2 * (np.eye(k) + slopes[i] @ slopes[i].T)
        wide[i] = log_likelihood(values[i], prior)
        own = slice(i * k, (i + 1) * k)
        believed[i] = log_likelihood(values[i], S[own, own])
    # What was refused may have been an outlier, or no more than bad luck.
    otherwise = np.where(rejected, np.maximum(wide, believed), believed)
    best: Found | None = None
    for start in np.flatnonzero(rejected):
        since = np.arange(start, len(recent))
        if len(since) < 2 or np.mean(rejected[since]) < _SURPRISING:
            continue
        for change in range(len(surprises.chain.changes)):
            *_, jump, _ = _explain(surprises, change, since, (values, slopes, S), wide)
            # A jump can be too large for derivatives before it: near the eye a slip of an encoder
            # looked less like itself than like a camera remounted.
            places = surprises.chain.changes[change].places
            after = surprises.linearised(recent, places, jump)
            kept, gain, jump, std = _explain(surprises, change, since, (*after, S), wide)
            log_odds = gain - float(otherwise[since].sum())
            if kept.sum() < _FEWEST:
                continue
            told = k * int(kept.sum()) - min(len(places), _MOST)
            sure = np.max(np.abs(jump) / np.maximum(std, 1e-9)) > _SURE
            if told >= _LEAST and sure and (best is None or log_odds > best.log_odds):
                best = Found(change, recent[since], kept, log_odds, jump, std)
    wanted = np.log(odds * len(surprises.chain.changes))
    return best if best is not None and best.log_odds > wanted else None


def _explain(
    surprises: Surprises, change: int, since: Integers, parts: tuple[Array, Array, Array],
    wide: Array,
) -> tuple[Booleans, float, Array, Array]:  # fmt: skip
    """Which observations fit the change, the log likelihood of all, the jump and its deviation."""
    values, slopes, S = parts
    k = values.shape[1]
    places = list(surprises.chain.changes[change].places)
    kept = np.ones(len(since), np.bool_)
    within = np.arange(k, dtype=np.int64)
    most = int(_OUTLIERS * len(since))
    while True:
        rows: Integers = np.add.outer(since[kept] * k, within).reshape(-1)
        H = slopes.reshape(-1, slopes.shape[-1])[rows][:, places]
        spread = S[rows][:, rows] + H @ H.T
        r = values.reshape(-1)[rows]
        gain = log_likelihood(r, spread) + float(wide[since[~kept]].sum())
        # Residuals that are left once the others have been explained, each observation apart.
        inverse = np.linalg.inv(spread)
        pulled = inverse @ r
        left = np.array(
            [
                pulled[i : i + k]
                @ np.linalg.solve(inverse[i : i + k, i : i + k], pulled[i : i + k])
                for i in range(0, len(rows), k)
            ]
        )
        worst = int(np.argmax(left))
        if left[worst] < surprises.gate or (~kept).sum() >= most or kept.sum() <= 3:
            # r = -H jump + noise of covariance S, and the jump's prior is one tolerance.
            doubt = 1.0 - np.einsum("ij,ik,kj->j", H, inverse, H)
            return kept, gain, -H.T @ pulled, np.sqrt(np.maximum(doubt, 0.0))
        kept[np.flatnonzero(kept)[worst]] = False
