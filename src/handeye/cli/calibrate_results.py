"""What `handeye calibrate` found, as data and as tables."""

from dataclasses import asdict
from typing import Any

import numpy as np
from rich.console import Console

from handeye.arrays import Array, Integers
from handeye.calibration.contributions import contributions
from handeye.calibration.expected import expected_summary
from handeye.calibration.log_run import Calibration
from handeye.calibration.results import CalibrationResult, ErrorSummary
from handeye.calibration.verdict import verdict
from handeye.cli.console import out, table
from handeye.cli.found import WORST, between, print_open, print_parts, print_rejected, say

_UNCHANGED = 0.05
_WITH = {
    "placement": "nominal robot",
    "geometry": "geometry alone",
    "error curves": "and error curves",
    "network": "network",
    "parameters": "parameters",
    "all that was learned": "others learned",
}


def as_data(result: CalibrationResult) -> dict[str, Any]:
    """Everything about a run that another program may want; docs/reference/json.md has the keys."""
    judged = verdict(result)
    before, after = judged.summary_before, judged.summary_after
    turns = _turns(result)
    held, pulled = result.held_out, result.influence
    return {
        "robot": result.robot,
        "log": result.log,
        "method": result.method,
        "status": _status(before, after),
        "advice": judged.advice,
        "suspects": list(result.suspects),
        "judged_by": judged.by,
        "n_observations": len(result.before),
        "n_neurons": None if result.n_neurons is None else int(result.n_neurons[-1]),
        "n_rejected": len(result.rejected),
        "rejected": list(result.rejected),
        "error_before": asdict(before),
        "error_after": asdict(after),
        "orientation_before": None if turns is None else asdict(turns[0]),
        "orientation_after": None if turns is None else asdict(turns[1]),
        "errors": result.summary(),
        "contributions": [asdict(part) for part in contributions(result)],
        "parameters": [asdict(parameter) for parameter in result.parameters],
        "parts": [asdict(part) for part in result.parts],
        "undetermined": list(result.undetermined),
        "findings": list(result.findings),
        "changed_at_row": _row(result, result.since) if result.since else None,
        "drifting": result.drifting,
        "validation": None
        if held is None
        else {
            "how": held.how,
            "row": _rows(result, held.rows),
            "part": held.parts.tolist(),
            "moves": [] if held.moves is None else held.moves.tolist(),
        },
        "expected_error": expected_summary(result) or None,
        "influence": None
        if pulled is None
        else {
            "row": _rows(result, np.arange(len(result.before))),
            "residual": _numbers(pulled.residual),
            "times_expected": _numbers(pulled.times),
            "expected": None if pulled.expected is None else _numbers(pulled.expected),
            "left_out": pulled.left_out.tolist(),
        },
        "unit": "m",
    }


def print_results(done: Calibration, files: dict[str, Any]) -> None:
    """Tables and findings for a person, and where the files are."""
    result, console = done.result, out()
    _print_errors(result, console)
    say(console, "advice", [verdict(result).advice])
    say(console, "frames", [done.frames])
    if result.n_neurons is not None:
        say(console, "neurons", [str(result.n_neurons[-1])])
    print_parts(console, "Which part was off, and by how much", result.parts)
    say(console, "findings", result.findings)
    print_open(console, result.undetermined)
    _print_influence(result, console)
    print_rejected(console, result.rejected)
    for name, path in files.items():
        if path is not None:
            say(console, name, [str(path)])


def _print_errors(result: CalibrationResult, console: Console) -> None:
    held = result.held_out
    rows = {
        "all rows, nominal robot": ErrorSummary.of(result.before),
        "all rows, tested, then learned": ErrorSummary.of(result.online),
    }
    if held is not None:
        which = "blocks held out" if held.how == "blocks" else "third held out"
        rows |= {f"{which}, {_WITH[part.part]}": part.error for part in contributions(result)}
    judged = verdict(result)
    if judged.by == "online":
        rows["last rows, tested, then learned"] = judged.summary_after
    shown = table(
        f"{result.robot}: position error of the hand in mm",
        "", "rows", "mean", "95 % interval", "rms", "95 %", "max",
    )  # fmt: skip
    for name, summary in rows.items():
        shown.add_row(name, *_cells(summary, 1e3))
    turned = [part for part in contributions(result) if part.orientation is not None]
    if turned:
        shown.add_section()
        for part in turned:
            assert part.orientation is not None
            shown.add_row(f"{_WITH[part.part]}, in degrees", *_cells(part.orientation, 1.0))
    console.print(shown)


def _cells(s: ErrorSummary, scale: float) -> list[str]:
    rms, p95, most = (f"{scale * v:#.3g}" for v in (s.rms, s.p95, s.max))
    return [str(s.n), f"{scale * s.mean:#.3g}", between(s, scale), rms, p95, most]


def _print_influence(result: CalibrationResult, console: Console) -> None:
    pulled = result.influence
    if pulled is None:
        return
    shown = table(
        "Rows to look at first", "row", "time in s", "error in mm", "times the ordinary", "",
        left=0,
    )  # fmt: skip
    for i in pulled.worst(WORST).tolist():
        time = "" if result.times is None else f"{result.times[i]:.6g}"
        said = "not believed" if pulled.left_out[i] else ""
        numbers = f"{1e3 * pulled.residual[i]:#.3g}", f"{pulled.times[i]:.1f}"
        shown.add_row(str(_row(result, i)), time, *numbers, said)
    console.print(shown)


def _status(before: ErrorSummary, after: ErrorSummary) -> str:
    if after.mean < (1.0 - _UNCHANGED) * before.mean:
        return "improved"
    return "unchanged" if after.mean <= (1.0 + _UNCHANGED) * before.mean else "worse"


def _turns(result: CalibrationResult) -> tuple[ErrorSummary, ErrorSummary] | None:
    """Orientation errors of held-out rows in degrees, before and after."""
    held = result.held_out
    if held is None or held.turns_before is None or held.turns_after is None:
        return None
    pair = (np.degrees(held.turns_before), np.degrees(held.turns_after))
    return ErrorSummary.of(pair[0], held.alike), ErrorSummary.of(pair[1], held.alike)


def _row(result: CalibrationResult, index: int) -> int:
    return index if result.rows is None else int(result.rows[index])


def _rows(result: CalibrationResult, indices: Integers) -> list[int]:
    return [_row(result, i) for i in indices.tolist()]


def _numbers(values: Array) -> list[float | None]:
    """JSON knows no nan."""
    return [None if np.isnan(value) else float(value) for value in values]
