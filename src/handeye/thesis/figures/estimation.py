"""Section 3.6.2: networks and nonlinear estimation."""

from collections.abc import Mapping, Sequence

from matplotlib.figure import Figure

from handeye.thesis.experiments.estimation import NETWORKS
from handeye.thesis.figures.figure import Drawn, stated
from handeye.thesis.figures.layout import single
from handeye.thesis.figures.lines import Panel, Style, line
from handeye.thesis.records import Records

_METHODS: Mapping[str, tuple[str, str, Style]] = {
    "forward": ("thesis, forward", "before", "-"),
    "reverse": ("thesis, reverse", "before", "--"),
    "modern": ("today's estimator", "third", "-"),
}
_END = 500.0


def _compared(records: Records, place: str, points: Sequence[tuple[float, float, str]]) -> Figure:
    """Mean errors of the network and of every estimator, from centimetres to nanometres."""
    network: tuple[str, str, Style] = (f"network, {NETWORKS[place]} neurons", "after", "-")
    drawn = [
        line(records, f"estimation/{place}-{name}/error", *as_drawn)
        for name, as_drawn in {"network": network, **_METHODS}.items()
    ]
    return single(drawn, Panel(stated=points, key=True, scale="decades"), 420.0)


def _estimation(
    number: str, place: str, title: str, caption: str, network: str, estimator: str, after: float
) -> Drawn:
    def draw(records: Records) -> Figure:
        points = [(_END, stated(network), "after"), (after, stated(estimator), "before")]
        return _compared(records, place, points)

    return Drawn(
        number,
        title,
        f"{caption} No noise, no perturbations; errors below a nanometre are drawn there. Mean "
        "over replicates with its 95 % band.",
        draw,
        ("estimation",),
    )


ESTIMATION = [
    _estimation(
        "3.51", "normal", "Network and estimators on the normal plant",
        "What can be said by a few parameters is known after a few trials.",
        "net-500-normal", "lm-normal", 10.0,
    ),
    _estimation(
        "3.52", "large", "Network and estimators on the plant with large errors",
        "The further the nominal model is off, the more the network has to learn; estimators do "
        "not mind.", "net-500-large", "lm-large", _END,
    ),
    _estimation(
        "3.53", "local", "Network and estimators in a small region",
        "A region of about 20 cm, whose poses are so alike that they hardly tell parameters apart.",
        "local-net", "local-lm", _END,
    ),
]  # fmt: skip
