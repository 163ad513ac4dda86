"""Section 3.5.6, and 3.5.9 on other responses: how wide a neuron should be."""

from collections.abc import Mapping

from matplotlib.figure import Figure

from handeye.thesis.figures.figure import Drawn
from handeye.thesis.figures.layout import beside
from handeye.thesis.figures.lines import ORDERED, Line, Panel, ends, lines, until
from handeye.thesis.records import Records

_X = "Half-maximum distance h [distances to the neighbour]"


def _two(
    records: Records, curves: Mapping[str, str], over: list[Line], ticks: list[float]
) -> Figure:
    """Learning curves, and the errors at the end over the width."""
    shown = lines(records, curves, ORDERED)
    return beside(
        [
            ("While learning", shown, Panel(key=True, scale="log")),
            ("In the end", over, Panel(x=_X, x_ticks=ticks, scale="log")),
        ],
        shared=False,
        height=400.0,
    )


def _over(records: Records, experiment: str, begins: str, name: str, shade: str) -> Line:
    """Errors at the end over h, for the settings of an experiment that begin so."""
    settings = [one for one in records.settings(experiment) if one.startswith(begins)]
    paths = {float(s.removeprefix(begins)): f"{experiment}/{s}/error" for s in settings}
    return ends(records, dict(sorted(paths.items())), name, shade)


def _gaussian(records: Records) -> Figure:
    curves = {f"h = {h:g}": f"width/h-{h}/error" for h in (0.4, 0.8, 1.2, 4.0, 100.0)}
    over = [
        _over(records, "width", "h-", "active neurons\nare corrected", "after"),
        _over(records, "width", "all-active-h-", "all that answer", "before"),
    ]
    return _two(records, curves, over, [0.1, 0.2, 0.4, 1.0, 2.0, 4.0, 10.0, 100.0])


def _others(records: Records) -> Figure:
    curves = {f"h = {h:g}": f"responses/parabolic-h-{h}/error" for h in (1.0, 1.5, 2.0, 4.0)}
    over = [
        _over(records, "responses", "parabolic-h-", "parabolic", "before"),
        _over(records, "responses", "cosine-h-", "cosine", "third"),
        until(_over(records, "width", "h-", "Gaussian", "after"), 10.0),
        _over(
            records, "responses", "all-active-parabolic-h-", "parabolic, all\nthat answer", "soft"
        ),
    ]
    return _two(records, curves, over, [0.1, 0.2, 0.4, 0.6, 1.0, 2.0, 4.0, 10.0])


WIDTH = [
    Drawn(
        "3.31",
        "How wide a neuron should be",
        "200 neurons without noise. h is the distance at which a new neuron answers half as much "
        "as at its centre, as a multiple of the distance to its nearest neighbour. Where learning "
        "diverges, the hand may go anywhere: that happens if every neuron that answers at all is "
        "corrected, not only active ones. Mean over replicates with its 95 % band.",
        _gaussian,
        ("width",),
    ),
    Drawn(
        "3.49",
        "Neurons with other responses",
        "On the left parabolic neurons, on the right all kinds; 200 of them, without noise. h and "
        "what is corrected as in figure 3.31. Mean over replicates with its 95 % band.",
        _others,
        ("responses", "width"),
    ),
]
