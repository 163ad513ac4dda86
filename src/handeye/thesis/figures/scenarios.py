"""Sections 3.5.8 and 3.5.9: sources of error, and what the network can do without."""

from collections.abc import Mapping, Sequence

from matplotlib.figure import Figure

from handeye.thesis.figures.figure import Drawn, stated
from handeye.thesis.figures.layout import single, stacked
from handeye.thesis.figures.lines import Line, Panel, Style, line
from handeye.thesis.records import Records

END = 5000.0
_BAND = " Mean over replicates with its 95 % band."
_COUNT = "preferred-free-clean-neurons"

Settings = Mapping[str, tuple[str, str, Style]]
"""Name, colour and style of the curves of a setting, by `experiment/setting`."""

_PERTURBED: Settings = {
    "preferred/200-clean": ("200 neurons", "before", "-"),
    "scenarios/unperturbed-200": ("200, unperturbed", "before", "--"),
    "preferred/free-clean": ("no limit", "after", "-"),
    "scenarios/unperturbed-free": ("no limit, unperturbed", "after", "--"),
}
_SCALED: Settings = {
    "scenarios/scale-0.5-200": ("half, 200 neurons", "before", "--"),
    "scenarios/scale-0.5-free": ("half, no limit", "before", "-"),
    "scenarios/scale-0.9-200": ("0.9, 200 neurons", "third", "--"),
    "scenarios/scale-0.9-free": ("0.9, no limit", "third", "-"),
    "preferred/200-clean": ("right, 200 neurons", "after", "--"),
    "preferred/free-clean": ("right, no limit", "after", "-"),
}
_FOVEATED: Settings = {
    "preferred/free-noisy": ("pointing nearby, noise", "before", "-"),
    "scenarios/foveate-noisy": ("foveating, noise", "before", "--"),
    "preferred/free-clean": ("pointing nearby", "after", "-"),
    "scenarios/foveate-clean": ("foveating", "after", "--"),
}
_WHOLE: Settings = {
    "scenarios/whole-map-noisy": ("whole map, noise", "before", "--"),
    "scenarios/whole-map-clean": ("whole map", "before", "-"),
    "preferred/free-noisy": ("correction, noise", "after", "--"),
    "preferred/free-clean": ("correction", "after", "-"),
}
_LARGE: Settings = {
    "scenarios/large-noisy": ("large errors, noise", "before", "--"),
    "scenarios/large-clean": ("large errors", "before", "-"),
    "preferred/free-noisy": ("normal errors, noise", "after", "--"),
    "preferred/free-clean": ("normal errors", "after", "-"),
}


def _curves(records: Records, settings: Settings, quantity: str = "error") -> list[Line]:
    return [line(records, f"{path}/{quantity}", *as_drawn) for path, as_drawn in settings.items()]


def _with_neurons(
    records: Records,
    settings: Settings,
    errors: Sequence[tuple[float, float, str]],
    neurons: Sequence[tuple[float, float, str]],
) -> Figure:
    """Errors, and below the neurons of the networks without limit."""
    free = {path: drawn for path, drawn in settings.items() if "200" not in path}
    counts = Panel("Neurons in use", "number", stated=neurons, scale="zero", key=True)
    return stacked(
        [(_curves(records, settings), Panel(stated=errors, key=True)),
         (_curves(records, free, "neurons"), counts)],
        (1.5, 1.0),
        height=560.0,
    )  # fmt: skip


def _perturbed(records: Records) -> Figure:
    neurons = [(END, stated("perturbation-neurons"), "after"), (END, stated(_COUNT), "after")]
    return _with_neurons(records, _PERTURBED, (), neurons)


def _scaled(records: Records) -> Figure:
    counts = {"scale-neurons-05": "before", "scale-neurons-09": "third", _COUNT: "after"}
    neurons = [(END, stated(claim), shade) for claim, shade in counts.items()]
    return _with_neurons(records, _SCALED, (), neurons)


def _foveated(records: Records) -> Figure:
    neurons = [(END, stated("foveation-neurons"), "after"), (END, stated(_COUNT), "after")]
    return _with_neurons(records, _FOVEATED, (), neurons)


def _whole(records: Records) -> Figure:
    errors = [(END, stated("whole-map"), "before")]
    neurons = [(END, stated("whole-map-neurons"), "before"), (END, stated(_COUNT), "after")]
    return _with_neurons(records, _WHOLE, errors, neurons)


def _large(records: Records) -> Figure:
    points = [(1000.0, stated("large-1000"), "before"), (END, stated("large-5000"), "before")]
    return single(_curves(records, _LARGE), Panel(stated=points, key=True), 400.0)


SCENARIOS = [
    Drawn(
        "3.42",
        "With and without the nonlinear perturbations",
        "No noise. Perturbations hardly change the error before learning, but make the correction "
        "a richer function." + _BAND,
        _perturbed,
        ("scenarios", "preferred"),
    ),
    Drawn(
        "3.43",
        "An eye that takes distances for shorter than they are",
        "No noise; every range is multiplied by a half, by 0.9 or is right." + _BAND,
        _scaled,
        ("scenarios", "preferred"),
    ),
    Drawn(
        "3.44",
        "Looking straight at the hand",
        "An eye that foveates has no eccentricity: the network has one input less, and one "
        "perturbation less to learn. No limit of neurons." + _BAND,
        _foveated,
        ("scenarios", "preferred"),
    ),
    Drawn(
        "3.45",
        "The whole map, or only its correction",
        "Without nominal kinematics the network has to learn the joint angles themselves. No limit "
        "of neurons." + _BAND,
        _whole,
        ("scenarios", "preferred"),
        ("whole-map-neurons",),
    ),
    Drawn(
        "3.48",
        "A plant with large errors",
        "Parameters of tables 3.3 and 3.4, beside the normal plant. No limit of neurons." + _BAND,
        _large,
        ("scenarios", "preferred"),
    ),
]
