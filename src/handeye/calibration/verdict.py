"""Which rows of a run tell how good its result is, and why those."""

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from handeye.arrays import Array, Integers
from handeye.calibration.results import CalibrationResult, ErrorSummary

# Test-then-train errors this many times smaller than held-out ones call for a word.
_MUCH = 1.5
_PARTS = 5


@dataclass(frozen=True)
class Verdict:
    """The rows on which a result is to be judged.

    by             held out, or tested before they were learned
    rows (M,)      indices into the arrays of the run
    before, after  (M, k) their errors [m]
    alike (M,)     errors that may depend on each other
    where          the rows in words, for a caption
    advice         which number to trust, and why
    """

    by: Literal["held_out", "online"]
    rows: Integers
    before: Array
    after: Array
    alike: Integers
    where: str
    advice: str

    @property
    def summary_before(self) -> ErrorSummary:
        """Statistics without learning."""
        return ErrorSummary.of(self.before, self.alike)

    @property
    def summary_after(self) -> ErrorSummary:
        """Statistics of the result."""
        return ErrorSummary.of(self.after, self.alike)


def verdict(result: CalibrationResult) -> Verdict:
    """Judge a run by the rows that fit the robot as it is now.

    Held-out rows count, all of them since the robot's last change. While it drifts, a row left out
    belongs to another robot; then, and where no row was held out, what counts are errors made just
    before a row was learned, in the last third of the run and since the last change.
    """
    found = _judged(result)
    wild = _without_wild(result, found)
    advice = f"{found.advice}. {wild}" if wild else found.advice
    if result.suspects:
        mistakes = "; ".join(result.suspects)
        advice = (
            f"the log does not fit this arm: {mistakes}; correct it and calibrate again. {advice}"
        )
    return replace(found, advice=advice)


def _without_wild(result: CalibrationResult, found: Verdict) -> str:
    """What rows that are not believed do to the mean error, if much."""
    if result.influence is None:
        return ""
    wild = result.influence.left_out[found.rows]
    if not wild.any() or wild.all():
        return ""
    mean, rest = found.summary_after.mean, ErrorSummary.of(found.after[~wild]).mean
    if mean < _MUCH * rest:
        return ""
    return (
        f"{int(wild.sum())} of these rows are not believed; the mean error of the others is "
        f"{1e3 * rest:.3g} mm"
    )


def _judged(result: CalibrationResult) -> Verdict:
    held = result.held_out
    if held is None or not len(held.rows):
        return _online(result)
    after = ErrorSummary.of(held.after, held.alike)
    if result.drifting and _online(result).summary_after.mean < after.mean:
        return _online(result)
    words = f"{len(held.rows):,} observations held out"
    reason = _HOW[held.how]
    if result.since:
        words += " since the robot changed"
        reason += f", all of them since the robot changed at row {_row(result, result.since)}"
    late = _online(result)
    tested = late.summary_after
    if tested.mean * _MUCH < after.mean:
        reason += (
            f". Rows of the last third, tested just before they were learned, do better "
            f"({1e3 * tested.mean:.3g} mm against {1e3 * after.mean:.3g} mm): either "
            "the robot moved while the log was recorded, or neighbouring rows are alike"
        )
    return Verdict("held_out", held.rows, held.before, held.after, held.alike, words, reason)


_HOW = {
    "blocks": "trust the held-out rows: each was predicted from the other blocks of time alone",
    "random": "trust the held-out rows with care: they lie between rows that were learned, which "
    "flatters; blocks of time are stricter",
}


def _online(result: CalibrationResult) -> Verdict:
    n = len(result.before)
    first = max(n * 2 // 3, result.since)
    rows = np.arange(min(first, n - 1), n)
    where = "last third of the run, each tested before it was learned"
    reason = "trust the rows tested just before they were learned"
    if result.drifting:
        reason += ": the robot was drifting, so that a row left out belongs to another robot"
    elif result.since > n * 2 // 3:
        where = f"{len(rows):,} rows since the robot changed, each tested before it was learned"
        reason += (
            f": too few came after the robot changed at row {_row(result, result.since)} to hold "
            "some out; record more"
        )
    elif result.held_out is None:
        reason += ", for none was held out"
    alike = np.arange(len(rows)) * _PARTS // len(rows)
    return Verdict("online", rows, result.before[rows], result.online[rows], alike, where, reason)


def _row(result: CalibrationResult, index: int) -> int:
    return index if result.rows is None else int(result.rows[index])
