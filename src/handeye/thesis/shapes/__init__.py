"""Orderings and shapes that the thesis describes in words, as predicates over records.

A predicate's docstring is the statement that it checks. Its limits come with the claim.
"""

from handeye.thesis.shapes.adaptation import ADAPTATION
from handeye.thesis.shapes.allocation import ALLOCATION
from handeye.thesis.shapes.catch_pid import CATCH_PID
from handeye.thesis.shapes.catching import CATCHING
from handeye.thesis.shapes.drift import DRIFT
from handeye.thesis.shapes.estimation import ESTIMATION
from handeye.thesis.shapes.finding import Finding as Finding
from handeye.thesis.shapes.finding import Limits as Limits
from handeye.thesis.shapes.finding import Shape as Shape
from handeye.thesis.shapes.finding import in_every_replicate as in_every_replicate
from handeye.thesis.shapes.functions import FUNCTIONS
from handeye.thesis.shapes.hardware import HARDWARE
from handeye.thesis.shapes.plant import PLANT
from handeye.thesis.shapes.scenarios import SCENARIOS
from handeye.thesis.shapes.width import WIDTH

SHAPES: dict[str, Shape] = {
    **DRIFT,
    **PLANT,
    **ALLOCATION,
    **ADAPTATION,
    **WIDTH,
    **SCENARIOS,
    **ESTIMATION,
    **CATCHING,
    **CATCH_PID,
    **FUNCTIONS,
    **HARDWARE,
}
"""The predicate of every ordering and shape that can be checked, by claim."""
