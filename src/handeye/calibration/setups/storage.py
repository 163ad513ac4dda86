"""A calibrated set-up as one file: arm, measurements, and all that was found."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from os import PathLike

import numpy as np

from handeye.arrays import Array, shaped
from handeye.calibration.arm.evidence import Posterior
from handeye.calibration.arm.measurements.storage import from_arrays, to_arrays
from handeye.calibration.arm.problem import ArmProblem
from handeye.calibration.arm.sheet import ArmSheet
from handeye.calibration.arm.student import Noise
from handeye.calibration.setups.fit import MixedFit, values_of
from handeye.io.tensors import Header, restore, write_tensors
from handeye.robots.urdf import UrdfArm

FORMAT = "handeye.setup"
VERSION = 1

_FOUND = ("x", "widths", "used", "squares")


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
    arrays = {name: getattr(fit.posterior, name) for name in _FOUND}
    arrays |= {"noise": fit.posterior.noise, "told": fit.posterior.rows_say(fit.posterior.used)}
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
    n, rows, channels = len(problem.tolerance), problem.n_rows, problem.n_channels
    x, widths = (shaped(arrays[name], (n,), name) for name in ("x", "widths"))
    used, squares = arrays["used"].astype(np.bool_), arrays["squares"]
    if used.shape != (n,) or squares.shape != (rows, channels):
        raise ValueError(f"used {used.shape}, squares {squares.shape}")
    noise = shaped(arrays["noise"], (channels,), "noise")
    values = np.array([values_of(given, channel) for channel in problem.channels], np.int64)
    told = shaped(arrays["told"], (int(used.sum()),) * 2, "told")
    posterior = Posterior(x, widths, used, squares, problem, Noise(noise, squares, values), told)
    return MixedFit(problem, posterior, sheet, given)


def _part(prefix: str, arrays: dict[str, Array]) -> dict[str, Array]:
    return {n[len(prefix) :]: array for n, array in arrays.items() if n.startswith(prefix)}
