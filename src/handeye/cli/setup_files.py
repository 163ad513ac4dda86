"""Files for other programs that a calibrated set-up is written to."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from handeye.calibration.arm.measurements import Instrument, PixelSightings
from handeye.calibration.exporting import (
    calibrated_joints_yaml,
    calibrated_urdf,
    camera_infos,
    hand_eyes,
)
from handeye.calibration.session import AnyCalibrator
from handeye.calibration.setups.fit import MixedFit
from handeye.calibration.setups.knowledge import looks
from handeye.cli.console import check_places
from handeye.errors import InvalidInput
from handeye.io.files import replace_file


class Wanted(NamedTuple):
    """Where to write what; None where it is not wanted.

    urdf, joints            files
    camera_info, hand_eye   a .yaml file for a single camera, or a folder for a file of each
    """

    urdf: Path | None = None
    joints: Path | None = None
    camera_info: Path | None = None
    hand_eye: Path | None = None


def check_wanted(
    wanted: Wanted, measurements: Sequence[Instrument], sizes: Mapping[str, tuple[int, int]]
) -> None:
    """Before any work: whether there is what is wanted, and a place for it.

    Raises:
        InvalidInput: naming the option and what to do.
    """
    cameras = {one.camera.name for one in measurements if isinstance(one, PixelSightings)}
    if wanted.camera_info is not None:
        if not cameras:
            raise InvalidInput("--camera-info: there is no camera: no measurement is of `pixels`")
        unsized = sorted(cameras - set(sizes))
        if unsized:
            raise InvalidInput(
                f"--camera-info: state the size of the pictures of {', '.join(unsized)}: "
                "`size: [width, height]` under `cameras:`"
            )
        _check_place("--camera-info", wanted.camera_info, len(cameras))
    if wanted.hand_eye is not None:
        sensors = {one.sight.sensor.name for one in measurements if looks(one)}
        if not sensors:
            raise InvalidInput(
                "--hand-eye: there is no camera or sensor: nothing is of `points`, `poses` or "
                "`pixels`"
            )
        _check_place("--hand-eye", wanted.hand_eye, len(sensors))
    check_places(None, *(None if one is None else str(one) for one in wanted[:2]))


def write_files(
    wanted: Wanted,
    calibrated: AnyCalibrator | MixedFit,
    sizes: Mapping[str, tuple[int, int]] | None = None,
) -> dict[str, Path]:
    """Write what is wanted; where it is, by the option's name.

    Raises:
        InvalidInput: cameras or sensors are wanted of something that is no set-up.
    """
    files: dict[str, Path] = {}
    texts: dict[str, Callable[[], Mapping[str, str] | str]] = {
        "urdf": lambda: calibrated_urdf(calibrated),
        "joints": lambda: calibrated_joints_yaml(calibrated),
        "camera_info": lambda: camera_infos(_setup(calibrated), sizes or {}),
        "hand_eye": lambda: hand_eyes(_setup(calibrated)),
    }
    for what, place in wanted._asdict().items():
        if place is None:
            continue
        made = texts[what]()
        if isinstance(made, str):
            replace_file(place, made.encode())
        else:
            for name, text in made.items():
                file = place if _is_file(place) else place / f"{name.replace(' ', '_')}.yaml"
                replace_file(file, text.encode())
        files[what] = place
    return files


def _setup(calibrated: AnyCalibrator | MixedFit) -> MixedFit:
    if not isinstance(calibrated, MixedFit):
        raise InvalidInput(
            "only a model that `handeye calibrate --setup` saved knows of cameras and sensors; "
            "for a single camera whose poses were measured see `handeye hand-eye --yaml`"
        )
    return calibrated


def _check_place(option: str, place: Path, n: int) -> None:
    if _is_file(place) and n > 1:
        raise InvalidInput(f"{option}: there are {n} of them: give a folder, not {place}")
    if _is_file(place):
        check_places(None, str(place))
    else:
        check_places(place)


def _is_file(place: Path) -> bool:
    return place.suffix in {".yaml", ".yml", ".calib"}
