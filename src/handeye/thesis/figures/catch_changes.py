"""Beyond the thesis: what each change of the improved catcher is worth."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

import numpy as np
from matplotlib.figure import Figure

from handeye.reports.style import WIDE, color, name_y, new_figure, styled
from handeye.thesis.experiments.catch_improved import CHANGES
from handeye.thesis.figures.figure import Drawn
from handeye.thesis.figures.lines import band
from handeye.thesis.records import Records

_ROWS = {
    "all": "improved, with all changes",
    **{name.replace(" ", "-"): f"without {name}" for name in CHANGES},
    "none": "the thesis's learner",
}


@styled
def _changes(records: Records) -> Figure:
    """One bar for each learner, with its 95 % interval."""
    figure = new_figure(WIDE, 380.0)
    axes = figure.add_subplot()
    for y, name in enumerate(_ROWS):
        caught = 100.0 * records.values(f"catch-changes/{name}/mean_caught")
        mean, low, high = (float(edge[0]) for edge in band(caught[:, np.newaxis]))
        own = "after" if name in {"all", "none"} else "third"
        axes.barh(y, mean, height=0.62, color=color(own), alpha=0.85)
        axes.plot([low, min(high, 100.0)], [y, y], color=color("ink"), linewidth=1.4)
        axes.text(101.5, y, f"{mean:.1f} %", va="center", fontsize=11.5, color=color("ink"))
    axes.set_yticks(range(len(_ROWS)), list(_ROWS.values()))
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    axes.set_xlim(0.0, 112.0)
    axes.set_xticks([0, 20, 40, 60, 80, 100])
    axes.set_xlabel("Fresh throws of both balls with both arms [%]")
    name_y(axes, "Balls caught [%]")
    return figure


WORTH = [
    Drawn(
        "6.6",
        "What each change of the improved catcher is worth",
        "Each bar takes one change back and keeps the others. Fresh throws of both balls with both "
        "arms, identities unknown at the start, after 300 pursuits with each arm, 100 tosses of "
        "each ball and 50 mentored throws. Mean over replicates with its 95 % interval.",
        _changes,
        ("catch-changes",),
        ("catch-improved",),
    )
]
