"""`handeye suggest`: which poses to add."""

from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
import typer
from rich.markup import escape

from handeye.calibration.combined import Combined
from handeye.calibration.log_checks import check_log
from handeye.calibration.log_run import calibrate_log
from handeye.calibration.placed import arm_of
from handeye.calibration.placed_arm import PlacedArm
from handeye.calibration.setups.storage import FORMAT as SETUP
from handeye.calibration.setups.storage import load_setup
from handeye.calibration.storage import load_model
from handeye.calibration.suggesting import SuggestedPoses, suggest_poses
from handeye.calibration.view import View
from handeye.cli.bags import read_any
from handeye.cli.console import check_places, err, out, progress_bar, table, write_json
from handeye.cli.robot import ROBOT_HELP, load_robot
from handeye.cli.setup import Described
from handeye.cli.setup_suggestions import fitted_setup, suggest_for_setup
from handeye.errors import InvalidInput
from handeye.io.bags import BagOptions, is_bag
from handeye.io.kinds import kind_of
from handeye.io.targets import write_commands

_MODEL = ".safetensors"


class _Named(NamedTuple):
    """The robot of a log, by names."""

    robot: str | None = None
    tip: str | None = None
    eye: str | None = None


def suggest(
    source: Annotated[
        Path | None,
        typer.Argument(
            help="Calibrated model that `handeye calibrate` saved, or a log or recording.",
            show_default=False,
        ),
    ] = None,
    setup_file: Annotated[
        Path | None,
        typer.Option(
            "--setup",
            help="Instead, a YAML file that describes a set-up of any measurements.",
            show_default=False,
        ),
    ] = None,
    robot: Annotated[
        str | None,
        typer.Option(help=f"Of a log, or instead of a set-up's: {ROBOT_HELP}", show_default=False),
    ] = None,
    tip: Annotated[
        str | None, typer.Option(help="Link of the URDF that carries the marker.")
    ] = None,
    eye: Annotated[
        str | None,
        typer.Option(
            help="Link of the URDF that carries the sensor, if the robot itself carries it.",
            show_default=False,
        ),
    ] = None,
    n: Annotated[int, typer.Option("-n", min=1, help="How many poses.")] = 5,
    wider: Annotated[
        bool,
        typer.Option(
            "--wider",
            help="Also poses outside the range in which the joints have worked, where the marker "
            "stays in the space in which it was seen.",
        ),
    ] = False,
    field_of_view: Annotated[
        float | None,
        typer.Option(
            help="The marker stays within this angle across, around the z axis of the sensor's "
            "frame, degrees.",
            show_default=False,
        ),
    ] = None,
    near: Annotated[
        float, typer.Option(help="And no nearer to the sensor than this, metres.")
    ] = View.near,
    far: Annotated[
        float | None, typer.Option(help="And no farther than this, metres.", show_default=False)
    ] = None,
    facing: Annotated[
        float | None,
        typer.Option(
            help="And turned away from the sensor by no more than this, degrees: by the z axis of "
            "the marker's frame, for logs with orientations.",
            show_default=False,
        ),
    ] = None,
    target_file: Annotated[
        Path | None, typer.Option("--out", help="CSV file for the joints.")
    ] = None,
    json_file: Annotated[
        str | None, typer.Option("--json", help="Also write the poses as JSON; - prints them.")
    ] = None,
    skip_bad: Annotated[
        bool, typer.Option("--skip-bad", help="Use the good rows of a log that has bad ones.")
    ] = False,
) -> None:
    """Say which poses to add, so that the hand becomes more certain everywhere it works.

    Each pose is the one that helps most, given the ones before. Poses keep the joints' limits, and
    with the options on what the sensor sees, the marker stays in its view; whether something stands
    in the way is not known here. Of a set-up, its description or its model, it is also said which
    measurement to take there; a camera keeps all points in its picture.
    """
    check_places(None, json_file, None if target_file is None else str(target_file))
    named, view = _Named(robot, tip, eye), _view(field_of_view, near, far, facing)
    if (source is None) == (setup_file is None):
        raise InvalidInput("give a model or a log, or else --setup with a file that describes one")
    setup = None
    if setup_file is not None:
        setup = fitted_setup(Described(setup_file, *named), skip_bad=skip_bad)
    elif source is not None and _is_setup(source, named):
        setup = load_setup(source)
    if setup is not None:
        suggest_for_setup(
            setup, n, view=view, wider=wider, target_file=target_file, json_file=json_file
        )
        return
    assert source is not None
    calibrator, names = _calibrator(source, named, skip_bad=skip_bad)
    if not isinstance(calibrator, Combined):
        raise InvalidInput(
            f"{source}: a {type(calibrator).__name__} does not know how certain it is, so it "
            "cannot suggest poses: calibrate with --method combined"
        )
    found = suggest_poses(calibrator, n, wider=wider, view=view)
    if target_file is not None:
        write_commands(target_file, names, found.joints)
        err().print(f"{n} poses -> {escape(str(target_file))}", highlight=False)
    if json_file is not None:
        write_json(_as_data(names, found, calibrator), json_file)
    if json_file != "-":
        _print(names, found, calibrator)


def _is_setup(source: Path, named: _Named) -> bool:
    """Whether a file is the model of a set-up, of which everything is known."""
    return source.suffix == _MODEL and named == _Named() and kind_of(source) == SETUP


def _view(
    field_of_view: float | None, near: float, far: float | None, facing: float | None
) -> View | None:
    """As asked for, or None where nothing was."""
    if (field_of_view, near, far, facing) == (None, View.near, None, None):
        return None
    asked: dict[str, float] = {"near": near}
    if field_of_view is not None:
        asked["half_angle"] = np.radians(0.5 * field_of_view)
    if far is not None:
        asked["far"] = far
    if facing is not None:
        asked["facing"] = np.radians(facing)
    return View(**asked)


def _calibrator(source: Path, named: _Named, *, skip_bad: bool) -> tuple[Any, tuple[str, ...]]:
    if source.suffix == _MODEL:
        if named != _Named():
            raise InvalidInput(f"{source} knows its robot: leave out --robot, --tip and --eye")
        calibrator: Any = load_model(source).calibrator
        model = calibrator.model
        arm = model.arm if isinstance(model, PlacedArm) else model.nominal.arm
        return calibrator, arm.joint_names
    if named.robot is None:
        raise InvalidInput(f"{source}: a log needs --robot; a model ends in {_MODEL}")
    # As `handeye calibrate` does: of a table the joints tell which part of the robot is meant.
    table = None if is_bag(source) else read_any(source, BagOptions(), skip_bad=skip_bad)
    joints = None if table is None or table.log.kind == "stereo" else table.log.joint_names
    nominal = load_robot(named.robot, named.tip, named.eye, joints=joints)
    arm = arm_of(nominal)
    reading = table or read_any(source, BagOptions(), arm=arm, skip_bad=skip_bad)
    checked = check_log(arm, reading.log, skip_bad=skip_bad)
    with progress_bar("learning from the log", len(checked.log)) as (progress, task):
        done = calibrate_log(
            checked.log,
            nominal,
            method="combined",
            validate="none",
            progress=lambda k, total: progress.update(task, completed=k, total=total),
        )
    return done.calibrator, arm.joint_names


def _points(found: SuggestedPoses) -> bool:
    """Whether the eye can point beside the hand."""
    return bool(np.any(found.eccentricity))


def _as_data(names: tuple[str, ...], found: SuggestedPoses, calibrator: Combined) -> dict[str, Any]:
    known = calibrator.knowledge()
    return {
        "joint_names": list(names),
        "joints": found.joints.tolist(),
        "eccentricity": found.eccentricity.tolist() if _points(found) else None,
        "uncertainty_before": found.before,
        "uncertainty_after": found.after.tolist(),
        "undetermined": list(known.undetermined),
        "unit": "rad, m",
    }


def _print(names: tuple[str, ...], found: SuggestedPoses, calibrator: Combined) -> None:
    console = out()
    heads = [*(f"{name} [°]" for name in names), *(["beside the hand [°]"] * _points(found))]
    shown = table(
        f"Poses to add: the hand is now known to {1e3 * found.before:.3g} mm",
        "", *heads, "then known to [mm]", left=0,
    )  # fmt: skip
    for i, joints in enumerate(np.degrees(found.joints)):
        beside = [f"{np.degrees(found.eccentricity[i]):.1f}"] if _points(found) else []
        known = f"{1e3 * found.after[i]:#.3g}"
        shown.add_row(str(i + 1), *(f"{angle:.1f}" for angle in joints), *beside, known)
    console.print(shown)
    for line in calibrator.knowledge().undetermined[:5]:
        console.print(f"open      {escape(line)}", highlight=False, soft_wrap=True)
