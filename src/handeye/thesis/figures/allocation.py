"""Section 3.5.2 and 3.5.5: when and where neurons are added."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

from collections.abc import Sequence

from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from handeye.reports.style import SERIES, WIDE, color, name_y, new_figure, styled
from handeye.thesis.figures.figure import Drawn, stated
from handeye.thesis.figures.layout import beside, single
from handeye.thesis.figures.lines import Line, Panel, lines
from handeye.thesis.records import Records
from handeye.thesis.units import scale_for, show_stated

SCHEDULES = {
    "3.47": "inverse",
    "3.48": "inverse root",
    "3.49": "inverse square",
    "3.50": "Gaussian",
    "3.51": "inverse cube root",
    "3.52": "logarithmic",
    "3.53": "inverse fifth root",
    "3.54": "no threshold",
    "3.55": "constant, 0.1",
    "3.56": "constant, 0.5",
}
"""In words how the distance from which a neuron is added depends on the trial, by equation."""

_FIRST, _SECOND = tuple(SCHEDULES)[:5], tuple(SCHEDULES)[5:]
_BOUND, _DELAY = "alloc-noisy-bound", "alloc-gaussian-delay"


def _paths(setting: str, equations: Sequence[str], quantity: str) -> dict[str, str]:
    return {f"{SCHEDULES[e]} ({e})": f"allocation/{setting}/{e}-{quantity}" for e in equations}


def _errors(records: Records, setting: str, equations: Sequence[str]) -> Figure:
    levels, marks = [], []
    if setting == "noisy":
        bound = stated(_BOUND)
        said = show_stated(bound, "m", scale_for(bound, "m"))
        levels = [(bound, f"lowest stated: {said}")]
        if "3.50" in equations:
            marks = [(stated(_DELAY), "stated: the Gaussian one begins")]
    return single(
        lines(records, _paths(setting, equations, "error")), Panel(levels=levels, marks=marks)
    )


def _counts(records: Records, setting: str, equations: Sequence[str]) -> Figure:
    panel = Panel("Neurons in use", "number", scale="zero")
    return single(lines(records, _paths(setting, equations, "neurons")), panel)


@styled
def _economy(records: Records, setting: str) -> Figure:
    """Mean error over mean number of neurons, for every schedule."""
    figure = new_figure(WIDE, 400)
    axes = figure.add_subplot()
    handles: list[Line2D] = []
    for i, (equation, words) in enumerate(SCHEDULES.items()):
        path = f"allocation/{setting}/{equation}"
        _, neurons = records.curve(f"{path}-neurons")
        _, errors = records.curve(f"{path}-error")
        special = equation == "3.50"
        handles += axes.plot(
            neurons.mean(axis=0), 100.0 * errors.mean(axis=0),
            color=color(SERIES[i % len(SERIES)]), linestyle="-" if i < len(_FIRST) else (0, (3, 2)),
            linewidth=3.4 if special else 1.8, zorder=4 if special else 3,
            label=f"{words} ({equation})",
        )  # fmt: skip
    axes.set_xscale("symlog", linthresh=10.0, linscale=0.5)
    axes.set_xlim(left=0.0)
    axes.set_xticks([0, 10, 100, 1000], ["0", "10", "100", "1,000"])
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("Neurons in use [number]")
    name_y(axes, "Mean position error [cm]")
    axes.legend(handles=handles, loc="center left", bbox_to_anchor=(1.01, 0.5), handlelength=2.2)
    return figure


def _grids(records: Records) -> Figure:
    places = {"random": "random poses", "variable": "finer and finer grid", "fixed": "even grid"}

    def panel(noise: str) -> list[Line]:
        return lines(records, {words: f"grids/{p}-{noise}/error" for p, words in places.items()})

    return beside(
        [("With noise", panel("noisy"), Panel()), ("Without noise", panel("clean"), Panel())]
    )


_CAPTION = "The numbers are those of equations. Mean over replicates with its 95 % band."

ALLOCATION = [
    Drawn(
        "3.10",
        "Five allocation schedules with noise: error",
        "Schedules that let neurons come soon end at the same error, the one that noise leaves. "
        + _CAPTION,
        lambda records: _errors(records, "noisy", _FIRST),
        ("allocation",),
        ("alloc-fast-five",),
    ),
    Drawn(
        "3.11",
        "Five allocation schedules with noise: neurons",
        "What the same schedules spend. " + _CAPTION,
        lambda records: _counts(records, "noisy", _FIRST),
        ("allocation",),
    ),
    Drawn(
        "3.12",
        "Five more allocation schedules with noise: error",
        "What lets few neurons in ends higher. " + _CAPTION,
        lambda records: _errors(records, "noisy", _SECOND),
        ("allocation",),
        ("alloc-fast-five",),
    ),
    Drawn(
        "3.13",
        "Five more allocation schedules with noise: neurons",
        "Without a threshold nearly every trial adds a neuron. " + _CAPTION,
        lambda records: _counts(records, "noisy", _SECOND),
        ("allocation",),
    ),
    Drawn(
        "3.14",
        "With noise, error against neurons for all ten schedules",
        "Means over replicates at equal trials. If what counts were only how many neurons there "
        "are, not when they came, all lines would be one.",
        lambda records: _economy(records, "noisy"),
        ("allocation",),
    ),
    Drawn(
        "3.15",
        "Neurons at random poses and on grids",
        "568 neurons each; the grid's poses are visited first. Mean over replicates with its 95 % "
        "band.",
        _grids,
        ("grids",),
    ),
    Drawn(
        "3.24",
        "Five allocation schedules without noise: error",
        "Without noise it pays to go on adding neurons. " + _CAPTION,
        lambda records: _errors(records, "clean", _FIRST),
        ("allocation",),
    ),
    Drawn(
        "3.25",
        "Five more allocation schedules without noise: error",
        _CAPTION,
        lambda records: _errors(records, "clean", _SECOND),
        ("allocation",),
    ),
    Drawn(
        "3.27",
        "Without noise, error against neurons for all ten schedules",
        "Means over replicates at equal trials: the lower a line, the more its schedule gets out "
        "of its neurons.",
        lambda records: _economy(records, "clean"),
        ("allocation",),
    ),
]
