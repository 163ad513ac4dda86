"""`handeye calibrate --setup`: a description of any measurements in; a calibrated arm out."""

from pathlib import Path
from typing import NamedTuple

from rich.markup import escape

from handeye.calibration.exporting import not_in_urdf
from handeye.calibration.setups.description import Description, load_description
from handeye.calibration.setups.run import SetupResult, calibrate_setup
from handeye.calibration.setups.storage import save_setup
from handeye.cli.console import err, no_page, progress_bar, write_json
from handeye.cli.setup_files import Wanted, check_wanted, write_files
from handeye.cli.setup_results import as_data, print_results
from handeye.errors import InvalidInput, MissingExtra
from handeye.robots.urdf import load_arm


class Described(NamedTuple):
    """A file that describes a set-up, and a robot instead of the one that it names."""

    file: Path
    robot: str | None
    tip: str | None
    eye: str | None = None


def calibrate_described(
    setup: Described,
    folder: Path,
    wanted: Wanted,
    json_file: str | None,
    *,
    validate: str,
    skip_bad: bool,
) -> None:
    """Fit, judge, and write what is wanted."""
    if validate == "random":
        raise InvalidInput(
            "--setup holds out blocks of rows, or none: choose --validate blocks or none"
        )
    described = load_described(setup, skip_bad=skip_bad)
    check_wanted(wanted, described.measurements, described.sizes)
    with progress_bar("fitting, then judging", 1) as (progress, task):
        result = calibrate_setup(
            described,
            validate=validate == "blocks",
            progress=lambda done, of: progress.update(task, completed=done, total=of),
        )
    name = setup.file.name
    model = folder / f"{setup.file.stem}.model.safetensors"
    save_setup(model, result.fit, described.sizes)
    files = {"model": model, "page": _page(result, name, folder / f"{setup.file.stem}.html")}
    files |= write_files(wanted, result.fit, described.sizes)
    if wanted.urdf is not None:
        left = ", ".join(not_in_urdf(result.fit))
        err().print(f"[dim]not in the URDF[/] {escape(left)}", highlight=False, soft_wrap=True)
    if json_file is not None:
        named = {what: None if path is None else str(path) for what, path in files.items()}
        write_json(as_data(result, str(setup.file)) | named, json_file)
    if json_file != "-":
        print_results(result, name, files)


def load_described(setup: Described, *, skip_bad: bool) -> Description:
    """What a file describes; what became of recordings is told on standard error."""
    if setup.robot == "planar":
        raise InvalidInput("--setup needs an arm from a URDF file; planar has a log of its own")
    if setup.robot is None and (setup.tip is not None or setup.eye is not None):
        raise InvalidInput(
            "--tip and --eye go with --robot; in a set-up `tip:` and `eye:` go with `robot:`"
        )
    arm = None if setup.robot is None else load_arm(setup.robot, setup.tip, setup.eye)
    described = load_description(setup.file, arm, skip_bad=skip_bad)
    for source in described.sources:
        for line in source.report.lines() if source.report else ():
            told = f"[dim]recording[/] {escape(source.file)}: {escape(line)}"
            err().print(told, highlight=False, soft_wrap=True)
    return described


def _page(result: SetupResult, name: str, path: Path) -> Path | None:
    """Write the report, or say what it needs: the calibration does not depend on it."""
    try:
        from handeye.reports.setup import setup_page  # noqa: PLC0415
    except MissingExtra as missing:
        no_page(missing)
        return None
    setup_page(result, name).write(path)
    return path
