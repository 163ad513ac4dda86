"""`handeye export`: what was learned in files that other programs and chips read."""

from pathlib import Path
from typing import Annotated, Any

import typer
from rich.markup import escape

from handeye.calibration.calibrators import NetworkCorrection
from handeye.calibration.setups.storage import FORMAT as SETUP
from handeye.calibration.setups.storage import load_setup
from handeye.calibration.storage import FORMAT as MODEL
from handeye.calibration.storage import load_model
from handeye.cli.console import err, out, table
from handeye.cli.setup_files import Wanted, check_wanted, write_files
from handeye.errors import InvalidInput
from handeye.io.kinds import kind_of
from handeye.networks import ResourceAllocatingNetwork
from handeye.networks.hardware import FixedPoint, HardwareNetwork
from handeye.networks.hardware.c_costs import CCosts
from handeye.networks.hardware.c_source import write_c
from handeye.networks.hardware.formats import LONGEST, SHORTEST

_DEFAULT_BITS = 16
_NETWORK = "A network as C"
_CAN = (
    "What can be exported: a model that `handeye calibrate --method network` saved, or the file of "
    "a ResourceAllocatingNetwork or HardwareNetwork"
)


def export(
    model: Annotated[
        Path,
        typer.Argument(
            help="Model that `handeye calibrate` saved, or the file of a network.",
            show_default=False,
        ),
    ],
    c: Annotated[
        Path | None,
        typer.Option(
            "--c",
            metavar="FOLDER",
            help="Folder for C99 files of a network.",
            show_default=False,
            rich_help_panel=_NETWORK,
        ),
    ] = None,
    urdf_file: Annotated[
        Path | None,
        typer.Option("--urdf", help="The URDF with the joints where they were found."),
    ] = None,
    joints_file: Annotated[
        Path | None, typer.Option("--joints-yaml", help="The joints' places as YAML for xacro.")
    ] = None,
    camera_info: Annotated[
        Path | None,
        typer.Option(
            "--camera-info",
            help="Cameras of a set-up as camera_info YAML: a file, or a folder for a file of each.",
        ),
    ] = None,
    hand_eye: Annotated[
        Path | None,
        typer.Option(
            "--hand-eye",
            help="Where sensors of a set-up are, as easy_handeye2 has it: a file, or a folder.",
        ),
    ] = None,
    word_length: Annotated[
        int | None,
        typer.Option(
            min=SHORTEST,
            max=LONGEST,
            rich_help_panel=_NETWORK,
            help=f"Bits of every number, in fixed point; {_DEFAULT_BITS} by default.",
            show_default=False,
        ),
    ] = None,
    floating: Annotated[
        bool,
        typer.Option(
            "--float",
            rich_help_panel=_NETWORK,
            help="Floating point instead: double, or float when compiled with -DNAME_REAL=float.",
        ),
    ] = False,
    random_rounding: Annotated[
        bool,
        typer.Option(
            "--random-rounding",
            rich_help_panel=_NETWORK,
            help="Round what is learned up or down at random, so that short words go on learning.",
        ),
    ] = False,
    frozen: Annotated[
        bool,
        typer.Option(
            "--frozen",
            rich_help_panel=_NETWORK,
            help="Leave learning out: the files only predict.",
        ),
    ] = False,
    name: Annotated[
        str,
        typer.Option(
            rich_help_panel=_NETWORK,
            help="Begins the names of the files and of everything in them.",
        ),
    ] = "network",
) -> None:
    """Write a calibrated arm, cameras and sensors, or a trained network, for other programs.

    A network, and how it goes on learning, becomes C without dependencies: a header, a source and a
    program that checks them against Python: compile the last two, run them, and keep the first two.
    In fixed point only whole numbers are used and the results are Python's to the bit. No neuron is
    added any more; learning adjusts those that exist.
    """
    wanted = Wanted(urdf_file, joints_file, camera_info, hand_eye)
    if c is None and not any(wanted):
        raise InvalidInput(
            "say what to write: --urdf, --joints-yaml, --camera-info, --hand-eye, --c"
        )
    if any(wanted):
        _write_calibrated(model, wanted)
    if c is None:
        return
    if floating and (word_length is not None or random_rounding):
        raise InvalidInput("--float has no words: leave out --word-length and --random-rounding")
    kind = kind_of(model)
    if kind == HardwareNetwork.FORMAT:
        if floating or word_length is not None or random_rounding or frozen:
            raise InvalidInput(
                f"{model}: is a chip already; it is exported as it is, without options"
            )
        chip = HardwareNetwork.load(model)
    else:
        rounding = "random" if random_rounding else "nearest"
        fixed = None if floating else FixedPoint(word_length or _DEFAULT_BITS, rounding=rounding)
        chip = _chip(model, kind, fixed, learns=not frozen)
    files = write_c(chip, c, name)
    out().print(_costs(chip))
    for file in files:
        err().print(f"wrote {escape(str(file))}", highlight=False, soft_wrap=True)


def _write_calibrated(model: Path, wanted: Wanted) -> None:
    if kind_of(model) == SETUP:
        stored = load_setup(model)
        check_wanted(wanted, stored.fit.given, stored.sizes)
        files = write_files(wanted, stored.fit, stored.sizes)
    else:
        check_wanted(Wanted(wanted.urdf, wanted.joints), (), {})
        files = write_files(wanted, load_model(model).calibrator)
    for file in files.values():
        err().print(f"wrote {escape(str(file))}", highlight=False, soft_wrap=True)


def _chip(model: Path, kind: str, fixed: FixedPoint | None, *, learns: bool) -> HardwareNetwork:
    try:
        return HardwareNetwork.of(_network(model, kind), fixed, learns=learns)
    except InvalidInput as error:
        hint = " Or give --frozen." if learns and "derivatives" in str(error) else ""
        raise InvalidInput(f"{model}: {error}{hint}") from error


def _network(model: Path, kind: str) -> ResourceAllocatingNetwork:
    if kind == ResourceAllocatingNetwork.FORMAT:
        return ResourceAllocatingNetwork.load(model)
    if kind != MODEL:
        raise InvalidInput(f"it holds a {kind}. {_CAN}.")
    calibrator: Any = load_model(model).calibrator
    if not isinstance(calibrator, NetworkCorrection):
        raise InvalidInput(f"it holds a {type(calibrator).__name__}, which is no network. {_CAN}.")
    network = calibrator.network
    if not isinstance(network, ResourceAllocatingNetwork):
        raise InvalidInput(f"its network is a {type(network).__name__}. {_CAN}.")
    return network


def _costs(chip: HardwareNetwork) -> Any:
    costs = CCosts.of(chip)
    title = (
        f"{chip.n_neurons} neurons: {costs.constants:,} bytes of constants, {costs.state:,} bytes "
        "of state"
    )
    columns = ("operations", "predict", *(["learn, at most"] if costs.learns else []))
    made = table(title, *columns)
    for row in costs.rows():
        made.add_row(*row[: len(columns)])
    return made
