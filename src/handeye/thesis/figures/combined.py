"""Beyond the thesis: the combined calibrator beside all others and the least error there can be."""

from collections.abc import Mapping

from matplotlib.figure import Figure

from handeye.thesis.experiments.combined import MISFITS, PERIOD
from handeye.thesis.figures.figure import Drawn
from handeye.thesis.figures.layout import beside, single
from handeye.thesis.figures.lines import Line, Panel, Style, line
from handeye.thesis.records import Records

_DRAWN: Mapping[str, tuple[str, str, Style]] = {
    "error_nominal": ("Nominal", "before", "-"),
    "error_network": ("NetworkCorrection", "fourth", "-"),
    "error_estimator": ("ParameterEstimator", "third", "-"),
    "error_combined": ("Combined", "after", "-"),
    "floor": ("floor", "soft", "--"),
}
_SEEN = Panel(x="Observations", key=True, scale="log")
_BANDS = "Mean over replicates with its 95 % band; fresh poses."
_FLOOR = (
    "The floor is what noise in the sighting of the target leaves when the robot is fully known."
)


def _everyone(records: Records, place: str, *, floor: bool = True) -> list[Line]:
    return [
        line(records, f"{place}/{name}", *as_drawn)
        for name, as_drawn in _DRAWN.items()
        if floor or name != "floor"
    ]


def _noisy(records: Records) -> Figure:
    return _both(records, "noisy", _SEEN, floor=True)


def _clean(records: Records) -> Figure:
    panel = Panel(x="Observations", key=True, scale="decades")
    return _both(records, "clean", panel, floor=False)


def _both(records: Records, noise: str, panel: Panel, *, floor: bool) -> Figure:
    """The two plants beside each other, with one key."""
    plants = [
        (name, _everyone(records, f"combined/{plant}-{noise}", floor=floor))
        for name, plant in (("Normal plant", "normal"), ("Large errors", "large"))
    ]
    (first, left), (second, right) = plants
    unkeyed = Panel(x=panel.x, key=False, scale=panel.scale)
    return beside(
        [(first, _unnamed(left), unkeyed), (second, right, panel)], height=380.0, shared=floor
    )


def _unnamed(drawn: list[Line]) -> list[Line]:
    return [Line("", d.x, d.mean, d.low, d.high, d.color, d.style) for d in drawn]


def _slip(records: Records) -> Figure:
    panel = Panel(x="Observations since the slip", key=True, scale="log")
    return single(_everyone(records, "combined-step/slip"), panel, 400.0)


def _heat(records: Records) -> Figure:
    marks = [(k * float(PERIOD), f"period {k + 1}" if k else "") for k in range(4)]
    panel = Panel(x="Observations", key=True, scale="log", marks=marks[1:])
    return single(_everyone(records, "combined-heat/period-500"), panel, 400.0)


def _misfits(records: Records) -> Figure:
    ticks = (10.0, 100.0, 1000.0)
    panel = Panel(x="Observations", key=False, scale="log", x_ticks=ticks)
    titles = [name.replace("-", " ").capitalize() for name in MISFITS]
    drawn = [_everyone(records, f"combined-misfit/{name}") for name in MISFITS]
    *others, last = [_later(lines) for lines in drawn]
    panels = [(title, _unnamed(lines), panel) for title, lines in zip(titles, others, strict=False)]
    keyed = Panel(x=panel.x, key=True, scale="log", x_ticks=ticks)
    return beside([*panels, (titles[-1], last, keyed)], columns=3, height=380.0)


def _later(drawn: list[Line]) -> list[Line]:
    """Lines without their first point, which has no place on a logarithmic axis."""
    return [
        Line(d.name, d.x[1:], d.mean[1:], d.low[1:], d.high[1:], d.color, d.style) for d in drawn
    ]


BEYOND = [
    Drawn(
        "6.1",
        "Every calibrator with noise and perturbations",
        f"The combined calibrator reaches the floor in tens of observations. {_FLOOR} {_BANDS}",
        _noisy,
        ("combined",),
        ("combined-normal-noisy-50", "combined-normal-noisy-200", "combined-large-noisy-100",
         "combined-large-noisy-300"),
    ),
    Drawn(
        "6.2",
        "Every calibrator with perturbations and no noise",
        f"What is not a parameter is learned as a curve of one stage of the chain. {_BANDS}",
        _clean,
        ("combined",),
        ("combined-normal-clean-100", "combined-normal-clean-500", "combined-large-clean-300"),
    ),
    Drawn(
        "6.3",
        "After the shoulder's encoder has slipped by two degrees",
        "A run of surprises is recognised as a change of this offset, which alone is learned "
        f"anew. {_BANDS}",
        _slip,
        ("combined-step",),
        ("combined-step-recovery",),
    ),
    Drawn(
        "6.4",
        "Heat that comes and goes with a period of 500 observations",
        f"What drifts is followed; the network has learned only what was. {_BANDS}",
        _heat,
        ("combined-heat",),
        ("combined-thermal-500",),
    ),
    Drawn(
        "6.5",
        "Robots that the model was not made for",
        "Eccentric gears with three and seven turns per turn of the joint, a link that bends by "
        "2 cm under its weight, a lens that does not fit its halves. The floor is that of the "
        f"same robot without. {_BANDS}",
        _misfits,
        ("combined-misfit",),
    ),
]  # fmt: skip
