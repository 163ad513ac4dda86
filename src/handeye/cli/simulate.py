"""`handeye simulate`: logs of the planar robot, so that every step can be tried without one."""

from enum import StrEnum
from math import radians
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from rich.markup import escape

from handeye.calibration.drift import Drift, OffsetStep, Thermal, steady
from handeye.calibration.session import WorldStreams
from handeye.calibration.world import PlanarWorld
from handeye.cli.console import err
from handeye.errors import InvalidInput
from handeye.io.logs import write_log
from handeye.io.records import Log
from handeye.thesis.plants import LARGE, NOMINAL, NORMAL


class Plant(StrEnum):
    """Which errors the simulated robot has."""

    normal = "normal"
    large = "large"
    exact = "exact"


_PLANTS = {Plant.normal: NORMAL, Plant.large: LARGE, Plant.exact: NOMINAL}


def simulate(
    target: Annotated[
        Path, typer.Argument(help="Log to write, .csv or .parquet.", show_default=False)
    ],
    rows: Annotated[int, typer.Option(min=1, help="Observations to record.")] = 2000,
    plant: Annotated[Plant, typer.Option(help="Errors of the arm and the eye.")] = Plant.normal,
    noise: Annotated[bool, typer.Option(help="Noise of the stereo head.")] = True,
    perturbations: Annotated[bool, typer.Option(help="Periodic and lens errors.")] = True,
    range_scale: Annotated[float, typer.Option(help="Factor on every measured range.")] = 1.0,
    foveate: Annotated[bool, typer.Option(help="Point the eye straight at the hand.")] = False,
    slip: Annotated[
        float, typer.Option(help="Slip of the shoulder's encoder halfway, degrees.")
    ] = 0.0,
    thermal_period: Annotated[
        float | None, typer.Option(help="Heat the robot periodically, period in rows.")
    ] = None,
    replicate: Annotated[int, typer.Option(min=0, help="Another number, other random poses.")] = 0,
) -> None:
    """Write a log of the planar robot at work, seen by its stereo eye.

    The errors are those of chapter 3 of Ruoff (1993); the log does not tell them.
    """
    if slip and thermal_period:
        raise InvalidInput("choose one of --slip and --thermal-period")
    drift: Drift = steady
    if slip:
        drift = OffsetStep("alpha", radians(slip), at=rows // 2)
    if thermal_period is not None:
        drift = Thermal(thermal_period)
    actual = _PLANTS[plant].with_range_scale(range_scale)
    actual = actual if noise else actual.without_noise()
    actual = actual if perturbations else actual.without_perturbations()
    streams = WorldStreams.of(replicate)
    world = PlanarWorld(actual, foveate=foveate, drift=drift)
    seen = world.observe(np.arange(rows), streams.train_poses, streams.train_noise)
    log = Log(str(target), actual.arm.joint_names, seen, np.arange(rows) + 2)
    write_log(target, log)
    err().print(f"{rows} observations -> {escape(str(target))}", highlight=False)
