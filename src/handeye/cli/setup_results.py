"""What `handeye calibrate --setup` found, as data and as tables."""

from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.markup import escape

from handeye.calibration.results import ErrorSummary
from handeye.calibration.setups.run import SetupResult
from handeye.calibration.setups.words import SHOWN, advice, found_words
from handeye.cli.console import out, table
from handeye.cli.found import WORST, between, print_open, print_parts, print_rejected, say


def as_data(result: SetupResult, name: str) -> dict[str, Any]:
    """Everything about a run that another program may want; docs/reference/json.md has the keys."""
    fit = result.fit
    pairs = {channel: errors.summaries() for channel, errors in result.errors.items()}
    metres = _first(result, "m")
    turns = _first(result, "rad")
    return {
        "robot": result.described.arm.name,
        "log": name,
        "method": "setup",
        "status": result.status,
        "advice": advice(held_out=result.held_out),
        "judged_by": "held_out" if result.held_out else "fitted",
        "n_observations": result.n_rows,
        "n_rejected": len(result.rejected),
        "rejected": list(result.rejected),
        "error_before": None if metres is None else asdict(pairs[metres][0]),
        "error_after": None if metres is None else asdict(pairs[metres][1]),
        "orientation_before": None if turns is None else _degrees(pairs[turns][0]),
        "orientation_after": None if turns is None else _degrees(pairs[turns][1]),
        "channels": {
            channel: {
                "unit": result.errors[channel].unit,
                "before": asdict(before),
                "after": asdict(after),
                "median_before": result.errors[channel].medians()[0],
                "median_after": result.errors[channel].medians()[1],
                "noise": fit.noise[channel],
            }
            for channel, (before, after) in pairs.items()
        },
        "parameters": [asdict(parameter) for parameter in result.parameters],
        "carried_by": dict(result.carried_by),
        "recordings": {
            source.file: source.report.as_data()
            for source in result.described.sources
            if source.report is not None
        },
        "parts": [asdict(part) for part in result.parts],
        "undetermined": list(result.undetermined),
        "influence": [
            {"channel": channel, **_influence(result, channel)} for channel in result.errors
        ],
        "unit": "m",
    }


def _influence(result: SetupResult, channel: str) -> dict[str, Any]:
    errors = result.errors[channel]
    places = [result.source(channel, k) for k in range(len(errors.row))]
    return {
        "file": [file for file, _ in places],
        "row": [row for _, row in places],
        "residual": np.linalg.norm(errors.after, axis=1).tolist(),
        "times_expected": errors.times.tolist(),
        "left_out": result.doubts(channel).tolist(),
    }


def print_results(result: SetupResult, name: str, files: dict[str, Any]) -> None:
    """Tables for a person, and where the files are."""
    console = out()
    _print_errors(result, name, console)
    say(console, "advice", [advice(held_out=result.held_out)])
    _print_found(result, console)
    print_parts(console, "Which part of the arm was off, and by how much", result.parts)
    print_open(console, result.undetermined)
    _print_worst(result, console)
    print_rejected(console, result.rejected)
    heads = {"camera_info": "cameras", "hand_eye": "sensors"}
    for what, path in files.items():
        if path is not None:
            say(console, heads.get(what, what), [str(path)])


def _print_errors(result: SetupResult, name: str, console: Console) -> None:
    which = "blocks of rows held out" if result.held_out else "rows that were fitted"
    shown = table(
        f"{result.described.arm.name}, {name}: errors of {which}",
        "", "rows", "median", "mean", "95 % interval", "95 %", "max",
    )  # fmt: skip
    for channel, errors in result.errors.items():
        unit, times = SHOWN[errors.unit]
        labels = (f"{channel} [{unit}], nominal", "  as found")
        both = zip(labels, errors.medians(), errors.summaries(), strict=True)
        for label, median, summary in both:
            shown.add_row(escape(label), *_cells(median, summary, times))
        shown.add_section()
    console.print(shown)


def _print_found(result: SetupResult, console: Console) -> None:
    shown = table("What was found beside the arm", "", "", "found", "±", "stated", left=2)
    for name, parameters in result.beside.items():
        for i, one in enumerate(parameters):
            last = i + 1 == len(parameters)
            cells = ("" if i else result.titled(name), *found_words(name, one))
            shown.add_row(*map(escape, cells), end_section=last)
    if result.beside:
        console.print(shown)


def _print_worst(result: SetupResult, console: Console) -> None:
    shown = table("Rows to look at first", "file", "row", "", "error", "times the ordinary", "")
    for channel, k in result.worst(WORST):
        errors = result.errors[channel]
        unit, times = SHOWN[errors.unit]
        file, row = result.source(channel, k)
        size = times * float(np.linalg.norm(errors.after[k]))
        said = "not believed" if result.doubts(channel)[k] else ""
        shown.add_row(
            Path(file).name, str(row), channel,
            f"{size:#.3g} {unit}", f"{errors.times[k]:.1f}", said,
        )  # fmt: skip
    console.print(shown)


def _cells(median: float, s: ErrorSummary, scale: float) -> list[str]:
    middle, mean, p95, most = (f"{scale * v:#.3g}" for v in (median, s.mean, s.p95, s.max))
    return [str(s.n), middle, mean, between(s, scale), p95, most]


def _first(result: SetupResult, unit: str) -> str | None:
    """The first channel in this unit."""
    return next((name for name, one in result.errors.items() if one.unit == unit), None)


def _degrees(summary: ErrorSummary) -> dict[str, Any]:
    values = asdict(summary)
    interval = values.pop("interval")
    turned = {k: v if k == "n" else float(np.degrees(v)) for k, v in values.items()}
    ends = None if interval is None else [float(np.degrees(end)) for end in interval]
    return {**turned, "interval": ends}
