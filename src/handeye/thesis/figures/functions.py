"""Appendix A and conclusion 5.1.1: pairs of sigmoids, what they build, and back-propagation."""

from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

from handeye.thesis.experiments.functions_pairs import ORDER
from handeye.thesis.figures.figure import Drawn
from handeye.thesis.figures.layout import Titled, beside, single, stacked
from handeye.thesis.figures.lines import ORDERED, Line, Panel, line
from handeye.thesis.records import Records

_PAIR = "paired-sigmoids"
_SERIES = "paired-series/triangle"
_ANSWER = Panel(
    "Response", "saturated neuron = 1", x="Excitation, from the middle of the pair", scale="zero"
)
_LEARNED = {
    "Fourier series": ("series", "after"),
    "random": ("random", "before"),
    "Gaussian modules": ("gaussians", "third"),
    "resource allocating": ("allocating", "fourth"),
}


def _steep(records: Records) -> Figure:
    names = {"positive gain": "rising", "negative gain": "falling", "sum": "sum"}
    shades = ("third", "before", "after")
    return single(
        [
            line(records, f"{_PAIR}/steep/{quantity}", name, shade)
            for (name, quantity), shade in zip(names.items(), shades, strict=True)
        ],
        _ANSWER,
    )


def _smooth(records: Records) -> Figure:
    return single(
        [
            line(records, f"{_PAIR}/smooth/rising", "positive gain", "third"),
            line(records, f"{_PAIR}/smooth/falling", "negative gain", "before"),
            line(records, f"{_PAIR}/smooth/wave", "1 + sin", "soft", "--"),
            line(records, f"{_PAIR}/smooth/sum", "sum", "after"),
        ],
        _ANSWER,
    )


def _series(records: Records) -> Figure:
    module = [
        line(records, f"{_PAIR}/smooth/sinusoid", "sinusoid", "soft", "--"),
        line(records, f"{_PAIR}/smooth/module", "pair less one", "after"),
    ]
    module = [replace(one, x=one.x / np.pi) for one in module]
    # A triangle has no even harmonics.
    parts = [
        line(records, f"{_SERIES}/harmonic-{n}", f"harmonic {n}", ORDERED[-n])
        for n in range(1, ORDER + 1, 2)
    ]
    whole = [
        line(records, f"{_SERIES}/function", "function", "before"),
        line(records, f"{_SERIES}/series", "its series", "soft", "--"),
        line(records, f"{_SERIES}/network", "all pairs", "after"),
    ]
    return stacked(
        [
            (module, _ANSWER),
            (
                [*parts, *whole],
                Panel(
                    "Output",
                    "range of the function = 1",
                    x="Input, over half the interval",
                    scale="zero",
                ),
            ),
        ],
        (1.0, 1.6),
        height=620.0,
    )


def _later(one: Line) -> Line:
    """Without its first point, which has no place on a logarithmic axis."""
    parts = {name: getattr(one, name)[1:] for name in ("x", "mean", "low", "high")}
    return replace(one, **parts)


def _learned(records: Records) -> Figure:
    panels: list[Titled] = []
    for kind in ("triangle", "pulse", "polynomial"):
        last = kind == "polynomial"
        drawn = [
            line(records, f"fourier-structured/{kind}-{start}/error", name if last else "", shade)
            for name, (start, shade) in _LEARNED.items()
        ]
        panel = Panel(
            "Rms error", "range of the function = 1", x_ticks=(100, 1000, 10_000), scale="log"
        )
        panels.append((kind.capitalize(), drawn, panel))
    return beside(panels, columns=3, height=380.0, shared=False)


def _hand_eye(records: Records) -> Figure:
    layered = {
        "back-propagation as in eq A.1,\noutputs in radians": ("plain", "soft"),
        "one layer of 100": ("one-layer", "error2"),
        "two of 20": ("small", "error3"),
        "two of 50": ("two-layers", "before"),
    }
    drawn = [
        _later(line(records, f"back-propagation/{setting}/error", name, shade))
        for name, (setting, shade) in layered.items()
    ]
    drawn += [
        _later(line(records, f"preferred/{setting}-noisy/error", name, shade))
        for name, (setting, shade) in {
            "preferred network, 200 neurons": ("200", "third"),
            "preferred network, no limit": ("free", "after"),
        }.items()
    ]
    ticks = (100, 1000, 10_000, 100_000)
    return single(drawn, Panel(x_ticks=ticks, scale="zero", key=True), height=400.0)


def _influence(records: Records) -> Figure:
    left = {
        "layers": ("layered", "before"),
        "Fourier series": ("series", "third"),
        "sigma-pi, degree 5": ("sigma-pi", "fourth"),
    }
    right = {
        "Gaussian neurons,\nvirtual neuron rule": ("virtual", "after"),
        "Gaussian neurons,\nCMAC rule": ("cmac-rule", "before"),
        "Albus's CMAC": ("albus", "third"),
    }
    panel = Panel("Change of the output", "that at the sample = 1", x="Input", scale="zero")
    titles = ("Everything changes", "The neighbourhood changes")
    return stacked(
        [
            (
                [
                    line(records, f"influence/{s}/change", n, shade)
                    for n, (s, shade) in group.items()
                ],
                replace(panel, name=f"{title}: change of the output"),
            )
            for title, group in zip(titles, (left, right), strict=True)
        ],
        (1.0, 1.0),
        height=560.0,
    )


FUNCTIONS = [
    Drawn(
        "A.6",
        "A pair of steep sigmoids is a pulse",
        "Two hyperbolic tangents of opposite gains, 50 each, thresholds π apart. Their sum "
        "is two between the thresholds and nothing outside.",
        _steep,
        ("paired-sigmoids",),
    ),
    Drawn(
        "A.7",
        "A pair of gentle sigmoids is one period of a sinusoid",
        "Opposite gains, 1 each, thresholds π apart. From trough to trough the sum stays within "
        "8.3 % of its height of the sinusoid, and soon vanishes beyond.",
        _smooth,
        ("paired-sigmoids",),
    ),
    Drawn(
        "A.8",
        "Pairs side by side are an approximate Fourier series",
        "Above, a pair less one and the sinusoid that it stands for. Below, a triangle (about its "
        f"mean), its Fourier series up to harmonic {ORDER}, and the pairs of each harmonic with "
        "the series' coefficients, alone and together.",
        _series,
        ("paired-sigmoids", "paired-series"),
        ("paired-sigmoids",),
    ),
]

BEGINNINGS = [
    Drawn(
        "6.8",
        "Back-propagation from a structured and from a random beginning",
        "The same number of sigmoids in one layer and the same rule; only the first weights "
        "differ, and the rate, the best for each. The resource-allocating network has as many "
        "neurons as there are pairs. Other functions and inputs in each replicate; mean with its "
        "95 % band.",
        _learned,
        ("fourier-structured",),
        ("fourier-structured",),
    ),
    Drawn(
        "6.9",
        "Back-propagation learns the hand-eye correction",
        "Normal plant with noise and perturbations. Layered networks are given twenty times the "
        "trials of the preferred network. Mean over replicates with its 95 % band.",
        _hand_eye,
        ("back-propagation", "preferred"),
        ("bep-hand-eye",),
    ),
    Drawn(
        "6.10",
        "What else changes when one sample is learned",
        "Each network has learned a sine, then one sample at 0.2 whose target lies above its "
        "output. Where the curves are not zero, other inputs share what was learned there, wanted "
        "or not.",
        _influence,
        ("influence",),
    ),
]
