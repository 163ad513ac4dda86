"""Every figure of chapters 3 and 4: drawn from records, or listed with the reason why not.

Needs the extra "report"; importing `handeye.reports` says so where it is absent.
"""

import handeye.reports  # noqa: F401  # pyright: ignore[reportUnusedImport]
from handeye.thesis.figures.figure import Drawn as Drawn
from handeye.thesis.figures.figure import NotDrawn as NotDrawn
from handeye.thesis.figures.registry import FIGURES as FIGURES
from handeye.thesis.figures.registry import TOPICS as TOPICS
from handeye.thesis.figures.registry import drawable as drawable
from handeye.thesis.figures.registry import find_figure as find_figure
