"""Section 3.5.7: a network follows a plant that is heated again and again."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from handeye.arrays import Array
from handeye.reports.style import WIDE, color, name_y, new_figure, styled
from handeye.thesis.analysis.first_order import amplitude_ratio, phase_lead
from handeye.thesis.experiments.periodic import PERIODS
from handeye.thesis.figures.figure import Drawn, stated
from handeye.thesis.figures.layout import Titled, beside, stacked
from handeye.thesis.figures.lines import Panel, Style, band, function, line
from handeye.thesis.records import Records

_RUN = "periodic/200"
_CORNER = "bode-corner"


def _one_period(records: Records) -> Figure:
    """Corrected and uncorrected error over two periods of 500 trials, and the temperature."""
    errors = [
        line(records, f"{_RUN}/error-500", "corrected", "after"),
        line(records, f"{_RUN}/uncorrected-500", "uncorrected", "before"),
    ]
    t = np.linspace(0.0, float(errors[0].x[-1]), 400)
    period = float(records.curve(f"{_RUN}/ratio")[0][PERIODS.index(500)])
    heat = function("", t, np.sin(2.0 * np.pi * t / period), "soft", "-")
    return stacked(
        [(errors, Panel(scale="zero")), ([heat], Panel("Temperature, of its amplitude", ""))],
        (2.4, 1.0),
    )


def _all_periods(records: Records) -> Figure:
    """Errors over the first two periods, for every period."""
    at, _ = records.curve(f"{_RUN}/ratio")
    panels: list[Titled] = []
    for i, (name, period) in enumerate(zip(PERIODS, at, strict=True)):
        curves = [
            line(records, f"{_RUN}/{quantity}-{name}", words if i == 2 else "", shade)
            for quantity, words, shade in (
                ("error", "corrected", "after"), ("uncorrected", "uncorrected", "before"),
            )
        ]  # fmt: skip
        curves = [replace(one, x=one.x / period) for one in curves]
        panels.append((f"{name:,} trials", curves, Panel(x="Periods", scale="zero", ends=2.0)))
    return beside(panels, columns=3, height=520.0)


class _Axis(NamedTuple):
    """What a Bode plot shows: a quantity of the records, how, its model, and its name."""

    quantity: str
    shown: Callable[[Array], Array]
    model: Callable[[Array, float], Array]
    name: str
    key: tuple[float, float]


def _decibels(ratio: Array) -> Array:
    return 20.0 * np.log10(np.maximum(ratio, 1e-4))


_AMPLITUDE = _Axis(
    "ratio",
    _decibels,
    amplitude_ratio,
    "Amplitude of the error, of the disturbance [dB]",
    (0.0, 0.3),
)
_PHASE = _Axis("lead", np.degrees, phase_lead, "Phase lead of the error [degrees]", (0.0, 0.75))


@styled
def _bode(records: Records, shown: _Axis) -> Figure:
    """Measured points, and first-order models with time constants that come from elsewhere."""
    figure = new_figure(WIDE, 400)
    axes = figure.add_subplot()
    # Side by side, not over each other.
    kinds = {
        shown.quantity: ("position error", "after", "o", 0.97),
        f"share_{shown.quantity}": ("signed share of the displacement", "third", "s", 1.03),
    }
    at, _ = records.curve(f"{_RUN}/{shown.quantity}")
    for path, (words, shade, marker, aside) in kinds.items():
        mean, low, high = band(shown.shown(records.curve(f"{_RUN}/{path}")[1]))
        axes.errorbar(
            aside * at, mean, (mean - low, high - mean), fmt=marker, color=color(shade),
            markersize=7, elinewidth=1.8, capsize=4, label=f"measured: {words}",
        )  # fmt: skip
    periods = np.geomspace(float(at[0]) / 1.5, float(at[-1]) * 1.5, 300)
    tau, corner = float(records.values("step/virtual-200/time_constant").mean()), stated(_CORNER)
    models: dict[str, tuple[float, str, Style]] = {
        "first order, from the measured step response": (tau, "before", "-"),
        "first order, from the corner stated in the thesis": (corner / (2 * np.pi), "soft", "--"),
    }
    for words, (tau, shade, style) in models.items():
        values = shown.shown(shown.model(periods, tau))
        axes.plot(periods, values, color=color(shade), linestyle=style, label=words)
    _name_periods(axes, at)
    name_y(axes, shown.name)
    if corner < axes.get_xlim()[1]:
        axes.axvline(corner, color=color("axis"), linewidth=1.2, linestyle=(0, (4, 3)), zorder=1)
        axes.annotate(
            f"corner as stated: {corner:g} trials", (corner, 0.02),
            xycoords=("data", "axes fraction"), xytext=(6, 0), textcoords="offset points",
            color=color("soft"), fontsize=12.5,
        )  # fmt: skip
    axes.legend(loc="center left", bbox_to_anchor=shown.key)
    return figure


def _name_periods(axes: Axes, periods: Array) -> None:
    axes.set_xscale("log")
    axes.set_xlim(periods[0] / 1.5, periods[-1] * 1.5)
    axes.set_xticks(periods, [f"{period:,.0f}" for period in periods])
    axes.set_xticks([], minor=True)
    axes.set_xlabel("Period of the disturbance [trials]")


FREQUENCY = [
    Drawn(
        "3.35",
        "Heat that comes and goes in 500 trials",
        "Errors of the trained network of 200 neurons and of nominal kinematics, with noise. Each "
        "trial is tested before it is learned; means over a twentieth of a period and over "
        "replicates, with their 95 % band.",
        _one_period,
        ("periodic",),
        (_CORNER,),
    ),
    Drawn(
        "3.36",
        "Heat that comes and goes, slower and slower",
        "Over the first two periods, of 100 to 5,000 trials: the slower the drift, the more of it "
        "the network follows. Means as in figure 3.35.",
        _all_periods,
        ("periodic",),
        (_CORNER,),
    ),
    Drawn(
        "3.37",
        "Amplitude of the error over the period of the heat",
        "Measured amplitudes of two kinds, with 95 % intervals over replicates, and the "
        "first-order model of eq 3.104 with time constants that come from elsewhere.",
        lambda records: _bode(records, _AMPLITUDE),
        ("periodic", "step"),
        ("bode-first-order",),
    ),
    Drawn(
        "3.38",
        "Phase of the error over the period of the heat",
        "As figure 3.37, with the model of eq 3.105: the error runs ahead of what causes it.",
        lambda records: _bode(records, _PHASE),
        ("periodic", "step"),
        ("bode-first-order",),
    ),
]
