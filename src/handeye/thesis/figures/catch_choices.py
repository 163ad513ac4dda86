"""Beyond the thesis: how much hangs on its free choices, and what late senses cost."""

from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

from handeye.thesis.experiments.catch_choices import CHOICES, DELAYED, DELAYS
from handeye.thesis.figures.figure import Drawn
from handeye.thesis.figures.layout import Titled, beside
from handeye.thesis.figures.lines import Line, Panel, ends
from handeye.thesis.records import Records

_AXES = {
    "threshold": ("Error threshold", "Threshold [V]"),
    "velocity": ("Scale of velocity", "Scale [m/s]"),
    "time": ("Scale of time", "Scale [s]"),
    "amplitude": ("Least amplitude of practice", "Amplitude [V]"),
    "limits": ("Limits of the comparators", "Times as wide"),
}
_QUANTITIES = {"caught": ("Balls caught", "%", 1e2), "rms": ("Rms position error", "cm", 1e2)}
_PRACTICE = (
    "The heavy arm and ball, both known, after 60 tosses of each ball, 200 pursuits of the "
    "heavy arm and 100 of the light one; fresh throws. Mean over replicates with its 95 % band."
)


def _over(records: Records, paths: dict[float, str], quantity: str, name: str, shade: str) -> Line:
    factor = _QUANTITIES[quantity][2]
    drawn = ends(records, {x: f"{path}/{quantity}" for x, path in paths.items()}, name, shade)
    most = 100.0 if quantity == "caught" else np.inf
    parts = {
        part: np.minimum(factor * getattr(drawn, part), most) for part in ("mean", "low", "high")
    }
    return replace(drawn, **parts)


def _choices(records: Records) -> Figure:
    """One row for each choice: on the left what is caught, on the right the error."""
    panels: list[Titled] = []
    for name, (_, values) in CHOICES.items():
        title, x = _AXES[name]
        paths = {value: f"catch-choices/{name}-{value:g}" for value in values}
        for quantity, (words, unit, _) in _QUANTITIES.items():
            drawn = _over(records, paths, quantity, "", "after")
            panel = Panel(words, unit, x=x, x_ticks=values, scale="zero")
            panels.append((title, [drawn], panel))
    return beside(panels, height=1250.0, shared=False)


def _delay(records: Records) -> Figure:
    """What is caught, and the error, over the delay."""
    shades = {"thesis": "third", "improved": "after"}
    return beside(
        [
            (
                "Fresh throws",
                [
                    _over(
                        records,
                        {25.0 * ticks: f"catch-delay/{name}-{ticks}" for ticks in DELAYS},
                        quantity, "the thesis's" if name == "thesis" else name, shades[name],
                    )
                    for name in DELAYED
                ],
                Panel(words, unit, x="Delay of all senses [ms]", scale="zero"),
            )
            for quantity, (words, unit, _) in _QUANTITIES.items()
        ],
        shared=False,
    )  # fmt: skip


CHOSEN = [
    Drawn(
        "6.12",
        "What hangs on the choices that the thesis leaves open",
        "The first four concern the motor command net, where displacements have a scale of 1 m. "
        f"{_PRACTICE}",
        _choices,
        ("catch-choices",),
    ),
    Drawn(
        "6.13",
        "Catching with senses that report late",
        f"A tick of the clock is 25 ms. The learners practise with the same delay. {_PRACTICE}",
        _delay,
        ("catch-delay",),
    ),
]
