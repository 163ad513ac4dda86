"""`handeye convert`: other people's files as our log."""

from pathlib import Path
from typing import Annotated

import typer
from rich.markup import escape

from handeye.cli.console import err
from handeye.io.convert import convert as read_foreign
from handeye.io.logs import write_log


def convert(
    source: Annotated[Path, typer.Argument(help="File to convert.", show_default=False)],
    target: Annotated[
        Path, typer.Argument(help="Log to write, .csv or .parquet.", show_default=False)
    ],
    kind: Annotated[
        str | None, typer.Option(help="Kind of the file; by default its header tells.")
    ] = None,
) -> None:
    """Turn a file of another program into a log for [bold]handeye calibrate[/].

    Known: the UR10 joint-configuration measurements of Landgraf et al. (2021).
    """
    log = read_foreign(source, kind)
    write_log(target, log)
    err().print(
        f"{len(log)} observations of {len(log.joint_names)} joints -> {escape(str(target))}",
        highlight=False,
    )
