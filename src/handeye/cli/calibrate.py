"""`handeye calibrate`: a log in; a calibrated model, a table and a page out."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer
from rich.markup import escape

from handeye.calibration.exporting import calibrated_joints_yaml, calibrated_urdf, not_in_urdf
from handeye.calibration.log_checks import check_log
from handeye.calibration.log_run import calibrate_log
from handeye.calibration.placed import arm_of
from handeye.calibration.results import CalibrationResult
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
from handeye.cli.calibrate_results import as_data, print_results
from handeye.cli.console import check_places, err, no_page, progress_bar, write_json
from handeye.cli.robot import ROBOT_HELP, load_robot
from handeye.cli.setup import Described, calibrate_described
from handeye.cli.setup_files import Wanted
from handeye.errors import InvalidInput, MissingExtra
from handeye.io.bags import BagOptions, is_bag
from handeye.io.files import replace_file


class MethodName(StrEnum):
    """What learns."""

    combined = "combined"
    network = "network"
    estimator = "estimator"
    nominal = "nominal"


class ValidationName(StrEnum):
    """Which rows are held out."""

    blocks = "blocks"
    random = "random"
    none = "none"


def calibrate(
    log: Annotated[
        Path | None,
        typer.Argument(
            help="Log of the robot at work: .csv, .parquet, or a recording (.bag, .mcap, .db3 or "
            "the folder of a ROS 2 bag). Not with [bold]--setup[/], which names its tables.",
            show_default=False,
        ),
    ] = None,
    setup_file: Annotated[
        Path | None,
        typer.Option(
            "--setup",
            help="Instead of a log, a YAML file that describes what was measured, by what, and "
            "what is known: several sensors, cameras by their pixels, wires, touched points.",
            show_default=False,
        ),
    ] = None,
    robot: Annotated[str | None, typer.Option(help=ROBOT_HELP, show_default=False)] = None,
    tip: Annotated[
        str | None, typer.Option(help="Link of the URDF that carries the marker.")
    ] = None,
    eye: Annotated[
        str | None,
        typer.Option(
            help="Link of the URDF that carries the sensor: a pan-tilt head, a flange with a "
            "camera, another arm's hand. Without it the sensor stands beside the robot.",
            show_default=False,
        ),
    ] = None,
    method: Annotated[
        MethodName | None,
        typer.Option(
            help="What learns: a model of the whole chain (the default for the planar robot and "
            "for arms from URDF files); a network correction (the default for others); an "
            "estimator of the kinematic parameters (planar robot only); or nothing.",
            show_default=False,
        ),
    ] = None,
    folder: Annotated[
        Path,
        typer.Option(
            "--out", help="Folder for the model and the report page; made if there is none."
        ),
    ] = Path("out"),
    urdf_file: Annotated[
        Path | None,
        typer.Option("--urdf", help="Also write the URDF with the joints where they were found."),
    ] = None,
    joints_file: Annotated[
        Path | None,
        typer.Option("--joints-yaml", help="Also write the joints' places as YAML for xacro."),
    ] = None,
    camera_info: Annotated[
        Path | None,
        typer.Option(
            "--camera-info",
            help="With [bold]--setup[/], also write cameras as camera_info YAML: a file, or a "
            "folder for a file of each.",
        ),
    ] = None,
    hand_eye: Annotated[
        Path | None,
        typer.Option(
            "--hand-eye",
            help="With [bold]--setup[/], also write where sensors are, as easy_handeye2 has it: a "
            "file, or a folder for a file of each.",
        ),
    ] = None,
    json_file: Annotated[
        str | None, typer.Option("--json", help="Also write the results as JSON; - prints them.")
    ] = None,
    skip_bad: Annotated[
        bool, typer.Option("--skip-bad", help="Use the good rows of a log that has bad ones.")
    ] = False,
    validate: Annotated[
        ValidationName,
        typer.Option(
            help="Which rows are held out to say how good the result is: five blocks of time, each "
            "once; a random third, which flatters; or none, which is fastest."
        ),
    ] = ValidationName.blocks,
    replicate: Annotated[
        int, typer.Option(min=0, help="Which third, for [bold]--validate random[/].")
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

    Places the frames of sensor and marker, then learns from the rows in order of time, testing each
    before learning it. Then blocks of rows are held out in turn, which says how good the result is.
    The columns of a log are described in docs/how-to/log-format.md, those of the JSON in
    docs/reference/json.md.
    """
    check_places(folder, json_file, *(str(f) for f in (urdf_file, joints_file) if f is not None))
    if setup_file is not None:
        if log is not None or method is not None:
            raise InvalidInput("--setup names its tables and its fit: leave out LOG and --method")
        calibrate_described(
            Described(setup_file, robot, tip, eye),
            folder,
            Wanted(urdf_file, joints_file, camera_info, hand_eye),
            json_file,
            validate=validate.value,
            skip_bad=skip_bad,
        )
        return
    if log is None or robot is None:
        raise InvalidInput("give a LOG and its --robot, or --setup with a file that describes both")
    if camera_info is not None or hand_eye is not None:
        raise InvalidInput("--camera-info and --hand-eye go with --setup")
    options = BagOptions(joints_topic, points_topic, frame, marker, tolerance, delay, receipt_times)
    # A recording needs the robot to be read; of a table the joints tell which part of it is meant.
    table = None if is_bag(log) else read_any(log, options, skip_bad=skip_bad)
    joints = None if table is None or table.log.kind == "stereo" else table.log.joint_names
    nominal = load_robot(robot, tip, eye, joints=joints)
    arm = arm_of(nominal)
    if (urdf_file or joints_file) and (robot == "planar" or method not in {None, "combined"}):
        raise InvalidInput(
            "--urdf and --joints-yaml need an arm from a URDF file and --method combined"
        )
    reading = table or read_any(log, options, arm=arm, skip_bad=skip_bad)
    checked = check_log(arm, reading.log, skip_bad=skip_bad)
    with progress_bar("learning, then judging", len(checked.log)) as (progress, task):
        done = calibrate_log(
            checked.log,
            nominal,
            method=None if method is None else method.value,
            rejected=(*reading.rejected, *checked.rejected),
            validate=validate.value,
            replicate=replicate,
            progress=lambda n, total: progress.update(task, completed=n, total=total),
        )
    result = done.result
    model = folder / f"{log.stem}.model.safetensors"
    save_model(model, done.calibrator, len(checked.log))
    files: dict[str, Path | None] = {
        "model": model,
        "page": _page(result, folder / f"{log.stem}.html"),
    }
    for name, place, text in (
        ("urdf", urdf_file, calibrated_urdf),
        ("joints", joints_file, calibrated_joints_yaml),
    ):
        if place is not None:
            replace_file(place, text(done.calibrator).encode())
            files[name] = place
    if urdf_file is not None:
        left = ", ".join(not_in_urdf(done.calibrator))
        err().print(f"[dim]not in the URDF[/] {escape(left)}", highlight=False, soft_wrap=True)
    if json_file is not None:
        named = {name: None if path is None else str(path) for name, path in files.items()}
        write_json(as_data(result) | named | report_data(reading), json_file)
    if json_file != "-":
        print_results(done, files)


def _page(result: CalibrationResult, path: Path) -> Path | None:
    """Write the report, or say what it needs: the calibration does not depend on it."""
    try:
        from handeye.reports.calibration import calibration_page  # noqa: PLC0415
    except MissingExtra as missing:
        no_page(missing)
        return None
    calibration_page(result).write(path)
    return path
