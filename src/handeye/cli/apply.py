"""`handeye apply`: targets in, corrected joint commands out."""

from pathlib import Path
from typing import Annotated, Any

import typer
from rich.markup import escape

from handeye.calibration.placed_arm import PlacedArm
from handeye.calibration.setups.commands import SetupCommands
from handeye.calibration.setups.storage import FORMAT as SETUP
from handeye.calibration.setups.storage import load_setup
from handeye.calibration.storage import load_model
from handeye.cli.console import err
from handeye.errors import InvalidInput
from handeye.io.kinds import kind_of
from handeye.io.targets import (
    commands_as_csv,
    read_point_targets,
    read_stereo_targets,
    write_commands,
)


def apply(
    model: Annotated[
        Path,
        typer.Argument(help="Calibrated model that `handeye calibrate` saved.", show_default=False),
    ],
    targets: Annotated[
        Path, typer.Argument(help="Table of targets, .csv or .parquet.", show_default=False)
    ],
    target_file: Annotated[
        Path | None, typer.Option("--out", help="CSV file for the commands; else they are printed.")
    ] = None,
    sensor: Annotated[
        str | None,
        typer.Option(
            help="Of a set-up: in whose frame targets are, [bold]base[/] or a sensor's name; by "
            "default the first that does not move.",
            show_default=False,
        ),
    ] = None,
    marker: Annotated[
        str | None,
        typer.Option(
            help="Of a set-up: what is to be brought there; by default what that sensor sees.",
            show_default=False,
        ),
    ] = None,
) -> None:
    """Turn targets, as the eye sees them, into joint commands that bring the hand there.

    The columns of a table of targets are described in docs/how-to/log-format.md.
    """
    calibrator: Any
    if kind_of(model) == SETUP:
        calibrator = SetupCommands(load_setup(model).fit, sensor, marker)
        names = calibrator.joint_names
        wanted = read_point_targets(targets, names)
    elif sensor is not None or marker is not None:
        raise InvalidInput("--sensor and --marker go with a model of `handeye calibrate --setup`")
    else:
        calibrator = load_model(model).calibrator
        if isinstance(calibrator.model, PlacedArm):
            names = calibrator.model.arm.joint_names
            wanted = read_point_targets(targets, names)
        else:
            names = calibrator.model.nominal.arm.joint_names
            wanted = read_stereo_targets(targets)
    try:
        commands = calibrator.command(wanted)
    except InvalidInput as error:
        raise InvalidInput(f"{targets}: {error}") from error
    if target_file is None:
        typer.echo(commands_as_csv(names, commands), nl=False)
        return
    write_commands(target_file, names, commands)
    err().print(f"{len(commands)} commands -> {escape(str(target_file))}", highlight=False)
