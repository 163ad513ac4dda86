"""Section 3.5.5: what noise leaves to an arm whose kinematics are right."""

from matplotlib.figure import Figure

from handeye.thesis.figures.figure import Drawn, stated
from handeye.thesis.figures.layout import single
from handeye.thesis.figures.lines import Panel, function, line, lines
from handeye.thesis.records import Records
from handeye.thesis.units import show, show_stated

_FLOOR, _EXAMPLE = "plant-noise-floor", "plant-noise-example"
_POSE = "noise-example/perfect"


def _floor(records: Records) -> Figure:
    named = {"with noise": "noise-floor/noisy/error", "without noise": "noise-floor/clean/error"}
    return single(lines(records, named), Panel(stated=[(5000.0, stated(_FLOOR), "after")]))


def _sightings(records: Records) -> Figure:
    """One replicate's distances, with their root mean square as measured and as stated."""
    trials, (first, *_) = records.curve(f"{_POSE}/visual")
    rms, said = float(records.values(f"{_POSE}/visual_rms").mean()), stated(_EXAMPLE)
    levels = [
        (rms, f"rms: {show(rms, 'm')}"),
        (said, f"rms stated: {show_stated(said, 'm')}"),
    ]
    distance = function("", trials, first, "after", "-")
    return single([distance], Panel("Visual error", levels=levels, scale="zero"))


def _averages(records: Records) -> Figure:
    drawn = [
        line(records, f"{_POSE}/visual_average", "visual error", "before"),
        line(records, f"{_POSE}/learned_average", "position error,\nlearning here", "after"),
    ]
    return single(drawn, Panel("Mean error", scale="zero"))


NOISE = [
    Drawn(
        "3.28",
        "A robot whose nominal kinematics are right",
        "Nothing is to be learned, and without noise nothing is; with noise, the network learns "
        "some of it. Mean over replicates with its 95 % band.",
        _floor,
        ("noise-floor",),
    ),
    Drawn(
        "3.29",
        "How far from the hand it is seen, over 100 trials",
        "The hand stays at one pose, two metres straight ahead of the eye. The first replicate; "
        "the root mean square is the mean over all of them.",
        _sightings,
        ("noise-example",),
    ),
    Drawn(
        "3.30",
        "The same, averaged over many sightings",
        "Means over fresh sightings after every 100 trials, and over replicates with their 95 % "
        "band. A network that learns at this pose alone finds out about the noise: the nominal "
        "angles of a noisy sighting tell how far it is off.",
        _averages,
        ("noise-example",),
    ),
]
