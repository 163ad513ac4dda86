"""Speed of the combined calibrator on one core, and how it grows with the number of unknowns.

    python benchmarks/combined.py [--json FILE]

`observe` and `command` are timed one at a time on a stream of the normal plant, after it has
settled. Unknowns are varied through the terms of the three axis curves; the default has the most.
Medians and the 95th percentile, in microseconds; the latter shows observations that were
reconsidered.
"""

import json
import time
from pathlib import Path
from typing import Annotated
from unittest.mock import patch

import numpy as np
import typer
from rich.console import Console
from rich.table import Table

from handeye.calibration.combined import Combined
from handeye.calibration.combined.planar import chain as planar
from handeye.calibration.models import PlanarModel
from handeye.calibration.session import WorldStreams
from handeye.calibration.world import PlanarWorld
from handeye.thesis.plants import NOMINAL, NORMAL

CURVE_TERMS = (4, 8, 12, 16)
SETTLED, TIMED = 300, 1000


def measure(terms: int) -> dict[str, float]:
    """Times [s] with so many terms for each axis's curve."""
    streams = WorldStreams.of(0)
    seen = PlanarWorld(NORMAL).observe(
        np.arange(SETTLED + TIMED), streams.train_poses, streams.train_noise
    )
    with patch.object(planar, "_CURVE_TERMS", terms):
        combined = Combined(PlanarModel(NOMINAL))
    combined.observe_many(seen[:SETTLED])
    observing, commanding = np.empty((2, TIMED))
    for i in range(TIMED):
        one = seen[SETTLED + i]
        target = one.target
        start = time.perf_counter()
        combined.observe(one)
        middle = time.perf_counter()
        combined.command(target)
        commanding[i] = time.perf_counter() - middle
        observing[i] = middle - start
    return {
        "unknowns": float(len(combined.engine.chain.names)),
        "observe_median": float(np.median(observing)),
        "observe_p95": float(np.percentile(observing, 95)),
        "command_median": float(np.median(commanding)),
        "command_p95": float(np.percentile(commanding, 95)),
    }


def main(
    file: Annotated[Path | None, typer.Option("--json", help="Where to write the numbers.")] = None,
) -> None:
    """Time it, and print a table."""
    rows = [measure(terms) for terms in CURVE_TERMS]
    table = Table("unknowns", "observe: median", "95 %", "command: median", "95 %")
    for row in rows:
        times = [f"{1e6 * value:.0f}" for name, value in row.items() if name != "unknowns"]
        table.add_row(f"{row['unknowns']:.0f}", *times)
    Console().print(table, "microseconds")
    if file is not None:
        file.write_text(json.dumps(rows, indent=2))


if __name__ == "__main__":
    typer.run(main)
