"""Section 3.4.4 and tables 3.2, 3.4: the nonlinear perturbations."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

from typing import Any, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from handeye.arrays import Array
from handeye.reports.style import WIDE, color, name_y, new_figure, styled
from handeye.thesis.claims import claims_by_id
from handeye.thesis.figures.figure import Drawn
from handeye.thesis.records import Records

_MAGNIFIED = 10.0
_RADII: Array = np.radians([10.0, 20.0, 30.0])
_AXES = {
    "alpha": "Shoulder angle α",
    "beta": "Elbow angle β",
    "gamma": "Pointing angle γ",
    "eccentricity": "Eccentricity, at 2 m",
    "range": "Range",
}
_SIZE = "plant-perturbation-size"


@styled
def _circles(records: Records, plant: str) -> Figure:
    """Circles in the field of view, and where astigmatism moves their points."""
    at, (error, *_) = records.curve(f"distortions/{plant}/eccentricity")
    figure = new_figure(WIDE, 430)
    axes = figure.add_subplot()
    turn: Array = np.linspace(0.0, 2.0 * np.pi, 361)
    for i, radius in enumerate(_RADII.tolist()):
        across, up = radius * np.cos(turn), radius * np.sin(turn)
        moved = across + _MAGNIFIED * _between(across, at, error)
        axes.plot(
            np.degrees(across), np.degrees(up), color=color("soft"), linewidth=1.4,
            linestyle=(0, (3, 2)), label="_" if i else "as it is",
        )  # fmt: skip
        axes.plot(
            np.degrees(moved), np.degrees(up), color=color("before"),
            label="_" if i else f"as it is seen, {_MAGNIFIED:g} times magnified",
        )  # fmt: skip
    axes.set_aspect("equal")
    axes.set_xlabel("Angle across the optical axis [degrees]")
    name_y(axes, "Angle up [degrees]")
    axes.set_xticks(range(-30, 41, 10))
    axes.set_yticks(range(-30, 31, 10))
    axes.legend(loc="center left", bbox_to_anchor=(1.02, 0.5))
    return figure


def _between(x: Array, at: Array, values: Array) -> Array:
    """Values (N,) at `at` (N,), interpolated at x."""
    return cast("Any", np.interp)(x, at, values)


@styled
def _curves(records: Records, plant: str) -> Figure:
    """The error of every measured quantity, on axes that are the same for all plants."""
    figure = new_figure(WIDE, 470)
    axes: list[Axes] = list(figure.subplots(2, 3).ravel())
    largest = _largest(records)
    for panel, (name, words) in zip(axes, _AXES.items(), strict=False):
        at, (error, *_) = records.curve(f"distortions/{plant}/{name}")
        ranged = name == "range"
        x, y = (at, 100.0 * error) if ranged else (np.degrees(at), np.degrees(error))
        panel.axhline(0.0, color=color("axis"), linewidth=1.0)
        panel.plot(x, y, color=color("after"))
        limit = 100.0 * largest[1] if ranged else np.degrees(largest[0])
        panel.set_ylim(-1.1 * limit, 1.1 * limit)
        panel.set_xlim(x[0], x[-1])
        panel.set_xlabel(f"{words} [{'m' if ranged else 'degrees'}]")
        name_y(panel, f"Error [{'cm' if ranged else 'degrees'}]")
        if plant == "normal":
            _mark_stated(panel, ranged)
    axes[-1].axis("off")
    if plant == "normal":
        axes[-1].plot(
            [],
            [],
            color=color("soft"),
            linestyle=(0, (1.5, 2.5)),
            label="about the largest, as stated",
        )
        axes[-1].legend(loc="center left")
    return figure


def _largest(records: Records) -> tuple[float, float]:
    """Largest angular and range error of any plant."""

    def most(name: str) -> float:
        return max(
            float(np.max(np.abs(records.curve(f"distortions/{plant}/{name}")[1])))
            for plant in records.settings("distortions")
        )

    return max(most(name) for name in _AXES if name != "range"), most("range")


def _mark_stated(axes: Axes, ranged: bool) -> None:
    limits = claims_by_id()[_SIZE].limits
    # A centimetre at two metres is half a hundredth of a radian.
    size = 100.0 * limits["range"] if ranged else np.degrees(limits["angular"] / 2.0)
    for level in (size,) if ranged else (-size, size):
        axes.axhline(level, color=color("soft"), linewidth=1.4, linestyle=(0, (1.5, 2.5)))


def _circles_of(number: str, plant: str, words: str) -> Drawn:
    return Drawn(
        number,
        f"Astigmatism of the eye: {words}",
        "Circles around the optical axis, and how they are seen at 2 m: narrower on the left, "
        "wider on the right.",
        lambda records: _circles(records, plant),
        ("distortions",),
    )


def _curves_of(number: str, plant: str, words: str) -> Drawn:
    return Drawn(
        number,
        f"Nonlinear errors of encoders and eye: {words}",
        "Added to constant offsets of the encoders, which are not drawn. Figures 3.9 and 3.47 have "
        "the same axes.",
        lambda records: _curves(records, plant),
        ("distortions",),
    )


PLANT = [
    _circles_of("3.8", "normal", "normal plant"),
    _curves_of("3.9", "normal", "normal plant"),
    _circles_of("3.46", "large", "plant with large errors"),
    _curves_of("3.47", "large", "plant with large errors"),
]
