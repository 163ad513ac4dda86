"""How commands read a log that may be a recording of ROS or an MCAP file."""

from dataclasses import fields
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.markup import escape

from handeye.cli.console import err, progress_bar
from handeye.errors import InvalidInput
from handeye.io.bags import BagOptions, BagReading, BagReport, is_bag, read_bag
from handeye.io.logs import read_log
from handeye.io.records import LogReading
from handeye.robots.arm import Arm

_PANEL = "Recordings (.bag, .mcap, .db3 or folder)"

JointsTopic = Annotated[
    str | None, typer.Option(help="Topic of the joint states.", rich_help_panel=_PANEL)
]
PointsTopic = Annotated[
    str | None,
    typer.Option(
        help="Topic of the measurements: points, poses, AprilTags, transforms.",
        rich_help_panel=_PANEL,
    ),
]
Frame = Annotated[
    str | None,
    typer.Option(
        help="Frame of the sensor; of transforms, the parent frame.", rich_help_panel=_PANEL
    ),
]
Marker = Annotated[
    str | None,
    typer.Option(
        help="What is measured: of transforms, the child frame; of AprilTags, the number.",
        rich_help_panel=_PANEL,
    ),
]
Tolerance = Annotated[
    float,
    typer.Option(
        help="Longest time in s between the joint states on both sides of a measurement.",
        rich_help_panel=_PANEL,
    ),
]
KnownDelay = Annotated[
    float | None,
    typer.Option(
        "--delay",
        help="How much later in s the measurements' stamps are; by default it is estimated.",
        rich_help_panel=_PANEL,
        show_default=False,
    ),
]
ReceiptTimes = Annotated[
    bool,
    typer.Option(
        "--receipt-times",
        help="Use times of receipt instead of the messages' stamps.",
        rich_help_panel=_PANEL,
    ),
]


def read_any(
    path: Path, options: BagOptions, *, arm: Arm | None = None, skip_bad: bool = False
) -> LogReading:
    """The log in a table or a recording; what became of a recording goes to standard error.

    Raises:
        InvalidInput: for options of recordings with a table.
        LogError, MissingExtra: as `read_log` and `read_bag`.
    """
    if not is_bag(path):
        given = [f for f in fields(options) if getattr(options, f.name) != f.default]
        if given:
            flags = ", ".join("--" + f.name.replace("_", "-") for f in given)
            raise InvalidInput(f"{path}: {flags} only for recordings: .bag, .mcap, .db3 or folder")
        return read_log(path, skip_bad=skip_bad)
    with progress_bar("reading the recording", 1) as (progress, task):
        reading = read_bag(
            path,
            arm=arm,
            options=options,
            skip_bad=skip_bad,
            progress=lambda done, total: progress.update(task, completed=done, total=total),
        )
    for line in reading.report.lines():
        err().print(f"[dim]recording[/] {escape(line)}", highlight=False, soft_wrap=True)
    return reading


def report_data(reading: LogReading) -> dict[str, Any]:
    """The report of a recording under its key for JSON; nothing for a table."""
    report: BagReport | None = reading.report if isinstance(reading, BagReading) else None
    return {} if report is None else {"recording": report.as_data()}
