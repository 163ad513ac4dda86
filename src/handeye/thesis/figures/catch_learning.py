"""Sections 4.5 to 4.7: predicted crossings, and catching as the arm practises."""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from matplotlib.figure import Figure

from handeye.thesis.figures.figure import Drawn, stated
from handeye.thesis.figures.layout import beside, single
from handeye.thesis.figures.lines import Line, Panel, Style, function, line
from handeye.thesis.records import Records

_LEARNED = "catching/thesis"
_PURSUITS = "Pursuits of practice"
_BANDS = "Mean over replicates with its 95 % band."


def _times(drawn: Line, factor: float) -> Line:
    """The line in another unit."""
    parts = {name: factor * getattr(drawn, name) for name in ("mean", "low", "high")}
    return replace(drawn, **parts)


def _prediction(records: Records, ball: str, what: str) -> Figure:
    """During one flight, and over many."""
    unit, factor = ("cm", 1e2) if what == "place" else ("ms", 1e3)
    at, (error,) = records.curve(f"{_LEARNED}/{ball}_flight_{what}")
    one = function("", at, factor * np.abs(error), "after", "-")
    balls = [
        replace(
            _times(line(records, f"{_LEARNED}/{name}_{what}_error", f"{name} ball", shade), factor),
            x=100.0 * records.curve(f"{_LEARNED}/{name}_{what}_error")[0],
        )
        for name, shade in (("light", "third"), ("heavy", "before"))
    ]
    crossing = "place" if what == "place" else "time"
    return beside(
        [
            (
                f"One flight of the {ball} ball",
                [one],
                Panel(f"Error of the predicted {crossing}", unit, x="Time of flight [s]",
                      scale="zero"),
            ),
            (
                "Many flights",
                balls,
                Panel(f"Rms error of the predicted {crossing}", unit, x="Part of the flight [%]",
                      scale="zero", key=False),
            ),
        ],
        shared=False,
    )  # fmt: skip


def _over_pursuits(records: Records, quantity: str, factor: float) -> Sequence[Line]:
    named: dict[str, tuple[str, str, Style]] = {
        f"pursuits_{quantity}_20": ("twenty throws", "after", "--"),
        f"pursuits_{quantity}": ("fresh throws", "after", "-"),
        f"repeated_{quantity}": ("fresh throws,\nmore pursuits", "third", "-"),
    }
    drawn = [
        _times(line(records, f"{_LEARNED}/{name}", words, shade, style), factor)
        for name, (words, shade, style) in named.items()
    ]
    # Three bands on top of each other could not be told apart.
    return [
        replace(one, low=one.mean, high=one.mean) if one.style == "--" else one for one in drawn
    ]


def _rms(records: Records) -> Figure:
    drawn = _over_pursuits(records, "rms", 1e2)
    point = (1000.0, 1e2 * stated("arm-rms-1000"), "after")
    return single(drawn, _panel(drawn, "Rms position error at the crossing", "cm", point))


def _caught(records: Records) -> Figure:
    drawn = _over_pursuits(records, "caught", 1e2)
    point = (1000.0, 1e2 * stated("arm-learning-curve"), "after")
    return single(drawn, _panel(drawn, "Balls caught", "%", point))


def _panel(drawn: Sequence[Line], name: str, unit: str, point: tuple[float, float, str]) -> Panel:
    return Panel(name, unit, stated=[point], x=_PURSUITS, x_ticks=drawn[0].x.tolist(), scale="zero")


PREDICTION = [
    Drawn(
        number,
        f"How well the {words} of the crossing is predicted",
        f"On the left during one flight of the {ball} ball, for as long as there is a prediction: "
        "from the third tick until the bounce surprises. On the right over many flights of both "
        f"balls. {_BANDS}",
        partial(_prediction, ball=ball, what=what),
        ("catching",),
    )
    for number, ball, what, words in (
        ("4.7", "heavy", "place", "place"),
        ("4.8", "light", "time", "time"),
    )
]
CURVES = [
    Drawn(
        "4.11",
        "Position error of the heavy arm as it practises",
        "The heavy ball, both known. With one pursuit for each throw as in the thesis, and where "
        f"another may follow. {_BANDS} None is drawn for the twenty throws.",
        _rms,
        ("catching",),
        ("arm-rms-1000", "repeated-pursuit"),
    ),
    Drawn(
        "4.14",
        "Balls that the heavy arm catches as it practises",
        f"As figure 4.11. {_BANDS}",
        _caught,
        ("catching",),
        ("repeated-pursuit",),
    ),
]
