"""Every figure of chapters 3 and 4, appendix A and beyond the thesis (6.1 and on), by number."""

from collections.abc import Iterable

from handeye.errors import InvalidInput
from handeye.thesis.figures.adaptation import ADAPTATION
from handeye.thesis.figures.allocation import ALLOCATION
from handeye.thesis.figures.catch_changes import WORTH
from handeye.thesis.figures.catch_choices import CHOSEN
from handeye.thesis.figures.catch_examples import EXAMPLES, RESPONSES
from handeye.thesis.figures.catch_learning import CURVES, PREDICTION
from handeye.thesis.figures.catch_world import PULSE, WORLD
from handeye.thesis.figures.combined import BEYOND
from handeye.thesis.figures.drawings import DRAWINGS
from handeye.thesis.figures.earlier import EARLIER
from handeye.thesis.figures.estimation import ESTIMATION
from handeye.thesis.figures.figure import Drawn, NotDrawn
from handeye.thesis.figures.frequency import FREQUENCY
from handeye.thesis.figures.functions import BEGINNINGS, FUNCTIONS
from handeye.thesis.figures.hardware import HARDWARE
from handeye.thesis.figures.noise import NOISE
from handeye.thesis.figures.plant import PLANT
from handeye.thesis.figures.real_arms import REAL
from handeye.thesis.figures.scenarios import SCENARIOS
from handeye.thesis.figures.tracking import TRACKING
from handeye.thesis.figures.width import WIDTH

TOPICS: dict[str, list[Drawn]] = {
    "The plant": PLANT,
    "When and where neurons are added": ALLOCATION,
    "How neurons are adjusted": ADAPTATION,
    "Noise": NOISE,
    "How wide neurons are": WIDTH,
    "A plant that changes": [*TRACKING, *FREQUENCY],
    "Sources of error": SCENARIOS,
    "Nonlinear estimation": ESTIMATION,
    "Balls in flight": [*WORLD, *PREDICTION],
    "Learning to catch": [*PULSE, *CURVES, *EXAMPLES, *RESPONSES],
    "Beyond the thesis: the combined calibrator": BEYOND,
    "Beyond the thesis: the improved catcher": [*WORTH, *CHOSEN],
    "Beyond the thesis: real arms": REAL,
    "Earlier hand-eye learners": EARLIER,
    "Networks as functions": [*FUNCTIONS, *BEGINNINGS],
    "On a chip": HARDWARE,
}
"""The figures that are drawn, by topic."""


def _place(figure: Drawn | NotDrawn) -> tuple[int, str, int]:
    """Appendices come after the chapters of the thesis, and what is beyond it last."""
    chapter, _, number = figure.number.partition(".")
    return int(chapter) if chapter.isdigit() else 5, chapter, int(number)


FIGURES: dict[str, Drawn | NotDrawn] = {
    figure.number: figure
    for figure in sorted(
        (*DRAWINGS, *(figure for topic in TOPICS.values() for figure in topic)), key=_place
    )
}
"""Every figure by its number, in order."""


def find_figure(number: str) -> Drawn:
    """The figure of a number.

    Raises:
        InvalidInput: there is none, or it shows no result.
    """
    figure = FIGURES.get(number)
    if figure is None:
        first, *_, last = FIGURES
        raise InvalidInput(f"there is no figure {number}: figures go from {first} to {last}")
    if isinstance(figure, NotDrawn):
        raise InvalidInput(f"figure {number} shows no result: {figure.reason}")
    return figure


def drawable(experiments: Iterable[str]) -> list[Drawn]:
    """The figures that records of these experiments suffice for, in order."""
    there = set(experiments)
    return [
        figure
        for figure in FIGURES.values()
        if isinstance(figure, Drawn) and there.issuperset(figure.experiments)
    ]
