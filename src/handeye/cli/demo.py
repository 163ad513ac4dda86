"""`handeye demo`: a robot learns to reach where it looks, is bent, and learns again."""

from dataclasses import replace
from math import degrees, radians
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from rich.markup import escape

from handeye.arrays import Array
from handeye.calibration.calibrators import NetworkCorrection, Nominal
from handeye.calibration.drift import OffsetStep
from handeye.calibration.models import PlanarModel
from handeye.calibration.session import (
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
from handeye.networks import ResourceAllocatingNetwork
from handeye.observations import StereoObservation, StereoTarget
from handeye.randomness import stream
from handeye.thesis.plants import NOMINAL, NORMAL

_BEND = radians(2.0)
_NEURONS = 200
_MAP_POINTS = 120
_FLOOR_POSES = 20_000
_BLOCKS = " ▁▂▃▄▅▆▇█"


def demo(
    folder: Annotated[
        Path, typer.Option("--out", help="Folder for the report page and the model.")
    ] = Path("out"),
    trials: Annotated[
        int, typer.Option(min=200, help="Reaches before the bend, and again after it.")
    ] = 5000,
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
    model = PlanarModel(NOMINAL)
    network = ResourceAllocatingNetwork(
        model.space.n_inputs, model.n_outputs, inputs=model.space, capacity=_NEURONS
    )
    learner = NetworkCorrection[StereoObservation, StereoTarget](model, network)
    nominal = Nominal[StereoObservation, StereoTarget](model)
    streams = WorldStreams.of(replicate)
    stages = [_miss(world, learner, 0)]
    curves: list[LearningCurve] = []
    with progress_bar("reaching and learning", 2 * trials) as (progress, task):
        for start in (0, trials):
            curves.append(
                learn_in_world(
                    world, learner, nominal, streams, trials=trials, start=start,
                    after_each=lambda done: progress.update(task, completed=done),
                )
            )  # fmt: skip
            stages.append(_miss(world, learner, start + trials - 1))
            if start == 0:
                stages.append(_miss(world, learner, trials))
    before, after = curves
    floor = _noise_floor()
    _print(before, after, floor)
    path = folder / "demo.model.safetensors"
    save_model(path, learner, 2 * trials)
    out().print(f"model  {escape(str(path))}", highlight=False, soft_wrap=True)
    page = folder / "demo.html"
    try:
        _write_page(page, still, before, after, stages, floor, replicate)
    except MissingExtra as missing:
        no_page(missing)
        return
    out().print(f"page   {escape(str(page))}", highlight=False, soft_wrap=True)


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
    exact = Nominal[StereoObservation, StereoTarget](PlanarModel(NOMINAL))
    (errors,) = position_errors(world, [exact], 0, WorldStreams.of(0), _FLOOR_POSES)
    return float(np.linalg.norm(errors, axis=1).mean())


def _print(before: LearningCurve, after: LearningCurve, floor: float) -> None:
    rows = (
        ("before learning", before.mean[0], before.neurons[0]),
        (f"after {before.trials[-1]:,} reaches", before.mean[-1], before.neurons[-1]),
        (f"bent by {degrees(_BEND):.0f} degrees", after.mean[0], before.neurons[-1]),
        (
            f"after {after.trials[-1] - after.trials[0]:,} more",
            after.mean[-1],
            before.neurons[-1] + after.neurons[-1],
        ),
        ("noise of the eye alone", floor, None),
    )
    console = out()
    shown = table("A robot learns to reach where it looks", "", "mean error", "neurons")
    for name, error, neurons in rows:
        shown.add_row(name, f"{error * 100:.2f} cm", "" if neurons is None else str(neurons))
    console.print(shown)
    console.print(f"error over the reaches  {_sparkline(np.r_[before.mean, after.mean][::2])}")


def _sparkline(values: Array) -> str:
    """Values as a row of blocks, from nothing to the largest."""
    largest = len(_BLOCKS) - 1
    return "".join(_BLOCKS[round(value / values.max() * largest)] for value in values.tolist())


def _write_page(
    page: Path,
    still: Path | None,
    before: LearningCurve,
    after: LearningCurve,
    stages: list[tuple[Array, Array]],
    floor: float,
    replicate: int,
) -> None:
    from handeye.reports.demo import DemoRun, demo_page, demo_still  # noqa: PLC0415 (an extra)
    from handeye.reports.figures import PlanarArm, Stage  # noqa: PLC0415
    from handeye.reports.svg import write_png  # noqa: PLC0415

    titles = ("Before learning", "After learning", "Just bent", "Learned again")
    drawn = [Stage(title, *stage) for title, stage in zip(titles, stages, strict=True)]
    run = DemoRun(
        np.r_[before.trials, after.trials],
        np.r_[before.mean, after.mean],
        np.r_[before.std, after.std],
        np.r_[before.uncorrected, after.uncorrected],
        np.r_[before.neurons, before.neurons[-1] + after.neurons],
        int(after.trials[0]),
        _BEND,
        floor,
        *drawn,
        arm=PlanarArm(
            (float(NOMINAL.arm.a), float(NOMINAL.arm.b)), (float(NOMINAL.v_x), float(NOMINAL.v_y))
        ),
    )
    settings = {
        "plant": "normal (tables 3.1 and 3.2 of Ruoff 1993), noise and perturbations",
        "network": f"preferred (section 3.5.4), at most {_NEURONS} neurons",
        "replicate": str(replicate),
    }
    demo_page(run, settings=settings).write(page)
    if still is not None:
        write_png(demo_still(run), still)
