"""`handeye calibrate`: a log in; a calibrated model, a table and a page out."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.markup import escape

from handeye.calibration.log_checks import check_log
from handeye.calibration.log_run import Calibration, arm_of, calibrate_log
from handeye.calibration.results import CalibrationResult, ErrorSummary
from handeye.calibration.storage import save_model
from handeye.cli.bags import (
    Frame,
    JointsTopic,
    KnownDelay,
    Marker,
    PointsTopic,
    ReceiptTimes,
    Tolerance,
    read_any,
    report_data,
)
from handeye.cli.console import no_page, out, progress_bar, table, write_json
from handeye.cli.robot import ROBOT_HELP, load_robot
from handeye.errors import MissingExtra
from handeye.io.bags import BagOptions


class MethodName(StrEnum):
    """What learns."""

    combined = "combined"
    network = "network"
    estimator = "estimator"
    nominal = "nominal"


def calibrate(
    log: Annotated[
        Path,
        typer.Argument(
            help="Log of the robot at work: .csv, .parquet, or a recording (.bag, .mcap, .db3 or "
            "the folder of a ROS 2 bag).",
            show_default=False,
        ),
    ],
    robot: Annotated[str, typer.Option(help=ROBOT_HELP, show_default=False)],
    tip: Annotated[
        str | None, typer.Option(help="Link of the URDF that carries the marker.")
    ] = None,
    method: Annotated[
        MethodName | None,
        typer.Option(
            help="What learns: a model of the whole chain (planar robot only, the default there); "
            "a network correction (the default elsewhere); an estimator of the kinematic "
            "parameters (planar robot only); or nothing.",
            show_default=False,
        ),
    ] = None,
    folder: Annotated[
        Path, typer.Option("--out", help="Folder for the model and the report page.")
    ] = Path("out"),
    json_file: Annotated[
        str | None, typer.Option("--json", help="Also write the results as JSON; - prints them.")
    ] = None,
    skip_bad: Annotated[
        bool, typer.Option("--skip-bad", help="Use the good rows of a log that has bad ones.")
    ] = False,
    replicate: Annotated[
        int, typer.Option(min=0, help="Which random third of the rows is held out.")
    ] = 0,
    joints_topic: JointsTopic = None,
    points_topic: PointsTopic = None,
    frame: Frame = None,
    marker: Marker = None,
    tolerance: Tolerance = 0.1,
    delay: KnownDelay = None,
    receipt_times: ReceiptTimes = False,
) -> None:
    """Calibrate a robot from a log of what its eye saw of its hand.

    Places the frames of sensor and marker, then learns from the rows in order, testing each before
    learning it. A second run with a third of the rows held out says how good the result is.
    The columns of a log are described in docs/how-to/log-format.md.
    """
    nominal = load_robot(robot, tip)
    arm = arm_of(nominal)
    options = BagOptions(joints_topic, points_topic, frame, marker, tolerance, delay, receipt_times)
    reading = read_any(log, options, arm=arm, skip_bad=skip_bad)
    checked = check_log(arm, reading.log, skip_bad=skip_bad)
    with progress_bar("learning from the log", len(checked.log)) as (progress, task):
        done = calibrate_log(
            checked.log,
            nominal,
            method=None if method is None else method.value,
            rejected=(*reading.rejected, *checked.rejected),
            replicate=replicate,
            after_each=lambda n: progress.update(task, completed=n),
        )
    result = done.result
    model = folder / f"{log.stem}.model.safetensors"
    save_model(model, done.calibrator, len(checked.log))
    page = _page(result, folder / f"{log.stem}.html")
    if json_file is not None:
        write_json(_as_data(result, model, page) | report_data(reading), json_file)
    if json_file != "-":
        _print(done, model, page)


def _page(result: CalibrationResult, path: Path) -> Path | None:
    """Write the report, or say what it needs: the calibration does not depend on it."""
    try:
        from handeye.reports.calibration import calibration_page  # noqa: PLC0415
    except MissingExtra as missing:
        no_page(missing)
        return None
    calibration_page(result).write(path)
    return path


def _as_data(result: CalibrationResult, model: Path, page: Path | None) -> dict[str, Any]:
    return {
        "robot": result.robot,
        "log": result.log,
        "method": result.method,
        "n_observations": len(result.before),
        "n_neurons": None if result.n_neurons is None else int(result.n_neurons[-1]),
        "n_rejected": len(result.rejected),
        "rejected": list(result.rejected),
        "errors": result.summary(),
        "findings": list(result.findings),
        "unit": "m",
        "model": str(model),
        "page": None if page is None else str(page),
    }


def _print(done: Calibration, model: Path, page: Path | None) -> None:
    result = done.result
    rows = {
        "all rows, only frames placed": result.before,
        "all rows, tested, then learned": result.online,
    }
    if result.held_out is not None:
        rows["held-out third, only frames placed"] = result.held_out.before
        rows["held-out third, others learned"] = result.held_out.after
    shown = table(
        f"{result.robot}: position error of the hand in mm",
        "", "rows", "mean", "rms", "95 %", "max",
    )  # fmt: skip
    for name, errors in rows.items():
        s = ErrorSummary.of(errors)
        numbers = (f"{v * 1e3:#.3g}" for v in (s.mean, s.rms, s.p95, s.max))
        shown.add_row(name, str(s.n), *numbers)
    console = out()
    console.print(shown)
    console.print(f"frames    {escape(done.frames)}", highlight=False)
    if result.n_neurons is not None:
        console.print(f"neurons   {result.n_neurons[-1]}", highlight=False)
    for i, finding in enumerate(result.findings):
        head = "" if i else "findings"
        console.print(f"{head:<10}{escape(finding)}", highlight=False, soft_wrap=True)
    if result.rejected:
        console.print(f"rejected  {len(result.rejected)} rows", highlight=False)
        for line in result.rejected[:5]:
            console.print(f"          {escape(line)}", highlight=False, soft_wrap=True)
    console.print(f"model     {escape(str(model))}", highlight=False, soft_wrap=True)
    if page is not None:
        console.print(f"page      {escape(str(page))}", highlight=False, soft_wrap=True)
