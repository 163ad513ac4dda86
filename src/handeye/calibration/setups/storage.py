"""A calibrated set-up as one file: arm, measurements, and all that was found."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from os import PathLike

from handeye.arrays import Array
from handeye.calibration.arm.measurements.storage import from_arrays, to_arrays
from handeye.calibration.arm.posterior import Posterior
from handeye.calibration.arm.problem import ArmProblem
from handeye.calibration.arm.sheet import ArmSheet
from handeye.calibration.setups.fit import MixedFit
from handeye.io.tensors import Header, restore, write_tensors
from handeye.robots.urdf import UrdfArm

FORMAT = "handeye.setup"
VERSION = 1


@dataclass(frozen=True, eq=False)
class StoredSetup:
    """A fit as it was saved, and sizes (width, height) [px] of cameras' pictures by name."""

    fit: MixedFit
    sizes: Mapping[str, tuple[int, int]]


def save_setup(
    path: str | PathLike[str], fit: MixedFit, sizes: Mapping[str, tuple[int, int]] | None = None
) -> None:
    """Write a fit with its measurements; an old file is replaced once the new one is complete."""
    arm = fit.problem.arm
    arrays = fit.posterior.arrays()
    instruments: list[Header] = []
    for i, one in enumerate(fit.given):
        own, header = to_arrays(one)
        arrays |= {f"measurement {i}.{name}": array for name, array in own.items()}
        instruments.append(header)
    header = {
        "urdf": arm.urdf, "tip": arm.tip, "eye": arm.eye, "name": arm.name,
        "sheet": asdict(fit.sheet), "measurements": instruments,
        "sizes": {name: list(size) for name, size in (sizes or {}).items()},
    }  # fmt: skip
    write_tensors(path, FORMAT, VERSION, arrays, header)


def load_setup(path: str | PathLike[str]) -> StoredSetup:
    """Read what `save_setup` wrote.

    Raises:
        FileFormatError: no such file, damaged, foreign, or from a newer version.
        MissingExtra: without pinocchio.
    """
    return restore(path, FORMAT, VERSION, "a calibrated set-up of handeye", _stored)


def _stored(arrays: dict[str, Array], header: Header) -> StoredSetup:
    sizes = {name: (int(size[0]), int(size[1])) for name, size in header["sizes"].items()}
    return StoredSetup(_fit(arrays, header), sizes)


def _fit(arrays: dict[str, Array], header: Header) -> MixedFit:
    arm = UrdfArm.from_text(header["urdf"], header["tip"], header["name"], header["eye"])
    sheet = ArmSheet.restored(header["sheet"])
    given = tuple(
        from_arrays(_part(f"measurement {i}.", arrays), one)
        for i, one in enumerate(header["measurements"])
    )
    problem = ArmProblem(arm, given, sheet, sheet.curves)
    posterior = Posterior.restored(problem, arrays)
    return MixedFit(problem, posterior, sheet, given)


def _part(prefix: str, arrays: dict[str, Array]) -> dict[str, Array]:
    return {n[len(prefix) :]: array for n, array in arrays.items() if n.startswith(prefix)}
