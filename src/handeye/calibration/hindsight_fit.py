"""An arm without error curves, fitted to a log: where would it gain most by having changed?

With A the information of all rows, prior included, part g elsewhere by d before row k would let
least squares over d and all other unknowns gain

    1/2 c^T M^-1 c - 1/2 log det M,    c = sum_{i<k} w J_gi^T r_i,
    M = S_gk - S_k^T A^-1 S_k + I,     S_k = sum_{i<k} w J_i^T J_gi,  S_gk its rows of g

with d in widths of its prior. Where neighbouring rows err alike, because the model lacks something,
they count as fewer: by the inefficiency 1 + 2 sum rho_l of what is left.
"""

from collections.abc import Sequence
from typing import Any, cast

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from handeye.arrays import Array, Integers
from handeye.calibration.arm.evidence import solve
from handeye.calibration.arm.log_system import JUMP, LogSystem
from handeye.calibration.arm.student import FREEDOM
from handeye.calibration.engine.chain import Chain, Group
from handeye.calibration.engine.events import Event

# A change must explain the rows so many times better than none, for each row it may be at.
_ODDS = 1e6
# It must move the hand by so much of what is left anyway, in the median of the rows before it.
_MATTERS = 0.7
# Rows that count less do not fit; of those beside a change so many must, with numbers to spare.
_DOUBTFUL, _FITS, _SPARE = 0.1, 0.6, 3
SIDE = 3
"""Rows on either side of a change, at least."""
# Places between rows that are looked at, at most.
_LOOKS = 600
# Residuals of rows that are less alike than this are independent.
_ALIKE = 0.1

Change = tuple[int, Group]
"""The row since when a part is elsewhere."""


class Look:
    """A fit to N rows of an arm without curves, and what each row says there.

    r (N, k) and J (N, k, n): residuals and slopes in tolerances, over standard deviations and by
    weights (N, C); likely (N,): log likelihoods.
    """

    def __init__(self, system: LogSystem) -> None:
        self.system, self.fit = system, solve(system)
        tau, n = system.tolerance, len(system.tolerance)
        self.weights: Array = (FREEDOM + 3.0) / (FREEDOM + np.nan_to_num(self.fit.squares))
        r: list[Array] = []
        J: list[Array] = []
        likely: list[Array] = []
        for rows in system.rows(self.fit.x):
            some = slice(rows.first, rows.first + len(rows.residuals))
            variance = rows.std**2 + self.fit.noise[rows.channels] ** 2
            scale = np.sqrt(self.weights[some][:, rows.channels] / variance)
            r.append(rows.residuals * scale)
            J.append(rows.slopes * (scale[..., np.newaxis] * tau))
            tails = np.log1p(np.nan_to_num(self.fit.squares[some]) / FREEDOM)
            likely.append(
                -0.5 * ((FREEDOM + 3.0) * tails.sum(axis=1) + np.log(variance).sum(axis=1))
            )
        self.J: Array = np.concatenate(J)
        self.likely: Array = np.concatenate(likely)
        flat, left = self.J.reshape(-1, n), np.concatenate(r)
        prior = np.maximum(self.fit.widths / tau, 1.0) ** -2.0
        self.root: Any = cho_factor(flat.T @ flat + np.diag(prior), lower=True)
        # To the very minimum: the rest of a gradient would look like a change.
        pull = flat.T @ left.reshape(-1) + prior * self.fit.x / tau
        self.r: Array = left - self.J @ self._solved(pull)

    def candidates(self, changes: Sequence[Group]) -> list[Change]:
        """The row and the part that would gain most by having changed there.

        Of parts with one unknown, with three, and so on: this estimate is unfair to larger ones.
        """
        N, _, n = self.J.shape
        most_looks = min(_LOOKS, N - 2 * SIDE + 1)
        looks = cast("Array", np.linspace(SIDE, N - SIDE, most_looks))
        at: Integers = np.unique(looks.astype(np.int64))
        places = sorted({place for group in changes for place in group.places})
        T, P = len(at), len(places)
        J: Array = JUMP * self.J[:, :, places]
        b = _up_to(np.einsum("nkp,nk->np", J, self.r), at)
        by_all: Array = np.einsum("nki,nkp->nip", self.J, J, optimize=True)
        own: Array = np.einsum("nkp,nkq->npq", J, J, optimize=True)
        S = _up_to(by_all.reshape(N, -1), at).reshape(T, n, P)
        solved = self._solved(S.transpose(1, 0, 2).reshape(n, -1)).reshape(n, T, P)
        told = _up_to(own.reshape(N, -1), at).reshape(T, P, P)
        told = told - np.einsum("tnp,ntq->tpq", S, solved)
        best: dict[int, tuple[float, Change]] = {}
        for group in changes:
            here = [places.index(place) for place in group.places]
            M: Array = told[:, here][:, :, here] + np.eye(len(here))
            c: Array = b[:, here, np.newaxis]
            gain: Array = 0.5 * np.sum(c * np.linalg.solve(M, c), axis=(1, 2))
            gain = gain - 0.5 * np.linalg.slogdet(M)[1]
            most = int(np.argmax(gain))
            if len(here) not in best or gain[most] > best[len(here)][0]:
                best[len(here)] = float(gain[most]), (int(at[most]), group)
        return [change for _, change in best.values()]

    def gain(self, other: "Look", numbers: Sequence[int]) -> float:
        """By how much jumps of these numbers, which another look lacks, are better than chance.

        In logarithms of odds; 0 for jumps that do not matter.
        """
        first = min(self.system.jumps[number].at for number in numbers)
        if not all(self._holds(number) for number in numbers):
            return 0.0
        shift = np.zeros((first, 3))
        for number in numbers:
            shift += self._shift(number)[:first, :3]
        left: Array = np.linalg.norm(self.r[:, :3], axis=1)
        if np.median(np.linalg.norm(shift, axis=1)) < _MATTERS * np.median(left):
            return 0.0
        # The price of having them free (Schwarz 1978).
        unknowns = sum(len(self._own(number)) for number in numbers)
        price = 0.5 * unknowns * float(np.log(self.r.size))
        told = float(self.likely.sum() - other.likely.sum()) / _inefficiency(self.r)
        return told - price - len(numbers) * float(np.log(_ODDS * len(self.r)))

    def event(self, chain: Chain, group: Group, numbers: Sequence[int]) -> Event:
        """A part that changed, at jumps of these numbers, in words: by how much in all."""
        tau, pick = self.system.tolerance, np.zeros((len(group.places), len(self.system.tolerance)))
        for number in numbers:
            pick[:, self._own(number)] = -np.eye(len(group.places)) * tau[self._own(number)]
        change = pick @ (self.fit.x / tau)
        most = int(np.argmax(np.abs(change) / chain.tolerance[list(group.places)]))
        std = float(np.sqrt(pick[most] @ self._solved(pick[most])))
        place = group.places[most]
        return Event(
            self.system.jumps[numbers[-1]].at, "change", group.words,
            "seen in hindsight; what it was before is fitted too",
            float(change[most]), std, chain.units[place], chain.names[place],
        )  # fmt: skip

    def _solved(self, right: Array) -> Array:
        """A^-1 right."""
        return cast("Array", cho_solve(self.root, right))

    def _holds(self, number: int) -> bool:
        """Whether most rows on either side of a jump fit: a few wild ones would fit any."""
        jump = self.system.jumps[number]
        ends = sorted({0, len(self.r), *(other.at for other in self.system.jumps)})
        i = ends.index(jump.at)
        for start, end in ((ends[i - 1], jump.at), (jump.at, ends[i + 1])):
            fits = self.weights[start:end].min(axis=1) >= _DOUBTFUL
            if np.mean(fits) < _FITS or fits.sum() * self.r.shape[1] < len(jump.places) + _SPARE:
                return False
        return True

    def _own(self, number: int) -> Integers:
        """Where the unknowns of a jump are."""
        sizes = [len(jump.places) for jump in self.system.jumps]
        first = self.system.n_arm + sum(sizes[:number])
        return np.arange(first, first + sizes[number])

    def _shift(self, number: int) -> Array:
        """What a jump explains of the rows, (N, k)."""
        own = self._own(number)
        return self.J[:, :, own] @ (self.fit.x[own] / self.system.tolerance[own])


def _up_to(values: Array, at: Integers) -> Array:
    """Sums (T, m) of values (N, m) over the rows before each of `at` (T,)."""
    starts = np.concatenate([[0], at[:-1]])
    return np.cumsum(np.add.reduceat(values[: at[-1]], starts), axis=0)


def _inefficiency(r: Array) -> float:
    """1 + 2 sum of the correlations of residuals (N, k) with later ones, until these end."""
    squares, total = float(np.sum(r**2)), 1.0
    for lag in range(1, len(r) // 4):
        rho = float(np.sum(r[lag:] * r[:-lag])) / squares
        if rho < _ALIKE:
            break
        total += 2.0 * rho
    return total
