"""Appendix B: accuracy of a chip over the length of its words."""

from dataclasses import replace

from matplotlib.figure import Figure

from handeye.thesis.figures.figure import Drawn
from handeye.thesis.figures.layout import beside
from handeye.thesis.figures.lines import Line, Panel, Style, ends
from handeye.thesis.records import Records

_BITS = [8, 10, 12, 14, 16, 20, 24]
_RULES = {"virtual-neuron": ("virtual neuron", "after"), "cmac": ("CMAC", "before")}
_ROUNDINGS: dict[str, tuple[str, Style]] = {
    "": ("to the nearest", "-"),
    "-random": ("at random", "--"),
}


def _chips(records: Records, noise: str, named: bool) -> list[Line]:
    """Errors at the end over the word length, for both rules and roundings."""
    drawn: list[Line] = []
    for rule, (name, shade) in _RULES.items():
        for rounding, (rounded, style) in _ROUNDINGS.items():
            paths = {float(b): f"hardware/{rule}{rounding}-{noise}-{b}/error" for b in _BITS}
            words = f"{name},\n{rounded}" if named else ""
            drawn.append(replace(ends(records, paths, words, shade), style=style))
    return drawn


def _panel(records: Records, noise: str, named: bool) -> Panel:
    floating = [
        float(records.values(f"hardware/{rule}-{noise}-float/error").mean()) for rule in _RULES
    ]
    return Panel(
        x="Word length [bits]",
        x_ticks=_BITS,
        scale="zero",
        key=named,
        levels=[(level, "") for level in floating],
    )


def _words(records: Records) -> Figure:
    # One key, on the right, is enough.
    panels = (("Without noise", "clean", False), ("With noise", "noisy", True))
    return beside(
        [
            (title, _chips(records, noise, named), _panel(records, noise, named))
            for title, noise, named in panels
        ]
    )


HARDWARE = [
    Drawn(
        "6.7",
        "How many bits a chip needs",
        "200 neurons at random poses whose weights are adjusted on a chip in fixed point: the mean "
        "position error after 5,000 trials over the length of all words. Dotted, the same networks "
        "in double precision. Where a change of a weight is smaller than the last bit of a word, "
        "rounding to the nearest loses it; rounding at random keeps its mean. Mean over "
        "replicates with its 95 % band.",
        _words,
        ("hardware",),
        ("hardware-rules",),
    ),
]
