"""Verdicts in words, for every place that shows them."""

from collections.abc import Iterable

from handeye.thesis.judge import SHARE, Row, Verdict
from handeye.thesis.units import Scale, scale_for, show_interval, show_stated

VERDICTS: tuple[Verdict, ...] = ("reproduced", "not reproduced", "not testable")


def stated_text(row: Row) -> str:
    """What the thesis states, `-` for an ordering or shape."""
    return "-" if row.stated is None else show_stated(row.stated, row.unit, _scale(row))


def measured_text(row: Row) -> str:
    """What was measured, with its interval."""
    if row.measured is None:
        return "-"
    if row.unit == SHARE and row.replicates == 1:
        return "holds" if row.measured else "does not hold"
    if row.unit == SHARE:
        return f"holds in {row.measured * row.replicates:.0f} of {row.replicates}"
    half = 0.0 if row.low is None or row.high is None else (row.high - row.low) / 2.0
    return show_interval(row.measured, half, row.unit, _scale(row))


def tally(rows: Iterable[Row]) -> dict[Verdict, int]:
    """How many claims have each verdict."""
    given = [row.verdict for row in rows]
    return {verdict: given.count(verdict) for verdict in VERDICTS}


def sentence(text: str) -> str:
    """The text with a capital at its beginning."""
    return text[:1].upper() + text[1:]


def _scale(row: Row) -> Scale:
    return scale_for(row.measured or 0.0 if row.stated is None else row.stated, row.unit)
