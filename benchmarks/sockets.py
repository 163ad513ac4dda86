"""Two arms calibrated by their encoders alone, with a ball in the sockets of a base.

    python benchmarks/sockets.py [--json FILE]

The measurements are "MUKCa" of TU Delft (platonics-delft/kinematics_calibration, MIT); set
HANDEYE_SHARED to the folder that holds them as `data/ball_in_sockets`. Of each arm there is a
folder of places of the base, and in each a file for each of its two sockets, `hole_0.csv` and
`hole_1.csv`: a row is the joints [rad], without a header. The sockets are 50 mm apart.

Each place is left out once. Printed are the mean distance of the ball from its socket's mean, and
by how much the distance of the sockets is wrong, means over places: of the arm as its maker
describes it, with its geometry fitted, and with error curves as well, which is the default.
"""

import json
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from handeye.calibration.arm.sheet import ArmSheet, CurveTerms
from handeye.thesis.experiment import FULL, Quantities
from handeye.thesis.experiments.real_sockets import REAL_SOCKETS
from handeye.thesis.real_data import ABSENT
from handeye.thesis.sockets import left_out

GEOMETRY = ArmSheet(curves=CurveTerms(own=0, others=0))
MODELS = {"geometry": GEOMETRY, "and curves (default)": None}


def rows() -> list[tuple[str, str, float, float]]:
    """Arm, model, consistency and distortion [m]."""
    found: list[tuple[str, str, float, float]] = []
    for arm, setting in REAL_SOCKETS.settings.items():
        scores = {
            name: left_out(replace(setting, sheet=one), 0, FULL) for name, one in MODELS.items()
        }
        nominal = scores["geometry"]
        found.append((arm, "nominal", *pair(nominal, "nominal_")))
        found += [(arm, name, *pair(score)) for name, score in scores.items()]
    return found


def pair(score: Quantities, prefix: str = "") -> tuple[float, float]:
    """Consistency and distortion [m]."""
    one, other = (score[f"{prefix}{name}"] for name in ("consistency", "distortion"))
    assert isinstance(one, float)
    assert isinstance(other, float)
    return one, other


def main(json_file: Annotated[Path | None, typer.Option("--json")] = None) -> None:
    """Print the table, and write it where asked."""
    if not REAL_SOCKETS.can_run:
        raise SystemExit(ABSENT)
    measured = rows()
    table = Table("arm", "model", "consistency [mm]", "distortion [mm]")
    for arm, model, consistency, distortion in measured:
        table.add_row(arm, model, f"{1e3 * consistency:.3f}", f"{1e3 * distortion:.3f}")
    Console().print(table)
    if json_file is not None:
        keys = ("arm", "model", "consistency", "distortion")
        json_file.write_text(
            json.dumps([dict(zip(keys, row, strict=True)) for row in measured], indent=1),
            encoding="utf-8",
        )


if __name__ == "__main__":
    typer.run(main)
