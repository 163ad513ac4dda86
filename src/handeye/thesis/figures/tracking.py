"""Section 3.5.7: a network follows a plant that changes."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

import numpy as np
from matplotlib.figure import Figure

from handeye.arrays import Array
from handeye.thesis.figures.figure import Drawn, stated
from handeye.thesis.figures.layout import beside, single, stacked
from handeye.thesis.figures.lines import (
    Line,
    Panel,
    band,
    ends,
    function,
    line,
    lines,
    until,
)
from handeye.thesis.records import Records

_TAU, _START, _FLOOR = "step-time-constant", "step-initial-error", "step-final-error"
_SINCE = "Trials since the change"
_SIZES = {200: "error1", 1000: "error3", 3000: "error5"}
_ALL_SIZES = (200, 500, 1000, 1500, 2000, 2500, 3000)
_PHASES = {"180": "phase 180 degrees", "21.6": "phase 21.6 degrees", "90": "phase 90 degrees"}


def _training(records: Records) -> Figure:
    """Errors, their spread and their ratio, and neurons, while the network is first trained."""
    path = "preferred/200-noisy"
    errors = lines(
        records,
        {"corrected": f"{path}/error", "uncorrected": f"{path}/uncorrected",
         "standard deviation\nof the corrected": f"{path}/spread"},
        ("after", "before", "soft"),
    )  # fmt: skip
    at, corrected = records.curve(f"{path}/error")
    _, uncorrected = records.curve(f"{path}/uncorrected")
    ratio = Line("", at, *band(100.0 * corrected / uncorrected), "third")
    neurons = line(records, f"{path}/neurons", "", "soft")
    points = [(0.0, stated("plant-uncorrected-full"), "before"), (5000.0, stated(_FLOOR), "after")]
    return stacked(
        [(errors, Panel("Position error", stated=points)),
         ([ratio], Panel("Corrected error, of the uncorrected", "%", scale="zero")),
         ([neurons], Panel("Neurons in use", "number", scale="zero"))],
        (2.2, 1.0, 0.8),
        height=600.0,
    )  # fmt: skip


def _step(records: Records) -> Figure:
    error = line(records, "step/virtual-200/error", "corrected", "after")
    plain = line(records, "step/virtual-200/uncorrected", "uncorrected", "before")
    points = [(0.0, stated(_START), "after"), (5000.0, stated(_FLOOR), "after")]
    return single([error, plain], Panel(x=_SINCE, stated=points, scale="zero"))


def _ideal(records: Records) -> Figure:
    """The step response, and first-order ones of the same start and floor."""
    path, shown = "step/virtual-200", 1000.0
    error = until(line(records, f"{path}/error", "measured", "after"), shown)
    start, floor, tau = (
        float(records.values(f"{path}/{name}").mean())
        for name in ("start", "floor", "time_constant")
    )
    t = np.linspace(0.0, float(error.x[-1]), 400)

    def response(tau: float) -> Array:
        return floor + (start - floor) * np.exp(-t / tau)

    models = [
        function(f"first order, as fitted:\n{tau:.0f} trials", t, response(tau), "third"),
        function(
            f"first order, as stated:\n{stated(_TAU):g} trials", t, response(stated(_TAU)),
            "before", ":",
        ),
    ]  # fmt: skip
    return single([error, *models], Panel(x=_SINCE, scale="zero"))


def _by_size(records: Records, rule: str, sizes: tuple[int, ...]) -> Figure:
    """Step responses, and time constants over the number of neurons."""
    curves = [
        until(line(records, f"step/{rule}-{n}/error", f"{n:,} neurons", shade), 1500.0)
        for n, shade in _SIZES.items()
    ]
    taus = ends(records, {n: f"step/{rule}-{n}/time_constant" for n in sizes}, "", "after")
    point = [(200.0, stated(_TAU), "after")] if rule == "virtual" else []
    return beside(
        [
            ("Response", curves, Panel(x=_SINCE, scale="zero", key=True)),
            ("Time constant", [taus], Panel("Fitted time constant", "trials", stated=point,
                                            x="Neurons", scale="zero")),
        ],
        shared=False,
    )  # fmt: skip


def _extremes(records: Records) -> Figure:
    named = {words: f"step-extremes/{name}/error" for name, words in _PHASES.items()}
    shown = [until(one, 1500.0) for one in lines(records, named)]
    return single(shown, Panel(x=_SINCE, scale="zero"))


TRACKING = [
    Drawn(
        "3.32",
        "The 200-neuron network before anything changes",
        "First training with noise. Mean over replicates with its 95 % band.",
        _training,
        ("preferred",),
        ("preferred-200-noisy", _FLOOR),
    ),
    Drawn(
        "3.33",
        "The shoulder's encoder slips by two degrees",
        "The trained network of 200 neurons, with noise, learns again. Mean over replicates with "
        "its 95 % band.",
        _step,
        ("step",),
        (_START, _FLOOR),
    ),
    Drawn(
        "3.34",
        "The same slip beside first-order responses",
        "Both models start and end as the fitted response does. Mean over replicates with its "
        "95 % band.",
        _ideal,
        ("step",),
    ),
    Drawn(
        "3.39",
        "Heat that stays, at three phases of the thermal drift",
        "A trained network of 200 neurons, with noise. Mean over replicates with its 95 % band.",
        _extremes,
        ("step-extremes",),
    ),
    Drawn(
        "3.40",
        "The slip with more neurons: virtual neuron",
        "A virtual neuron is as wide as the distance to its neighbours, so that in a larger "
        "network a lesson reaches less far. Mean over replicates with its 95 % band.",
        lambda records: _by_size(records, "virtual", _ALL_SIZES),
        ("step",),
    ),
    Drawn(
        "3.41",
        "The slip with more neurons: gradient descent",
        "As figure 3.40, but every neuron that answers is adjusted.",
        lambda records: _by_size(records, "gradient", tuple(_SIZES)),
        ("step",),
    ),
]
