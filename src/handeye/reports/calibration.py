"""The page that tells how a calibration went."""

from pathlib import Path

import numpy as np

from handeye.calibration.results import CalibrationResult, ErrorSummary
from handeye.calibration.verdict import Verdict, verdict
from handeye.reports.calibration_expected import expected_section
from handeye.reports.calibration_parts import (
    contributions_table,
    open_section,
    parts_section,
    rows_section,
)
from handeye.reports.figures import (
    error_distribution,
    error_in_space,
    error_map,
    residuals_by_joint,
    running_error,
)
from handeye.reports.page import (
    FigureBlock,
    Notes,
    Page,
    Prose,
    Section,
    StatTiles,
    Table,
    Tile,
    Tone,
)
from handeye.reports.style import filled, length, length_unit, significant


def calibration_page(result: CalibrationResult, *, date: str = "") -> Page:
    """Headline, numbers, pictures and settings of one run over a log.

    Judged as `verdict` says: on held-out rows, or on rows tested just before they were learned.
    Raises InvalidInput for a run without rows.
    """
    filled(result.before, "errors before learning")
    filled(result.online, "errors while learning")
    if result.held_out is not None:
        filled(result.held_out.after, "held-out errors after learning")
    judged = verdict(result)
    before, after = judged.summary_before, judged.summary_after
    return Page(
        title="Hand-eye calibration report",
        headline=_headline(before.mean, after.mean),
        subtitle=f"{result.robot}, from {Path(result.log).name}. Method: {result.method}.",
        sections=[
            Section("", [_tiles(result, judged.where, before, after), Prose(_advice(judged))]),
            Section("In numbers", [_table(result), *contributions_table(result)]),
            *parts_section(result),
            *_findings(result),
            *open_section(result),
            Section("Learning while working", [_running(result)]),
            Section("Where the hand misses", _places(result, judged)),
            *expected_section(result),
            *rows_section(result),
            *_rejected(result),
        ],
        settings=result.settings,
        date=date,
    )


def _findings(result: CalibrationResult) -> list[Section]:
    if not result.findings:
        return []
    return [Section("What was found", [Notes("State of the robot", result.findings)])]


def _advice(judged: Verdict) -> str:
    return f"{judged.advice[0].upper()}{judged.advice[1:]}."


def _headline(before: float, after: float) -> str:
    now = f"lands {length(after, beside=before)} from where the eye sees it"
    if after < 0.95 * before:
        return f"The hand now {now}; it was {length(before, beside=after)}."
    if after <= 1.05 * before:
        return f"Learning changed little: the hand {now}, as before."
    return f"Learning did not help here: the hand now {now}; it was {length(before)}."


def _tiles(
    result: CalibrationResult, where: str, before: ErrorSummary, after: ErrorSummary
) -> StatTiles:
    better = after.mean < before.mean
    change = (
        f"{100 * abs(1 - after.mean / before.mean):.0f} % {'less' if better else 'more'}"
        if before.mean
        else ""
    )
    if after.interval is not None:
        change += f", 95 % interval {_between(after)}"
    rejected = f"{len(result.rejected):,} more rejected" if result.rejected else "none rejected"
    tiles = [
        _length_tile("Mean error before", before.mean, after.mean, where, "neutral"),
        _length_tile(
            "Mean error after", after.mean, before.mean, change, "good" if better else "bad"
        ),
        Tile("Observations", f"{len(result.before):,}", note=rejected),
    ]
    held = result.held_out
    if held is not None and held.turns_before is not None and held.turns_after is not None:
        was, now = (
            float(np.degrees(ErrorSummary.of(t).mean))
            for t in (held.turns_before, held.turns_after)
        )
        tone: Tone = "good" if now < was else "neutral"
        tiles.append(
            Tile(
                "Mean turn after", significant(now, 2), "°", f"it was {significant(was, 2)}°", tone
            )
        )
    if result.n_neurons is not None:
        tiles.append(Tile("Neurons", f"{int(result.n_neurons[-1]):,}", note="in use at the end"))
    return StatTiles(tiles)


def _between(summary: ErrorSummary) -> str:
    low, high = summary.interval or (summary.mean, summary.mean)
    return f"{length(low, beside=high)} to {length(high)}"


def _length_tile(label: str, value: float, beside: float, note: str, tone: Tone) -> Tile:
    number, unit = length(value, beside).split()
    return Tile(label, number, unit, note, tone)


_STAGES = {
    "before": "All rows, without learning",
    "online": "All rows, with learning (test, then train)",
    "held_out_before": "Held-out rows, without learning",
    "held_out_rigid": "Held-out rows, lengths, directions and zeros alone",
    "held_out_after": "Held-out rows, after learning",
}


def _table(result: CalibrationResult) -> Table:
    rows = [
        [_STAGES[stage], f"{numbers['n']:,}"]
        + [significant(1e3 * numbers[key], 3) for key in ("mean", "rms", "p95", "max")]
        + [_interval(numbers["interval"])]
        for stage, numbers in result.summary().items()
    ]
    heads = ("Position error", "Rows", "Mean [mm]", "RMS [mm]", "95 % [mm]", "Max [mm]")
    return Table(
        columns=(*heads, "Interval of the mean [mm]"),
        rows=rows,
        caption="Distance between where the hand was seen and where it was expected.",
        emphasis=frozenset({1, len(rows) - 1}),
    )


def _interval(interval: tuple[float, float] | None) -> str:
    return " to ".join(significant(1e3 * end, 3) for end in interval) if interval else ""


def _running(result: CalibrationResult) -> FigureBlock:
    below = "" if result.n_neurons is None else " Below, the size of the network."
    return FigureBlock(
        running_error(result.before, result.online, neurons=result.n_neurons),
        "Every observation is predicted first and learned from afterwards. Dots are single "
        "observations, lines the mean of successive stretches: the gap between them is what "
        f"learning has gained so far.{below}",
        "Position error of each observation over the run, with and without learning.",
    )


def _places(result: CalibrationResult, judged: Verdict) -> list[FigureBlock]:
    names = result.joint_names
    unit = length_unit(ErrorSummary.of(judged.before).p95).name
    positions, joints = result.positions[judged.rows], result.joints[judged.rows]
    in_space = FigureBlock(
        error_in_space(positions, judged.before, judged.after),
        "The same in three dimensions: each line begins where the hand was seen and points along "
        "the error.",
        "Error lines in the three-dimensional workspace before and after learning.",
    )
    flat = np.ptp(positions[:, 2]) <= 0.02 * np.ptp(positions, axis=0).max()
    return [
        FigureBlock(
            error_map(positions, judged.before, judged.after),
            "Arrows point from where the hand was expected to where it was seen. Order among them "
            "is what a better model can remove; what is left should point every way and be short. "
            f"Rows: {judged.where}.",
            "Maps of the position error over the workspace before and after learning.",
        ),
        *([] if flat else [in_space]),
        FigureBlock(
            residuals_by_joint(names, joints, judged.before, judged.after, sliding=result.sliding),
            "A slope or a wave along one joint says that this joint is part of the error. Lines "
            "are medians; after learning they should lie low and flat.",
            f"Position error over the reading of each joint ({', '.join(names)}).",
        ),
        FigureBlock(
            error_distribution(judged.before, judged.after),
            "Further left is better. Dots mark the median and the error that 95 % stay below.",
            f"Cumulative distribution of the position error in {unit}, before and after learning.",
        ),
    ]


def _rejected(result: CalibrationResult) -> list[Section]:
    if not result.rejected:
        return []
    n = len(result.rejected)
    title = f"{n:,} {'row was' if n == 1 else 'rows were'} rejected and took no part"
    return [Section("Rejected rows", [Notes(title, result.rejected, folded=n > 8)])]
