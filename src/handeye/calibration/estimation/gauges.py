"""Changes of the parameters together that no sighting can notice."""

from typing import NamedTuple

import numpy as np

from handeye.arrays import Array, Integers


class Gauge(NamedTuple):
    """A unit direction (n,) of the free parameters, in tolerances, and what it means."""

    direction: Array
    words: str


_TURN = "turning arm, eye and both zeros (O_alpha, O_gamma, v) together"
_GROWTH = "growing all lengths while range_scale shrinks"
_HARMLESS = "(harmless: commands do not depend on it)"


def gauges(parameters: Array, free: Integers, tolerances: Array) -> tuple[Gauge, ...]:
    """Those at parameters (8,) that the free ones (n,), with their tolerances (n,), leave open.

    Sightings see the hand from the eye, so they stay the same when the whole robot turns about the
    arm's base with the x-axes that its zeros refer to. The range scale multiplies what was seen,
    so larger lengths with a smaller scale look the same.
    """
    a, b, v_x, v_y, *_, scale = parameters
    found: list[Gauge] = []
    for words, changes in (
        (_TURN, [0.0, 0.0, -v_y, v_x, 1.0, 0.0, 1.0, 0.0]),
        (_GROWTH, [a, b, v_x, v_y, 0.0, 0.0, 0.0, -scale]),
    ):
        full = np.array(changes)
        if not np.delete(full, free).any():
            direction = full[free] / tolerances
            found.append(Gauge(direction / np.linalg.norm(direction), f"{words} {_HARMLESS}"))
    return tuple(found)
