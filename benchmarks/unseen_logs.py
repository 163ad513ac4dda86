"""Logs of robots that no test knows, through `handeye calibrate LOG --robot URDF` alone.

    python benchmarks/unseen_logs.py [--only WORD] [--replicate N] [--json FILE]

Every case writes a URDF and a log, with an arm, a sensor, noise and faults of its own, and calls
the command as a user would. Shown are processor time, errors in mm with frames placed and on
held-out rows, the least that noise allows these (`floor`), the error of the saved model at new
poses without noise in the range in which the robot worked (`new`), what it expects of itself there
(`expected`), the share of held-out errors within what 95 % should stay below, where a change was
found, and what the command said of it. A case with a traceback says so in capitals.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy loads

import json
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from rich.console import Console
from rich.table import Table
from typer.testing import CliRunner
from unseen_cases import CASES, Case
from unseen_robots import Truth, joints_for, observed, urdf_of

from handeye.calibration.storage import load_model
from handeye.cli.app import app
from handeye.io.logs import Log, write_log
from handeye.observations import PointObservation
from handeye.randomness import stream
from handeye.robots.urdf import UrdfArm

# Mean length of a vector whose three components have standard deviation 1.
MEAN_LENGTH = 1.596
NEW = 300
WILD = 0.05


def run(case: Case, folder: Path, replicate: int) -> dict[str, Any]:
    """Write the log, calibrate, and compare with the truth."""
    rng = stream(f"unseen: {case.name}", replicate)
    text = urdf_of(case.robot, extra=case.extra)
    urdf = folder / f"{case.robot}.urdf"
    urdf.write_text(text)
    tip = {"panda": "panda_link8"}.get(case.robot) if case.tip is None else case.tip
    if case.robot == "gripper":
        tip = "tool0"
    arm = UrdfArm.from_text(text, tip, case.robot, "tool0" if case.eye else None)
    truths, seen = _sightings(case, arm, rng)
    if case.tip is not None:  # the log has all joints of the robot
        more = UrdfArm.from_text(text, None, case.robot)
        rest = joints_for(more, case.rows, case.way, rng)
        rest[:, : seen.joints.shape[1]] = seen.joints
        seen, arm = replace(seen, joints=rest), more
    if case.spoil is not None:
        seen = case.spoil(seen)
    path, out = folder / "run.csv", folder / "run.json"
    write_log(path, Log("run", arm.joint_names, seen, np.arange(len(seen)) + 2))
    call = ["calibrate", str(path), "--robot", str(urdf), "--out", str(folder), *case.options]
    start = time.process_time()
    done = CliRunner().invoke(app, [*call, "--json", str(out)])
    row: dict[str, Any] = {"case": case.name, "exit": done.exit_code}
    row["seconds"] = time.process_time() - start
    if done.exit_code:
        raised = done.exception is not None and not isinstance(done.exception, SystemExit)
        said = f"TRACEBACK {done.exception!r}" if raised else done.output
        return row | {"said": " ".join(said.split())[:500]}
    data = json.loads(out.read_text())
    held = (data["expected_error"] or {}).get("held_out", {})
    row |= {
        "before": data["error_before"]["mean"],
        "after": data["error_after"]["mean"],
        "floor": MEAN_LENGTH * case.noise,
        "within": held.get("within"),
        "changed": data["changed_at_row"],
        "said": " | ".join([data["status"], data["advice"], *data["findings"]]),
    }
    row["expected"] = (data["expected_error"] or {}).get("working_range", {}).get("median")
    if case.spoil is None and case.tip is None and (case.eye == bool(case.options)):
        row["new"] = _at_new_poses(folder / "run.model.safetensors", truths[-1], seen, rng)
    return row


def _sightings(case: Case, arm: UrdfArm, rng: np.random.Generator) -> tuple[list[Truth], Any]:
    now = Truth.of(arm, case.size, rng)
    joints = joints_for(arm, case.rows, case.way, rng)
    if case.held is not None:
        joints[:, case.held] = 0.3
    truths: list[Truth] = []
    for i in range(case.rows):
        for at, part, by in case.faults:
            now = now.moved(part, by) if at == i else now
        if case.drift is not None:
            now = now.moved(case.drift[0], [size / case.rows for size in case.drift[1]])
        truths.append(now)
    seen = observed(truths, joints, case.noise, rng)
    wild = rng.random(case.rows) < case.outliers
    position = seen.position.copy()
    position[wild] += rng.normal(scale=WILD, size=(int(wild.sum()), 3))
    oriented = seen.orientation if case.oriented else None
    return truths, replace(seen, position=position, orientation=oriented)


def _at_new_poses(model: Path, truth: Truth, seen: Any, rng: np.random.Generator) -> float:
    calibrator: Any = load_model(model).calibrator
    joints = rng.uniform(
        seen.joints.min(axis=0), seen.joints.max(axis=0), (NEW, seen.joints.shape[1])
    )
    position, wxyz = truth.seen(joints)
    orientation = None if seen.orientation is None else wxyz
    fresh = PointObservation(np.arange(float(NEW)), joints, position, orientation)
    return float(np.linalg.norm(calibrator.errors(fresh), axis=1).mean())


def main(
    only: Annotated[str, typer.Option(help="Cases with this in their names.")] = "",
    replicate: Annotated[int, typer.Option(help="Other robots and noise.")] = 0,
    file: Annotated[Path | None, typer.Option("--json", help="Where to write the rows.")] = None,
) -> None:
    """Run the cases, and print a table."""
    table = Table(
        "case", "s", "before", "held out", "floor", "new", "expected", "95 %", "changed", "said"
    )
    rows: list[dict[str, Any]] = []
    for case in CASES:
        if only not in case.name:
            continue
        with tempfile.TemporaryDirectory() as folder:
            row = run(case, Path(folder), replicate)
        rows.append(row)
        sizes = [row.get(key) for key in ("before", "after", "floor", "new", "expected")]
        table.add_row(
            row["case"], f"{row['seconds']:.1f}",
            *("" if size is None else f"{1e3 * size:.3g}" for size in sizes),
            "" if row.get("within") is None else f"{row['within']:.0%}",
            str(row.get("changed") or ""), row["said"],
        )  # fmt: skip
        if file is not None:
            file.write_text(json.dumps(rows, indent=2))
    Console(width=200).print(table)


if __name__ == "__main__":
    typer.run(main)
