"""How an arm is learned from a log, row by row, and what a row costs.

    python benchmarks/arms.py LOG [--robot ur10] [--json FILE]

LOG is a log, or a file that `handeye convert` knows, such as the UR10 measurements of Landgraf et
al. (2021). Frames are placed from all rows, as `handeye calibrate` does; then every calibrator
goes through the rows in order from the nominal arm, each row tested before it is learned. Errors
are the mean over the rows so far, and over the next hundred from there. The combined calibrator is
run with fewer error curves as well: harmonics along a joint's own motion, and across it. Then
unknowns, and processor time of an `observe` in milliseconds, median and 95th percentile, without
the first 100 rows, which compile.
"""

import json
import time
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from rich.console import Console
from rich.progress import track
from rich.table import Table

from handeye.arrays import Array
from handeye.calibration.calibrators import NetworkCorrection, Nominal
from handeye.calibration.combined import ArmSheet, Combined, CurveTerms
from handeye.calibration.placed import place
from handeye.errors import LogError
from handeye.io.convert import convert
from handeye.io.logs import read_log
from handeye.robots.urdf import load_arm

MARKS, NEXT, COMPILED = (20, 50, 100, 300, 1000), 100, 100
CURVES = (CurveTerms(0, 0), CurveTerms(8, 2), CurveTerms(24, 2), CurveTerms())


def run(calibrator: Any, seen: Any) -> tuple[Array, Array]:
    """Errors (N,) before learning each row, and processor time (N,) of each [s]."""
    errors, times = np.empty((2, len(seen)))
    for i, one in enumerate(seen):
        start = time.process_time()
        errors[i] = np.linalg.norm(calibrator.observe(one).error)
        times[i] = time.process_time() - start
    return errors, times


def row_of(name: str, calibrator: Any, seen: Any) -> dict[str, Any]:
    """One calibrator's line of the table."""
    errors, times = run(calibrator, seen)
    marks = [mark for mark in MARKS if mark <= len(seen)]
    return {
        "calibrator": name,
        "unknowns": len(calibrator.engine.x) if isinstance(calibrator, Combined) else 0,
        "mean": float(errors.mean()),
        "so_far": {mark: float(errors[:mark].mean()) for mark in marks},
        "next": {mark: float(errors[mark : mark + NEXT].mean()) for mark in marks},
        "observe_median": float(np.median(times[COMPILED:])),
        "observe_p95": float(np.percentile(times[COMPILED:], 95)),
        "slowest": float(times[COMPILED:].max()),
    }


def main(
    log: Annotated[Path, typer.Argument(help="A log, or a file that `handeye convert` knows.")],
    robot: Annotated[str, typer.Option(help="Name of a shipped robot, or a URDF file.")] = "ur10",
    file: Annotated[Path | None, typer.Option("--json", help="Where to write the numbers.")] = None,
) -> None:
    """Run every calibrator over the log, and print a table."""
    try:
        seen: Any = convert(log).observations
    except LogError:
        seen = read_log(log).log.observations
    model: Any = place(load_arm(robot), seen)[0]
    calibrators: list[tuple[str, Any]] = [
        ("nominal", Nominal(model)),
        ("network", NetworkCorrection(model)),
    ]
    for curves in CURVES:
        name = f"combined {curves.own}, {curves.others}"
        calibrators.append((name, Combined(model, ArmSheet(curves=curves))))
    rows = [
        row_of(name, calibrator, seen)
        for name, calibrator in track(calibrators, console=Console(stderr=True))
    ]
    marks = rows[0]["so_far"]
    table = Table("mm", "all", *[f"to {m}" for m in marks], *[f"{m} on" for m in marks],
                  "unknowns", "ms", "95 %")  # fmt: skip
    for row in rows:
        errors = [row["mean"], *row["so_far"].values(), *row["next"].values()]
        table.add_row(
            row["calibrator"], *[f"{1e3 * error:.3f}" for error in errors], str(row["unknowns"]),
            f"{1e3 * row['observe_median']:.2f}", f"{1e3 * row['observe_p95']:.2f}",
        )  # fmt: skip
    Console(width=160).print(table)
    if file is not None:
        file.write_text(json.dumps(rows, indent=2))


if __name__ == "__main__":
    typer.run(main)
