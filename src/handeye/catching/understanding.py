"""Who is it, and does it behave as predicted? The same for the ball and for the arm (4.4.2)."""

from collections.abc import Sequence

import numpy as np

from handeye.arrays import Array, Booleans, Integers
from handeye.catching.comparator import Comparator
from handeye.catching.memory import ShortTermMemory
from handeye.catching.recognition import UNKNOWN, Recogniser
from handeye.catching.signals import read
from handeye.catching.skills import Skill


class Understanding:
    """Identity, surprise and comprehension of a ball or an arm in N trials.

    A known identity enables its state prediction net. When the comparator finds that the
    predictions miss, the identity is dropped, and the recognition net is asked at every tick until
    it names one; then comparing begins anew. This goes on in mid-trial. The comprehension flag is
    up while the streams agree.

    Args:
        name: of the thing; its streams in memory carry it.
        states: the state prediction skill of each identity.
        recogniser: of these identities.
        comparator: says how surprising the predictions of a state skill were.
        believed: identity (N,) at the start, UNKNOWN where there is none.
        try_all: while it is unknown who it is, all state nets predict, and who predicts clearly
            best is chosen, whatever the recognition net says. Not in the thesis.
    """

    def __init__(
        self,
        name: str,
        states: Sequence[Skill],
        recogniser: Recogniser,
        comparator: Comparator,
        believed: Integers,
        *,
        try_all: bool,
    ) -> None:
        self.identity = believed.copy()
        """Believed now; UNKNOWN while surprised and not yet recognised."""
        self.latest = believed.copy()
        """Believed now or last."""
        self.comprehended: Booleans = np.zeros(len(believed), np.bool_)
        self.surprise = np.full(len(believed), np.nan)
        """Of the believed identity's predictions; NaN without enough data."""
        self._states = states
        self._recogniser = recogniser
        self._comparator = comparator
        self._try_all = try_all
        self._streams = discrepancy_streams(name, len(states))
        self._predicted = np.full(
            (len(states), len(believed), len(states[0].table.outputs)), np.nan
        )

    def judge(self, memory: ShortTermMemory) -> None:
        """Compare the predictions for this tick with what was sensed; drop and find identities."""
        surprises = self._compare(memory)
        self.surprise = surprises[self.identity, np.arange(self.identity.size)]
        self.surprise[self.identity == UNKNOWN] = np.nan
        surprised = self.surprise >= 1.0
        if surprised.any():
            self.identity[surprised] = UNKNOWN
            surprises[:, surprised] = np.nan
            for stream in self._streams:
                memory.forget(stream, surprised)
        self._recognise(memory, surprises)
        self.comprehended = (self.identity != UNKNOWN) & (self.surprise < 1.0)

    def expect(self, memory: ShortTermMemory) -> None:
        """Predict the next tick with the enabled state nets."""
        self._predicted[:] = np.nan
        inputs = read(self._states[0].table.inputs, memory)
        reached = ~np.isnan(inputs).any(axis=1)
        for identity, state in enumerate(self._states):
            enabled = self.identity == identity
            if self._try_all:
                enabled |= self.identity == UNKNOWN
            rows = np.flatnonzero(reached & enabled)
            if rows.size:
                self._predicted[identity, rows] = state.answer(inputs[rows])

    def _compare(self, memory: ShortTermMemory) -> Array:
        """Surprise (K, N) of each identity's predictions; NaN without enough data."""
        table = self._states[0].table
        observed = read(table.outputs, memory, table.ahead)
        surprises = np.empty(self._predicted.shape[:2])
        for k, stream in enumerate(self._streams):
            missed = self._comparator.discrepancy(self._predicted[k], observed)
            memory.record(stream, missed)
            latest = memory.latest(stream, self._comparator.window)
            surprises[k] = self._comparator.surprise(latest)
        return surprises

    def _recognise(self, memory: ShortTermMemory, surprises: Array) -> None:
        """Find out who the unknown are."""
        rows = np.flatnonzero(self.identity == UNKNOWN)
        if rows.size == 0:
            return
        chosen = self._recogniser.choose(memory, rows)
        if self._try_all:
            chosen = _tried(surprises[:, rows], chosen, self.latest[rows])
        self.identity[rows] = chosen
        named = chosen != UNKNOWN
        self.latest[rows[named]] = chosen[named]
        if self._try_all:
            self._start_anew(memory, surprises, rows[named])

    def _start_anew(self, memory: ShortTermMemory, surprises: Array, rows: Integers) -> None:
        """Go on with what the tried identity predicted, unless that was poor."""
        own = surprises[self.identity[rows], rows]
        self.surprise[rows] = np.where(own < 1.0, own, np.nan)
        poor = np.zeros(self.identity.size, np.bool_)
        poor[rows[own >= 1.0]] = True
        for stream in self._streams:
            memory.forget(stream, poor)


def _tried(surprises: Array, chosen: Integers, latest: Integers) -> Integers:
    """Who (R,) it is, from the surprises (K, R) of all identities' predictions.

    The latest identity if its predictions hold again: one surprise is no proof of a change. Else
    who predicts at least twice as well as all others, else the chosen ones. UNKNOWN as long as one
    is without enough data.
    """
    order = np.sort(surprises, axis=0)
    clear = order[0] <= 0.5 * order[min(1, len(order) - 1)]
    best = np.where(clear, np.nan_to_num(surprises, nan=np.inf).argmin(axis=0), chosen)
    holds = (latest != UNKNOWN) & (surprises[latest, np.arange(latest.size)] < 1.0)
    return np.where(np.isnan(surprises).any(axis=0), UNKNOWN, np.where(holds, latest, best))


def discrepancy_streams(name: str, identities: int) -> list[str]:
    """Names of the memory's streams of the discrepancies of each identity's predictions."""
    return [f"{name}_discrepancy_{identity}" for identity in range(identities)]
