"""What is known of a chain, observation by observation: tests, surprises, changes."""

from collections import deque

import numpy as np
from scipy.linalg import solve_triangular
from scipy.stats import chi2

from handeye.arrays import Array, Integers
from handeye.calibration.engine.attribution import Surprises, best_change
from handeye.calibration.engine.chain import Chain
from handeye.calibration.engine.events import Event
from handeye.calibration.engine.filter import empty_bank, relearn
from handeye.calibration.engine.robust import find_outliers
from handeye.calibration.engine.rules import BLOCK, rules_for
from handeye.calibration.engine.settings import Settings
from handeye.calibration.engine.stepping import average, beliefs, learn_one

_ROUNDS = 3
# The latest observations that are looked at for a run of surprises.
_RUN = 12
_STEP, _EARLY_STEP = 0.03, 0.9
_MILD, _MILD_STEP = 4.0, 0.2
# A share of the latest observations that, if not believed, shows that all is lost.
_LOST, _MOST = 16, 0.6
_EVENTS = 1000
_LEFT = 3.0
# A hypothesis with less than this share of belief has lost touch.
_HOPELESS = 1e-4
# That a robot drifts, or no longer does, is said with this share of belief.
_SURE_OF_IT = 0.9


class Engine:
    """Follows the unknowns of a chain.

    Every hypothesis of the settings has its own square-root information filter (Bierman 1977) over
    a window of observations that are linearised anew (`filter`); `x` is their average, weighted by
    what each has predicted (`stepping.beliefs`). An observation that none of them believes is an
    outlier, the first sign of a change of one part (`attribution`, generalised likelihood ratios),
    or shows a mistake of the past, whereupon the window is settled anew (`robust`). What happened
    stands in `events`.

    Args:
        chain: the robot.
        settings: how to learn.
        doubt: what the model leaves unexplained, at first and at least, a standard deviation in the
            units of the chain's residuals [m] and [rad].
    """

    def __init__(self, chain: Chain, settings: Settings, doubt: tuple[float, float]) -> None:
        self.chain = chain
        self.settings = settings
        self.rules = rules_for(chain, settings)
        n, ways = len(chain.names), len(settings.hypotheses)
        self.bank = empty_bank(ways, n, settings.window, chain.n_values, chain.n_seen)
        self.first_doubt, self._least_doubt = doubt
        self.doubt = self.first_doubt
        self.gate = float(chi2.isf(settings.gate, chain.n_values))
        self._middle = float(chi2.median(chain.n_values))
        self.x = np.zeros(n)
        self.shares = np.full(ways, 1.0 / ways)
        self.leader = next(i for i, h in enumerate(settings.hypotheses) if h.curved)
        self.drifting = False
        self.events: deque[Event] = deque(maxlen=_EVENTS)
        self.surprises = np.zeros((2, ways))
        self._off = np.zeros(ways, np.bool_)
        # Early mistakes pass unnoticed as long as little is known.
        self._milestones = [settings.window * part // 4 - 1 for part in range(1, 5)]

    @property
    def leaves_something(self) -> bool:
        """Whether more is left unexplained than was allowed for at first."""
        return self.doubt > _LEFT * self.first_doubt

    @property
    def n_observations(self) -> int:
        """So far, believed or not."""
        return int(self.bank.counts[0])

    def learn(self, seen: Array) -> bool:
        """Learn from an observation (w,); tells whether it was believed."""
        bank, number = self.bank, self.n_observations
        believed = learn_one(
            self.chain.kernel, self.rules, bank, seen, self.doubt, self.gate,
            self.surprises, self._off,
        )  # fmt: skip
        for h in np.flatnonzero(self._off):
            relearn(self.chain.kernel, self.rules, bank, int(h), _ROUNDS)
        if not believed:
            believed = self._reconsider(number)
        elif number in self._milestones:
            self.resettle()
        self._adjust_doubt(believed)
        if number % BLOCK == BLOCK - 1:
            self._revive()
        self._summarise(number)
        return believed

    def _summarise(self, number: int) -> None:
        self.leader = int(beliefs(self.bank, self.shares))
        average(self.rules, self.bank, self.shares, self.x)
        drifting = float(self.shares[self.rules.walks > 0.0].sum())
        doubtful = 1.0 - drifting if self.drifting else drifting
        if number >= self.settings.window and doubtful > _SURE_OF_IT:
            self.drifting = not self.drifting
            kind, done = ("drift", "followed") if self.drifting else ("steady", "averaged")
            self.events.append(Event(number, kind, "", done))

    def _reconsider(self, number: int) -> bool:
        """An observation was not believed: outlier, change, or a mistake of the past?"""
        window = self.settings.window
        recent = self.recent_slots(_RUN)
        rejected = self.bank.weights[recent] == 0.0
        if number >= window and rejected.sum() >= 2 and self._change(recent, number):
            return True
        latest = self.bank.weights[self.recent_slots(_LOST)]
        lost = np.count_nonzero(latest == 0.0) > _MOST * len(latest)
        if number >= window and lost:
            self._start_again(number)
        if number < 2 * window or lost:
            self.resettle()
        if self.bank.weights[number % window] > 0.0:
            return True
        self.events.append(Event(number, "outlier", "", "left out"))
        return False

    def _start_again(self, number: int) -> None:
        """What was learned explains nothing any more: keep the priors and the window."""
        fresh = empty_bank(len(self.shares), len(self.x), 1, 1, 1)
        self.bank.olds[:] = fresh.olds
        self.bank.evidence[:] = 0.0
        self.bank.changed[:] = -1
        self.bank.asleep[:] = False
        self.events.append(Event(number, "lost", "", "started again from the window"))

    def recent_slots(self, most: int) -> Integers:
        """Slots of the latest observations, oldest first."""
        count, window = self.n_observations, self.settings.window
        return np.arange(max(count - min(most, window), 0), count) % window

    def _change(self, recent: Integers, number: int) -> bool:
        """Look for a change of one part that explains the recent surprises; re-learn it."""
        surprises = Surprises(self.chain, self.rules, self.bank, self.leader, self.gate)
        found = best_change(surprises, recent, self.settings.odds)
        if found is None:
            return False
        self.bank.changed[found.slots[0]] = found.change
        self.bank.weights[found.slots] = found.kept.astype(np.float64)
        self._relearn()
        group = self.chain.changes[found.change]
        most = int(np.argmax(np.abs(found.jump)))
        place = group.places[most]
        tolerance = float(self.rules.spreads[self.leader, place])
        self.events.append(
            Event(
                number - (len(found.slots) - 1), "change", group.words,
                f"re-learned from {int(found.kept.sum())} observations",
                float(found.jump[most]) * tolerance, float(found.std[most]) * tolerance,
                self.chain.units[place], self.chain.names[place],
            )
        )  # fmt: skip
        return bool(found.kept[-1])

    def resettle(self) -> None:
        """Fit the window anew from what was known before it; decide which are outliers."""
        ways = zip(self.settings.hypotheses, self.bank.asleep, strict=True)
        stiff = [h for h, (way, asleep) in enumerate(ways) if not (way.curved or asleep)]
        find_outliers(
            self.chain.kernel, self.rules, self.bank, (*stiff[:1], self.flexible()), self.gate
        )
        self._relearn()

    def _relearn(self) -> None:
        for h in np.flatnonzero(~self.bank.asleep):
            relearn(self.chain.kernel, self.rules, self.bank, int(h), _ROUNDS)

    def flexible(self) -> int:
        """The best hypothesis that has curves."""
        ways = self.settings.hypotheses
        curved = [h for h, way in enumerate(ways) if way.curved]
        return max(curved, key=lambda h: self.shares[h])

    def _adjust_doubt(self, believed: bool) -> None:
        """Half of all surprises should lie below their median; the doubt moves until they do.

        What is refused though it is not far from the gate shows tails that noise does not have.
        """
        n = self.n_observations
        if n < self.settings.patience:
            return
        surprise = self.surprises[0, self.leader]
        if believed:
            step = max(_STEP, _EARLY_STEP / n)
            self.doubt *= np.exp(step if surprise > self._middle else -step)
        elif surprise < _MILD * self.gate:
            self.doubt *= np.exp(_MILD_STEP)
        self.doubt = float(min(max(self.doubt, self._least_doubt), 1.0))

    def _revive(self) -> None:
        """A hypothesis that has lost touch starts again from what the best one knows."""
        curved = [h.curved for h in self.settings.hypotheses]
        if not curved[self.leader]:
            return
        # What has once had curves is never straight again.
        if self.n_observations >= 2 * self.settings.window:
            self.bank.asleep[:] |= ~np.array(curved) & (self.shares < _HOPELESS)
        for h in range(len(self.shares)):
            if h != self.leader and curved[h] and self.shares[h] < _HOPELESS:
                for part in (self.bank.roots, self.bank.olds, self.bank.d, self.bank.lines,
                             self.bank.gains):  # fmt: skip
                    part[h] = part[self.leader]
                self.bank.evidence[h] = self.bank.evidence[self.leader] - 5.0

    def covariance(self) -> Array:
        """(n, n) of the unknowns, over all hypotheses and between them."""
        n = len(self.x)
        total = np.zeros((n, n))
        for h, share in enumerate(self.shares):
            if share > 1e-6:
                spread = self.rules.spreads[h]
                half = solve_triangular(self.bank.roots[h, :, :n], np.diag(spread), trans=1).T
                off = spread * self.bank.d[h] - self.x
                total += share * (half @ half.T + np.outer(off, off))
        return total
