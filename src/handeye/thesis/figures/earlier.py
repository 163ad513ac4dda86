"""Earlier hand-eye learners beside today's."""

from collections.abc import Mapping
from dataclasses import replace

from matplotlib.figure import Figure

from handeye.thesis.earlier import LEVELS, WORDS
from handeye.thesis.experiments.earlier import PLANTS
from handeye.thesis.figures.figure import Drawn
from handeye.thesis.figures.layout import beside
from handeye.thesis.figures.lines import Line, Panel, Style, line
from handeye.thesis.records import Records

_DRAWN: Mapping[str, tuple[str, Style]] = {
    "kuperstein": ("before", "-"),
    "murphy": ("before", "--"),
    "albus": ("fourth", "--"),
    "network": ("fourth", "-"),
    "estimator": ("third", "-"),
    "combined": ("after", "-"),
}
_PANEL = Panel(
    scale="decades",
    x_ticks=(1.0, 10.0, 100.0, 1000.0, 10_000.0),
    ends=10_000.0,
    levels=[(level, "") for level in LEVELS],
)


def _learners(records: Records, noise: str, *, named: bool) -> list[Line]:
    """Lines from the first trial on: none has no place on a logarithmic axis."""
    drawn = [
        line(records, f"earlier/{learner}-{noise}/error", WORDS[learner] if named else "", *shown)
        for learner, shown in _DRAWN.items()
    ]
    parts = ("x", "mean", "low", "high")
    return [replace(one, **{name: getattr(one, name)[1:] for name in parts}) for one in drawn]


def _both(records: Records) -> Figure:
    noisy, clean = PLANTS
    keyed = replace(_PANEL, key=True)
    return beside(
        [
            ("With noise", _learners(records, noisy, named=False), _PANEL),
            ("Without noise", _learners(records, clean, named=True), keyed),
        ],
        height=420.0,
    )


EARLIER = [
    Drawn(
        "6.11",
        "Earlier hand-eye learners and today's",
        "The two that learn the whole map begin metres away and need thousands of trials for "
        "centimetres; those that correct known kinematics begin at 4.5 cm. Dotted: 5, 2 and 1 cm. "
        "Mean over replicates with its 95 % band; fresh poses.",
        _both,
        ("earlier",),
    ),
]
