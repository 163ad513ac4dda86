"""`handeye convert`: other people's files as our log."""

from pathlib import Path
from typing import Annotated

import typer
from rich.markup import escape

from handeye.calibration.placed import arm_of
from handeye.cli.bags import (
    Frame,
    JointsTopic,
    KnownDelay,
    Marker,
    PointsTopic,
    ReceiptTimes,
    Tolerance,
    read_any,
)
from handeye.cli.console import err
from handeye.cli.robot import ROBOT_HELP, load_robot
from handeye.errors import InvalidInput
from handeye.io.bags import BagOptions, is_bag
from handeye.io.convert import convert as read_foreign
from handeye.io.logs import write_log


def convert(
    source: Annotated[
        Path, typer.Argument(help="File or recording to convert.", show_default=False)
    ],
    target: Annotated[
        Path, typer.Argument(help="Log to write, .csv or .parquet.", show_default=False)
    ],
    kind: Annotated[
        str | None, typer.Option(help="Kind of the file; by default its header tells.")
    ] = None,
    robot: Annotated[
        str | None, typer.Option(help=f"For a recording: {ROBOT_HELP}", show_default=False)
    ] = None,
    tip: Annotated[
        str | None, typer.Option(help="Link of the URDF that carries the marker.")
    ] = None,
    skip_bad: Annotated[
        bool, typer.Option("--skip-bad", help="Use what is whole of a damaged recording.")
    ] = False,
    joints_topic: JointsTopic = None,
    points_topic: PointsTopic = None,
    frame: Frame = None,
    marker: Marker = None,
    tolerance: Tolerance = 0.1,
    delay: KnownDelay = None,
    receipt_times: ReceiptTimes = False,
) -> None:
    """Turn a recording, or a file of another program, into a log for [bold]handeye calibrate[/].

    Known: ROS 1 and ROS 2 bags, MCAP files, and the UR10 joint-configuration measurements of
    Landgraf et al. (2021). With the robot, a recording's joints stand in its order and the
    sensor's delay is estimated with its kinematics.
    """
    if is_bag(source):
        if kind is not None:
            raise InvalidInput(f"{source}: is a recording: leave out --kind")
        arm = None if robot is None else arm_of(load_robot(robot, tip))
        options = BagOptions(
            joints_topic, points_topic, frame, marker, tolerance, delay, receipt_times
        )
        log = read_any(source, options, arm=arm, skip_bad=skip_bad).log
    else:
        log = read_foreign(source, kind)
    write_log(target, log)
    err().print(
        f"{len(log)} observations of {len(log.joint_names)} joints -> {escape(str(target))}",
        highlight=False,
    )
