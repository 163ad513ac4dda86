"""A chip as C99 files without dependencies: header, source, and a program that checks them."""

import re
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from handeye.errors import InvalidInput
from handeye.io.files import replace_file
from handeye.networks.adaptation import CMAC, NoAdaptation, VirtualNeuron
from handeye.networks.hardware.c_costs import CCosts, word_type
from handeye.networks.hardware.c_text import fill, numbers
from handeye.networks.hardware.chip import HardwareNetwork
from handeye.networks.hardware.curves import CURVES, SPAN
from handeye.networks.hardware.fixed import GUARD, UNITS
from handeye.networks.hardware.fixed_width import FixedVirtualNeuron
from handeye.networks.responses import Cosine, Gaussian, Parabolic
from handeye.randomness import stream

SAMPLES = 32
"""Test vectors of the checking program."""

TIGHT, LOOSE = 1e-10, 1e-3
"""Precision of C in double and single precision, relative to the largest output or target."""

_NAME = re.compile(r"[a-z][a-z0-9_]*")


def write_c(
    chip: HardwareNetwork, folder: str | PathLike[str], name: str = "network"
) -> list[Path]:
    """Write `name`.h, `name`.c and `name`_check.c; old ones are replaced.

    In fixed point C gives what `chip` gives, to the bit, also after learning. In floating point it
    agrees to TIGHT times the largest output, or to LOOSE when compiled for single precision.

    Raises:
        InvalidInput: a name that is no C identifier of small letters; nothing was written.
        OSError: as the operating system gives it.
    """
    files = c_files(chip, name)
    for file, text in files.items():
        replace_file(Path(folder) / file, text.encode())
    return [Path(folder) / file for file in files]


def c_files(chip: HardwareNetwork, name: str = "network") -> dict[str, str]:
    """The texts of the files, by name; see `write_c`."""
    if not _NAME.fullmatch(name):
        raise InvalidInput(
            f"{name!r} cannot begin names in C: use small letters, digits and _, a letter first"
        )
    flags = _flags(chip)
    values = {"name": name, "NAME": name.upper(), "guard": f"{name.upper()}_H"}
    values |= {"and_lesson": " and its lesson" if flags["learns"] else ""}
    values |= _header(chip) | _constants(chip) | _vectors(chip, flags["learns"])
    return {
        f"{name}.h": fill("header", values, flags),
        f"{name}.c": fill("fixed" if flags["fixed"] else "floating", values, flags),
        f"{name}_check.c": fill("check", values, flags),
    }


def _flags(chip: HardwareNetwork) -> dict[str, bool]:
    rule, response = (type(k) for k in (chip.design.adaptation, chip.design.response))
    fixed = chip.design.fixed
    return {
        "fixed": fixed is not None,
        "scatters": fixed is not None and fixed.rounding == "random",
        "learns": rule is not NoAdaptation,
        "virtual": rule in {VirtualNeuron, FixedVirtualNeuron},
        "nearest": rule is VirtualNeuron,
        "one_width": rule is FixedVirtualNeuron,
        "cmac": rule is CMAC,
        "folds": CURVES[response],
        **{kind.__name__.lower(): response is kind for kind in (Gaussian, Cosine, Parabolic)},
    }


def _header(chip: HardwareNetwork) -> dict[str, Any]:
    design = chip.design
    fixed, ranges = design.fixed, design.ranges
    lines = [f" *   {i}: {low:.6g} to {high:.6g}" for i, (low, high) in enumerate(_box(chip))]
    values: dict[str, Any] = {}
    kind = "floating point"
    if fixed is not None and ranges is not None:
        kind = f"fixed point in words of {fixed.word_length} bits, weights rounded "
        kind += "at random" if fixed.rounding == "random" else "to the nearest"
        step = ranges.input_step(fixed.word_length) * design.inputs.scales
        middle = ranges.middle * design.inputs.scales
        lines = [
            f"{line}; middle {m:.9g}, step {s:.9g}"
            for line, m, s in zip(lines, middle, step, strict=True)
        ]
        lines += [f" * An output word counts {design.output_step:.9g}."]
        values = {"largest": fixed.largest, "weight_range": f"{ranges.weights:g}"}
    return values | {
        "inputs": chip.n_inputs,
        "outputs": chip.n_outputs,
        "neurons": chip.n_neurons,
        "response": type(design.response).__name__,
        "rule": _shown(design.adaptation),
        "numbers": kind,
        "ranges": "\n".join(lines),
        "costs": "\n".join(f" *   {line}".rstrip() for line in CCosts.of(chip).lines()),
    }


def _box(chip: HardwareNetwork) -> Any:
    """Lowest and highest value (d, 2) of every input, in input units."""
    space, ranges = chip.design.inputs, chip.design.ranges
    if ranges is None:
        return np.stack([space.low, space.high], axis=1)
    return (
        np.stack([ranges.middle - ranges.half, ranges.middle + ranges.half], axis=1)
        * (space.scales[:, np.newaxis])
    )


def _constants(chip: HardwareNetwork) -> dict[str, Any]:
    design, cells = chip.design, chip.cells
    arrays = {"centers": cells.centers.T, "gains": cells.gains, "weights": cells.weights}
    values: dict[str, Any] = {name: numbers(array) for name, array in arrays.items()}
    values |= {
        name: repr(getattr(value, "tolist", lambda v=value: v)())
        for name, value in chip.numbers._asdict().items()
    }
    values["scales"] = numbers(design.inputs.scales).strip()
    values["half_pi"] = repr(0.5 * np.pi)
    fixed, ranges = design.fixed, design.ranges
    if fixed is not None and ranges is not None:
        values |= {
            "word": word_type(fixed.word_length),
            "word_length": fixed.word_length,
            "guard_bits": GUARD,
            "unit_bits": UNITS,
            "span": SPAN,
            "per_unit": 2**fixed.index_bits,
            "shifts": numbers(cells.shifts),
            "responses": numbers(chip.tables.responses),
            "reciprocals": numbers(chip.tables.reciprocals),
            "noise": int(chip.registers.noise[0]),
            "middle": numbers(ranges.middle).strip(),
            "input_step": repr(ranges.input_step(fixed.word_length)),
            "output_step": repr(design.output_step),
        }
    return values | {"response": type(design.response).__name__}


def _vectors(chip: HardwareNetwork, learns: bool) -> dict[str, Any]:
    """Inputs in the box and a little beyond, outputs there, targets, and outputs afterwards."""
    design, learner = chip.design, chip.copy()
    rng = stream("export: test vectors")
    low, high = _box(chip).T
    x = low + (high - low) * rng.uniform(-0.05, 1.05, (SAMPLES, chip.n_inputs))
    before = learner.predict_many(x)
    size = float(np.abs(before).max()) or 1.0
    targets = before + 0.2 * size * rng.standard_normal(before.shape)
    if learns:
        learner.learn_many(x, targets)
    after = learner.predict_many(x)
    most = float(np.abs([before, targets, after]).max())
    given = design.input_words(design.inputs.scaled_inputs(x)) if design.fixed else x
    return {
        "samples": SAMPLES,
        "inputs_table": numbers(given),
        "outputs_table": numbers(design.output_words(before)),
        "targets_table": numbers(design.output_words(targets)),
        "learned_table": numbers(design.output_words(after)),
        "tight": repr(TIGHT * most),
        "loose": repr(LOOSE * most),
        "and_lessons": " and lessons" if learns else "",
    }


def _shown(kind: Any) -> str:
    fields = ", ".join(f"{name} {value:g}" for name, value in kind._asdict().items())
    return f"{type(kind).__name__} ({fields})" if fields else "none"
