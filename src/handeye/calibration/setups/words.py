"""How a calibrated set-up is told to a person, on the console and on a page."""

import numpy as np

from handeye.calibration.results import Parameter

SHOWN = {"m": ("mm", 1e3), "rad": ("°", 180.0 / np.pi), "px": ("px", 1.0), "": ("", 1.0)}
"""How numbers of each unit are shown: the unit, and how many of it make one."""


def advice(*, held_out: bool) -> str:
    """Which numbers to trust, and why."""
    if held_out:
        return (
            "trust the held-out rows: each was predicted from the other blocks of every table alone"
        )
    return "these rows were fitted, which flatters: hold blocks of them out with --validate blocks"


def found_words(name: str, one: Parameter) -> tuple[str, str, str, str]:
    """Of a number of a thing with this name: what it is, its value, deviation, and as stated."""
    unit, times = SHOWN[one.unit]
    label = one.name.removeprefix(f"{name} ")
    label = f"turn about {label[1]}" if label in {"rx", "ry", "rz"} else label
    spread = times * (one.std or 0.0)
    digits = max(0, 1 - int(np.floor(np.log10(spread)))) if spread > 0.0 else 6
    stated = "" if one.nominal is None else f"{times * one.nominal:.{digits}f}"
    shown = f"{times * one.value:.{digits}f}"
    return f"{label} [{unit}]" if unit else label, shown, f"{spread:.2g}", stated
