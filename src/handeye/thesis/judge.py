"""Verdicts: what was measured against what was stated or asked for."""

import math
from dataclasses import asdict, dataclass
from typing import Literal

import numpy as np
from scipy.special import stdtrit

from handeye.arrays import Array
from handeye.errors import InvalidInput
from handeye.intervals import CONFIDENCE, wilson_interval
from handeye.thesis.claims import Claim
from handeye.thesis.records import Records
from handeye.thesis.shapes import SHAPES
from handeye.thesis.units import scale_for, show

Verdict = Literal["reproduced", "not reproduced", "met", "not met", "not testable", "not run"]
Interval = tuple[float, float]

SHARE = "fraction of replicates"
_ROUNDING = 1e-12


@dataclass(frozen=True)
class Row:
    """The outcome for one claim.

    stated          the thesis's or the target's figure in `unit`; None for an ordering or shape
    measured        mean over replicates; for an ordering or shape the share of them where it holds
    low, high       95 % interval of measured, or None with a single random replicate
    note            what a reader must know to judge the verdict
    """

    id: str
    stated: float | None
    unit: str
    measured: float | None
    low: float | None
    high: float | None
    replicates: int
    verdict: Verdict
    note: str

    def to_json(self) -> dict[str, str | int | float | None]:
        """The fields under their names."""
        return asdict(self)


def judge(claim: Claim, records: Records, *, deterministic: bool = False) -> Row:
    """The row of a claim that has a measure, from the records of its experiments.

    A claim that states a figure and more than that has a predicate too: it keeps both or neither.

    deterministic: nothing in them is random, so that the interval has no width.

    Raises:
        InvalidInput: a claim without a measure, or records that lack what it needs.
    """
    if claim.measure is None:
        raise InvalidInput(f"no experiment measures {claim.id} yet")
    if claim.value is None:
        return _judge_shape(claim, records, deterministic)
    values = _worst(claim, records.values(claim.measure), records)
    notes = [claim.note, _others(claim, records)]
    if not np.all(np.isfinite(values)):
        lost = int(np.sum(~np.isfinite(values)))
        notes.append(f"Not finite in {lost} of {len(values)} replicates.")
        return _row(claim, None, None, len(values), "not testable", notes)
    mean = float(values.mean())
    interval = (mean, mean) if deterministic else t_interval(values)
    if interval is None:
        notes.append("One replicate: no interval.")
    kept = agrees(claim, mean)
    if claim.id in SHAPES:
        finding = SHAPES[claim.id](records, claim.limits)
        kept = kept and finding.holds
        notes.insert(0, finding.note)
    verdict = _verdict(claim, kept)
    return _row(claim, mean, interval, len(values), verdict, notes)


def not_run(claim: Claim, why: str) -> Row:
    """The row of a claim whose experiment could not be run."""
    return _row(claim, None, None, 0, "not run", [why, claim.note])


def agrees(claim: Claim, measured: float) -> bool:
    """Whether a measured figure keeps the claim's rule; the limit itself does, rounding aside."""
    if claim.value is None or claim.tol is None:
        raise InvalidInput(f"{claim.id} states no figure with a tolerance")
    slack = claim.tol * abs(claim.value)
    edge = _ROUNDING * max(abs(claim.value), slack)
    excess = measured - claim.value
    match claim.rule:
        case "within":
            return abs(excess) <= slack + edge
        case "at_most":
            return excess <= slack + edge
        case "at_least":
            return -excess <= slack + edge
        case _:
            raise InvalidInput(f"{claim.id} is judged by a predicate, not by its value")


def t_interval(values: Array) -> Interval | None:
    """Student's 95 % interval of the mean of values (N,), None for fewer than two."""
    n = len(values)
    if n < 2:
        return None
    mean = float(values.mean())
    half = float(stdtrit(n - 1, 0.5 + CONFIDENCE / 2.0) * values.std(ddof=1) / math.sqrt(n))
    return mean - half, mean + half


def _judge_shape(claim: Claim, records: Records, deterministic: bool) -> Row:
    finding = SHAPES[claim.id](records, claim.limits)
    n, held = len(finding.held), sum(finding.held)
    share = held / n
    notes = [finding.note, claim.note]
    if deterministic:
        interval = (share, share)
    elif n < 2:
        interval = None
        notes.append("One replicate: no interval.")
    else:
        interval = wilson_interval(held, n)
    verdict = _verdict(claim, finding.holds)
    return _row(claim, share, interval, n, verdict, notes)


def _worst(claim: Claim, first: Array, records: Records) -> Array:
    """Of all that is measured for a claim, values (replicates,) with the worst mean by its rule."""

    def excess(values: Array) -> float:
        away = float(values.mean()) - (claim.value or 0.0)
        return {"at_most": away, "at_least": -away}.get(claim.rule, abs(away))

    return max((first, *map(records.values, claim.worst_of)), key=excess)


def _verdict(claim: Claim, kept: bool) -> Verdict:
    if claim.is_target:
        return "met" if kept else "not met"
    return "reproduced" if kept else "not reproduced"


def _row(
    claim: Claim,
    measured: float | None,
    interval: Interval | None,
    replicates: int,
    verdict: Verdict,
    notes: list[str],
) -> Row:
    low, high = interval or (None, None)
    unit = SHARE if claim.unit is None else claim.unit
    note = " ".join(part for part in notes if part)
    return Row(claim.id, claim.value, unit, measured, low, high, replicates, verdict, note)


def _others(claim: Claim, records: Records) -> str:
    """A sentence that quotes the other quantities of a claim, in its scale where units agree."""
    own = scale_for(claim.value or 0.0, claim.unit or "")
    quoted = [
        f"{other.what}: {show(float(records.values(other.measure).mean()), other.unit, scale)}"
        for other in claim.also
        for scale in [own if other.unit == claim.unit else None]
    ]
    text = "; ".join(quoted)
    return f"{text[0].upper()}{text[1:]}." if text else ""
