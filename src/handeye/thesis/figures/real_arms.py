"""Beyond the thesis: a real arm, learned while it works."""

from matplotlib.figure import Figure

from handeye.thesis.figures.figure import Drawn
from handeye.thesis.figures.layout import single
from handeye.thesis.figures.lines import Panel, line
from handeye.thesis.records import Records

_DRAWN = {
    "placement": ("nominal arm, placed", "before"),
    "network": ("network correction", "third"),
    "combined": ("Combined", "after"),
}


def _in_order(records: Records) -> Figure:
    drawn = [
        line(records, f"real-ur10-order/{learner}/error", *shown)
        for learner, shown in _DRAWN.items()
    ]
    panel = Panel(x="Rows learned", scale="log", x_ticks=(20.0, 50.0, 100.0, 300.0, 1000.0))
    return single(drawn, panel)


REAL = [
    Drawn(
        "6.14",
        "A UR10 under a laser tracker, row by row",
        "Rows in order, each tested before it is learned; points are means over the next hundred. "
        "The first twenty rows place sensor and marker. One robot on one day, so without a band.",
        _in_order,
        ("real-ur10-order",),
        ("ur10-heldout", "ur10-blocked"),
    )
]
