"""`handeye demo`: a robot learns to reach where it looks, is bent, and learns again."""

from dataclasses import dataclass, fields, replace
from math import degrees, radians
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from rich.markup import escape

from handeye.arrays import Array
from handeye.calibration.calibrators import NetworkCorrection, Nominal
from handeye.calibration.combined import Combined
from handeye.calibration.drift import OffsetStep
from handeye.calibration.engine.events import Event
from handeye.calibration.models import PlanarModel
from handeye.calibration.session import (
    AfterEach,
    AnyCalibrator,
    LearningCurve,
    WorldStreams,
    learn_in_world,
    position_errors,
)
from handeye.calibration.storage import save_model
from handeye.calibration.world import PlanarWorld
from handeye.cli.console import no_page, out, progress_bar, table
from handeye.errors import MissingExtra
from handeye.observations import StereoObservation, StereoTarget
from handeye.randomness import stream
from handeye.thesis.plants import NOMINAL, NORMAL

_MODEL = PlanarModel(NOMINAL)
_BEND = radians(2.0)
_MARKS = 50
_MAP_POINTS = 120
_FLOOR_POSES = 20_000
_BLOCKS = " ▁▂▃▄▅▆▇█"


@dataclass(frozen=True)
class _Measured:
    """What the robot did: curves of two learners, which hold the moment of the bend twice."""

    combined: LearningCurve
    network: LearningCurve
    stages: list[tuple[Array, Array]]
    noticed: Event | None
    floor: float


def demo(
    folder: Annotated[
        Path, typer.Option("--out", help="Folder for the report page and the model.")
    ] = Path("out"),
    trials: Annotated[
        int, typer.Option(min=100, help="Reaches before the bend, and again after it.")
    ] = 500,
    replicate: Annotated[int, typer.Option(min=0, help="Another number, other random poses.")] = 0,
    still: Annotated[
        Path | None, typer.Option(help="Also write the story as one PNG picture.", hidden=True)
    ] = None,
) -> None:
    """Watch a planar robot learn where its hand goes.

    Its stereo eye is noisy and its kinematics are slightly wrong (the normal plant of Ruoff 1993,
    section 3.4). It learns while it reaches; then its shoulder is bent by two degrees, and it
    learns again. Takes seconds; writes a page with the whole story.
    """
    world = PlanarWorld(NORMAL, drift=OffsetStep("alpha", _BEND, at=trials))
    learner = Combined(_MODEL)
    with progress_bar("reaching and learning", 4 * trials) as (progress, task):
        measured = _measure(
            world, learner, trials, replicate, lambda n: progress.update(task, completed=n)
        )
    _print(measured, trials)
    path = folder / "demo.model.safetensors"
    save_model(path, learner, 2 * trials)
    out().print(f"model  {escape(str(path))}", highlight=False, soft_wrap=True)
    page = folder / "demo.html"
    try:
        _write_page(page, still, measured, trials, replicate)
    except MissingExtra as missing:
        no_page(missing)
        return
    out().print(f"page   {escape(str(page))}", highlight=False, soft_wrap=True)


def _measure(
    world: PlanarWorld, learner: Combined, trials: int, replicate: int, after_each: AfterEach
) -> _Measured:
    stages = [_miss(world, learner, 0)]

    def look(done: int) -> None:
        if done in (trials, 2 * trials):
            stages.append(_miss(world, learner, done - 1))
        if done == trials:
            stages.append(_miss(world, learner, done))
        after_each(done)

    combined = _curve(world, learner, trials, replicate, look)
    network = NetworkCorrection[StereoObservation, StereoTarget](_MODEL)
    alone = _curve(world, network, trials, replicate, lambda n: after_each(2 * trials + n))
    since = (event for event in learner.events if event.observation >= trials)
    noticed = next((event for event in since if event.kind == "change"), None)
    return _Measured(combined, alone, stages, noticed, _noise_floor())


def _curve(
    world: PlanarWorld, learner: AnyCalibrator, trials: int, replicate: int, after_each: AfterEach
) -> LearningCurve:
    """Of a learner over the same reaches as any other."""
    nominal = Nominal[StereoObservation, StereoTarget](_MODEL)
    streams, every = WorldStreams.of(replicate), max(trials // _MARKS, 1)
    halves = [
        learn_in_world(
            world, learner, nominal, streams,
            trials=trials, every=every, start=start, after_each=after_each,
        )
        for start in (0, trials)
    ]  # fmt: skip
    columns = [[getattr(half, field.name) for half in halves] for field in fields(LearningCurve)]
    return LearningCurve(*(np.concatenate(column) for column in columns))


def _miss(world: PlanarWorld, calibrator: AnyCalibrator, trial: int) -> tuple[Array, Array]:
    """Where the hand should go and where it lands, (K, 2) [m], at poses that never change."""
    names = ("map poses", "map noise")
    poses, noise = (stream(f"demo: {name}") for name in names)
    streams = replace(WorldStreams.of(0), test_poses=poses, test_noise=noise)
    (errors,) = position_errors(world, [calibrator], trial, streams, _MAP_POINTS)
    joints, _ = world.region.sample(_MAP_POINTS, stream("demo: map poses"))
    wanted = world.tips(joints, np.full(_MAP_POINTS, trial))
    return wanted, -errors


def _noise_floor() -> float:
    """Mean error [m] when kinematics and encoders are exactly known and only the eye is noisy."""
    world = PlanarWorld(NOMINAL)
    exact = Nominal[StereoObservation, StereoTarget](_MODEL)
    (errors,) = position_errors(world, [exact], 0, WorldStreams.of(0), _FLOOR_POSES)
    return float(np.linalg.norm(errors, axis=1).mean())


def _print(measured: _Measured, trials: int) -> None:
    combined, network = measured.combined, measured.network
    learned, bent = np.flatnonzero(combined.trials == trials)
    moments = (
        ("before learning", 0),
        (f"after {trials:,} reaches", learned),
        (f"bent by {degrees(_BEND):.0f} degrees", bent),
        (f"after {trials:,} more", -1),
    )
    shown = table(
        "A robot learns to reach where it looks: mean error",
        "", "combined", "network alone", "not learning",
    )  # fmt: skip
    for name, at in moments:
        errors = (combined.mean[at], network.mean[at], combined.uncorrected[at])
        shown.add_row(name, *(f"{error * 100:.2f} cm" for error in errors))
    shown.add_row("noise of the eye alone", f"{measured.floor * 100:.2f} cm", "", "")
    console = out()
    console.print(shown)
    console.print(f"error over the reaches  {_sparkline(combined.mean[::2])}")
    if measured.noticed is not None:
        console.print(f"noticed  {escape(_told(measured.noticed))}", highlight=False)


def _told(noticed: Event) -> str:
    """What was noticed, in an operator's words."""
    size = (
        f"{degrees(noticed.amount):+.2f} ± {degrees(noticed.std):.2f} degrees"
        if noticed.unit == "rad"
        else f"{noticed.amount:+.3g} ± {noticed.std:.2g} {noticed.unit}".rstrip()
    )
    return f"{noticed.part} changed by {size}; {noticed.done}"


def _sparkline(values: Array) -> str:
    """Values as a row of blocks, from nothing to the largest."""
    largest = len(_BLOCKS) - 1
    return "".join(_BLOCKS[round(value / values.max() * largest)] for value in values.tolist())


def _write_page(
    page: Path, still: Path | None, measured: _Measured, trials: int, replicate: int
) -> None:
    from handeye.reports.demo import DemoRun, demo_page, demo_still  # noqa: PLC0415 (an extra)
    from handeye.reports.figures import PlanarArm, Stage  # noqa: PLC0415
    from handeye.reports.svg import write_png  # noqa: PLC0415

    titles = ("Before learning", "After learning", "Just bent", "Learned again")
    combined = measured.combined
    run = DemoRun(
        combined.trials,
        combined.mean,
        combined.std,
        combined.uncorrected,
        measured.network.mean,
        trials,
        _BEND,
        "" if measured.noticed is None else _told(measured.noticed),
        measured.floor,
        *(Stage(title, *stage) for title, stage in zip(titles, measured.stages, strict=True)),
        arm=PlanarArm(
            (float(NOMINAL.arm.a), float(NOMINAL.arm.b)), (float(NOMINAL.v_x), float(NOMINAL.v_y))
        ),
    )
    settings = {
        "plant": "normal (tables 3.1 and 3.2 of Ruoff 1993), noise and perturbations",
        "learners": "Combined, and beside it NetworkCorrection (section 3.5.4); default settings",
        "replicate": str(replicate),
    }
    demo_page(run, settings=settings).write(page)
    if still is not None:
        write_png(demo_still(run), still)
