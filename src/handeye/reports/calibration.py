"""The page that tells how a calibration went."""

from pathlib import Path
from typing import NamedTuple

from handeye.arrays import Array
from handeye.calibration.results import CalibrationResult, ErrorSummary
from handeye.reports.figures import (
    error_distribution,
    error_map,
    residuals_by_joint,
    running_error,
)
from handeye.reports.page import (
    FigureBlock,
    Notes,
    Page,
    Section,
    StatTiles,
    Table,
    Tile,
    Tone,
)
from handeye.reports.style import filled, length, length_unit, significant


class _Verdict(NamedTuple):
    """The rows on which the result is judged, and the errors there before and after [m]."""

    joints: Array
    positions: Array
    before: Array
    after: Array
    where: str


def calibration_page(result: CalibrationResult, *, date: str = "") -> Page:
    """Headline, numbers, pictures and settings of one run over a log.

    Judged on held-out rows when there are any, else on the last third of the rows, test-then-train.
    Raises InvalidInput for a run without rows.
    """
    filled(result.before, "errors before learning")
    filled(result.online, "errors while learning")
    judged = _judged(result)
    filled(judged.after, "held-out errors after learning")
    before, after = ErrorSummary.of(judged.before), ErrorSummary.of(judged.after)
    return Page(
        title="Hand-eye calibration report",
        headline=_headline(before.mean, after.mean),
        subtitle=f"{result.robot}, from {Path(result.log).name}. Method: {result.method}.",
        sections=[
            Section("", [_tiles(result, judged.where, before, after)]),
            Section("In numbers", [_table(result)]),
            *_findings(result),
            Section("Learning while working", [_running(result)]),
            Section("Where the hand misses", _places(result, judged)),
            *_rejected(result),
        ],
        settings=result.settings,
        date=date,
    )


def _findings(result: CalibrationResult) -> list[Section]:
    if not result.findings:
        return []
    return [Section("What was found", [Notes("State of the robot", result.findings)])]


def _judged(result: CalibrationResult) -> _Verdict:
    held = result.held_out
    if held is not None and len(held.rows):
        joints, positions = result.joints[held.rows], result.positions[held.rows]
        where = f"{len(held.rows):,} observations held out"
        return _Verdict(joints, positions, held.before, held.after, where)
    last = slice(len(result.before) * 2 // 3, None)
    return _Verdict(
        result.joints[last],
        result.positions[last],
        result.before[last],
        result.online[last],
        "last third of the run, each tested before it was learned",
    )


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
    rejected = f"{len(result.rejected):,} more rejected" if result.rejected else "none rejected"
    tiles = [
        _length_tile("Mean error before", before.mean, after.mean, where, "neutral"),
        _length_tile(
            "Mean error after", after.mean, before.mean, change, "good" if better else "bad"
        ),
        Tile("Observations", f"{len(result.before):,}", note=rejected),
    ]
    if result.n_neurons is not None:
        tiles.append(Tile("Neurons", f"{int(result.n_neurons[-1]):,}", note="in use at the end"))
    return StatTiles(tiles)


def _length_tile(label: str, value: float, beside: float, note: str, tone: Tone) -> Tile:
    number, unit = length(value, beside).split()
    return Tile(label, number, unit, note, tone)


_STAGES = {
    "before": "All rows, without learning",
    "online": "All rows, with learning (test, then train)",
    "held_out_before": "Held-out rows, without learning",
    "held_out_after": "Held-out rows, after learning",
}


def _table(result: CalibrationResult) -> Table:
    rows = [
        [_STAGES[stage], f"{numbers['n']:,}"]
        + [significant(1e3 * numbers[key], 3) for key in ("mean", "rms", "p95", "max")]
        for stage, numbers in result.summary().items()
    ]
    return Table(
        columns=("Position error", "Rows", "Mean [mm]", "RMS [mm]", "95 % [mm]", "Max [mm]"),
        rows=rows,
        caption="Distance between where the hand was seen and where it was expected.",
        emphasis=frozenset({i for i in (1, 3) if i < len(rows)}),
    )


def _running(result: CalibrationResult) -> FigureBlock:
    below = "" if result.n_neurons is None else " Below, the size of the network."
    return FigureBlock(
        running_error(result.before, result.online, neurons=result.n_neurons),
        "Every observation is predicted first and learned from afterwards. Dots are single "
        "observations, lines the mean of successive stretches: the gap between them is what "
        f"learning has gained so far.{below}",
        "Position error of each observation over the run, with and without learning.",
    )


def _places(result: CalibrationResult, judged: _Verdict) -> list[FigureBlock]:
    names = result.joint_names
    unit = length_unit(ErrorSummary.of(judged.before).p95).name
    return [
        FigureBlock(
            error_map(judged.positions, judged.before, judged.after),
            "Arrows point from where the hand was expected to where it was seen. Order among them "
            "is what a better model can remove; what is left should point every way and be short. "
            f"Rows: {judged.where}.",
            "Maps of the position error over the workspace before and after learning.",
        ),
        FigureBlock(
            residuals_by_joint(names, judged.joints, judged.before, judged.after),
            "A slope or a wave along one joint says that this joint is part of the error. Lines "
            "are medians; after learning they should lie low and flat.",
            f"Position error over the angle of each joint ({', '.join(names)}).",
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
