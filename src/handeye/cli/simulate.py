"""`handeye simulate`: logs of the planar robot, so that every step can be tried without one."""

from enum import StrEnum
from math import radians
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from rich.markup import escape

from handeye.calibration.arm_world import ArmWorld
from handeye.calibration.drift import Drift, OffsetStep, Thermal, steady
from handeye.calibration.session import WorldStreams
from handeye.calibration.world import PlanarWorld
from handeye.cli.console import err
from handeye.cli.robot import ROBOT_HELP
from handeye.errors import InvalidInput
from handeye.io.bags.writing import write_recording
from handeye.io.logs import write_log
from handeye.io.records import Log
from handeye.randomness import stream
from handeye.robots.urdf import load_arm
from handeye.thesis.plants import LARGE, NOMINAL, NORMAL


class Plant(StrEnum):
    """Which errors the simulated robot has."""

    normal = "normal"
    large = "large"
    exact = "exact"


# Sightings and joint states per second; how late a camera stamps what it sees [s].
_SEEN_RATE, _STATE_RATE, _DELAY = 2.0, 50.0, 0.04
_BEGIN = 100.0

_PLANTS = {Plant.normal: NORMAL, Plant.large: LARGE, Plant.exact: NOMINAL}


def simulate(
    target: Annotated[
        Path,
        typer.Argument(
            help="Log to write, .csv or .parquet; with --robot also a recording, .mcap.",
            show_default=False,
        ),
    ],
    robot: Annotated[
        str, typer.Option(help=f"Which robot: {ROBOT_HELP} The options below are the planar one's.")
    ] = "planar",
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
    """Write a log of a simulated robot at work; it does not tell the robot's errors.

    The planar robot, seen by its stereo eye, has the errors of chapter 3 of Ruoff (1993). Another
    arm swings through its workspace and has errors as arms have when they come from the maker; a
    camera sees a marker on its hand to 0.1 mm, and in a recording it stamps what it sees 40 ms
    late.
    """
    if robot != "planar":
        planar_only = (slip, thermal_period, foveate, not noise, not perturbations)
        if any(planar_only) or range_scale != 1.0 or plant != Plant.normal:
            raise InvalidInput("of another robot than the planar one, only rows can be chosen")
        _simulate_arm(target, robot, rows, replicate)
        err().print(f"{rows} observations -> {escape(str(target))}", highlight=False)
        return
    if target.suffix == ".mcap":
        raise InvalidInput(f"{target}: a recording needs an arm in space: choose one with --robot")
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


def _simulate_arm(target: Path, robot: str, rows: int, replicate: int) -> None:
    world = ArmWorld.of(load_arm(robot), replicate=replicate)
    rng = stream("arm world: noise", replicate)
    times = _BEGIN + np.arange(rows) / _SEEN_RATE
    seen = world.observe(times, world.motion(times), rng)
    names = world.nominal.joint_names
    if target.suffix == ".mcap":
        states = np.arange(times[0] - 0.5, times[-1] + 0.5, 1.0 / _STATE_RATE)
        joints = (states, world.motion(states))
        write_recording(target, names, joints, (times, seen.position), delay=_DELAY)
        return
    write_log(target, Log(str(target), names, seen, np.arange(rows) + 2))
