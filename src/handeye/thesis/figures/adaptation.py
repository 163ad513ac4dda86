"""Sections 3.5.3 to 3.5.5: how neurons are adjusted, and what the preferred network does."""

from matplotlib.figure import Figure

from handeye.thesis.figures.figure import Drawn, stated
from handeye.thesis.figures.layout import single, stacked
from handeye.thesis.figures.lines import ORDERED, Line, Panel, lines
from handeye.thesis.records import Records

RULES = {
    "gradient": "gradient descent",
    "virtual-neuron": "virtual neuron",
    "cmac": "CMAC",
}
RATES = (1.0, 0.1, 0.06, 0.02, 0.01)
BEST = {"gradient": 0.02, "virtual-neuron": 0.06, "cmac": 0.02}
"""The rates at which figure 3.21 compares the rules."""

_PREFERRED = {
    "200-noisy": ("200 neurons, noise", "after"),
    "200-clean": ("200 neurons", "third"),
    "free-noisy": ("no limit, noise", "before"),
    "free-clean": ("no limit", "fourth"),
}
_STATED = {
    "200-noisy": "preferred-200-noisy",
    "free-noisy": "preferred-free-noisy",
    "free-clean": "preferred-free-clean",
}


def _rates(records: Records, rule: str) -> Figure:
    named = {f"rate {rate:g}": f"adaptation/{rule}-{rate}/error" for rate in RATES}
    return single(lines(records, named, ORDERED[::-1]), Panel(key=True))


def _best(records: Records) -> Figure:
    named = {
        f"{words}, rate {BEST[rule]:g}": f"adaptation/{rule}-{BEST[rule]}/error"
        for rule, words in RULES.items()
    }
    return single(lines(records, named))


def _preferred(records: Records, quantity: str, *settings: str) -> list[Line]:
    return [
        line
        for setting in settings or _PREFERRED
        for words, color in [_PREFERRED[setting]]
        for line in lines(records, {words: f"preferred/{setting}/{quantity}"}, (color,))
    ]


def _errors(records: Records) -> Figure:
    points = [(5000.0, stated(claim), _PREFERRED[name][1]) for name, claim in _STATED.items()]
    return single(_preferred(records, "error"), Panel(stated=points))


def _spreads(records: Records) -> Figure:
    return single(_preferred(records, "spread"), Panel("Standard deviation of the position error"))


def _growth(records: Records) -> Figure:
    settings = ("200-noisy", "200-clean")
    counts = Panel("Neurons in use", "number", scale="zero")
    return stacked(
        [(_preferred(records, "error", *settings), Panel()),
         (_preferred(records, "neurons", *settings), counts)],
        (2.0, 1.0),
    )  # fmt: skip


def _rates_of(number: str, rule: str) -> Drawn:
    return Drawn(
        number,
        f"Learning rates of {RULES[rule]}",
        "200 neurons at random poses, with noise. Mean over replicates with its 95 % band.",
        lambda records: _rates(records, rule),
        ("adaptation",),
    )


ADAPTATION = [
    _rates_of("3.16", "gradient"),
    _rates_of("3.18", "virtual-neuron"),
    _rates_of("3.20", "cmac"),
    Drawn(
        "3.21",
        "The three adaptation rules at the rates that the thesis found best",
        "200 neurons at random poses, with noise. Mean over replicates with its 95 % band.",
        _best,
        ("adaptation",),
    ),
    Drawn(
        "3.22",
        "The preferred network, with and without noise and a limit of neurons",
        "Noise sets the floor that both noisy networks reach; without it, a network that may grow "
        "goes on improving. Mean over replicates with its 95 % band.",
        _errors,
        ("preferred",),
    ),
    Drawn(
        "3.23",
        "How much the errors of the preferred network differ from pose to pose",
        "Sample standard deviation over the test poses of figure 3.22, mean over replicates with "
        "its 95 % band.",
        _spreads,
        ("preferred",),
    ),
    Drawn(
        "3.26",
        "Learning before and after the last neuron is added",
        "Once all 200 neurons are in use, what they know is only adjusted. Mean over replicates "
        "with its 95 % band.",
        _growth,
        ("preferred",),
    ),
]
