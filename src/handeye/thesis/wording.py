"""Verdicts in words, for every place that shows them."""

from collections.abc import Iterable

from handeye.thesis.claims import Claim, claims_by_id
from handeye.thesis.judge import SHARE, Row, Verdict
from handeye.thesis.units import Scale, scale_for, show_interval, show_stated

VERDICTS: tuple[Verdict, ...] = (
    "reproduced", "not reproduced", "met", "not met", "not testable", "not run",
)  # fmt: skip
TARGETS = "Better than the thesis"
"""The name of what is aimed at beyond it."""


def apart(rows: Iterable[Row]) -> tuple[list[Row], list[Row]]:
    """The rows of the thesis's claims, and those of targets."""
    given = list(rows)
    targets = [row for row in given if claims_by_id()[row.id].is_target]
    return [row for row in given if row not in targets], targets


def stated_text(row: Row) -> str:
    """What the thesis states, `-` for an ordering or shape; of a target, what is asked for."""
    if row.stated is None:
        return "-"
    figure = show_stated(row.stated, row.unit, _scale(row))
    claim = claims_by_id()[row.id]
    return f"{_bound(claim)}{figure}" if claim.is_target else figure


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


def kept(row: Row) -> bool:
    """Whether the verdict is a good one."""
    return row.verdict in {"reproduced", "met"}


def sentence(text: str) -> str:
    """The text with a capital at its beginning."""
    return text[:1].upper() + text[1:]


def _bound(claim: Claim) -> str:
    match claim.rule:
        case "at_most":
            return "at most "
        case "at_least":
            return "at least "
        case _:
            return f"within {100.0 * (claim.tol or 0.0):g} % of "


def _scale(row: Row) -> Scale:
    return scale_for(row.measured or 0.0 if row.stated is None else row.stated, row.unit)
