"""How do the two balls fly and bounce, and how does the heavy arm answer a training pulse?

Sections 4.4.1 and 4.6, figures 4.3, 4.4, 4.9, 4.10.
"""

from collections.abc import Callable

import numpy as np

from handeye.catching.arm import HEAVY_ARM
from handeye.catching.layout import Layout
from handeye.catching.movements import Pulses, execute
from handeye.catching.play import play
from handeye.catching.throws import draw_throws
from handeye.catching.world import World
from handeye.randomness import stream
from handeye.thesis.catching import BALLS
from handeye.thesis.experiment import Curve, Effort, Experiment, Quantities
from handeye.thesis.watching import Still

BOUNCES = 0.75
"""How long a ball is followed after it has come down [s]."""
FINER = 10
"""Moments per tick of the clock, so that a path shows where exactly the ball bounces."""
PULSE = Pulses(np.array([0.8]), np.array([2.2]), np.array([0.3]))
"""From one end of the crossing region to the other with a medium voltage."""

Example = Callable[[], dict[str, Curve]]


def flight(ball: int) -> dict[str, Curve]:
    """Curves x and z [m] of one throw over time [s], the same for both balls but for the drag.

    The curves begin at the launch and have FINER points in a tick.
    """
    throw = draw_throws(1, stream("catching: a typical throw"), balls=(ball,), arms=(0,))
    layout = Layout(tick=Layout().tick / FINER)
    sensed = play(World(layout, collisions=False), throw, Still(), after=BOUNCES).sensed
    at = sensed.time[:, 0]
    return {"x": Curve(at, sensed.ball_x[:, 0]), "z": Curve(at, sensed.ball_z[:, 0])}


def light_flight() -> dict[str, Curve]:
    """`flight` of the light ball."""
    return flight(BALLS["light"])


def heavy_flight() -> dict[str, Curve]:
    """`flight` of the heavy ball."""
    return flight(BALLS["heavy"])


def pursuit() -> dict[str, Curve]:
    """Curves voltage [V], position [m] and velocity [m/s] of PULSE over time [s]."""
    made = execute(HEAVY_ARM, PULSE)
    at = np.append(made.time[:, 0], made.stop_time)
    ends = {"voltage": 0.0, "arm_x": made.stop_x[0], "arm_v": 0.0}
    return {
        name: Curve(at, np.append(getattr(made, name)[:, 0], end)) for name, end in ends.items()
    }


def shown(setting: Example, replicate: int, effort: Effort) -> Quantities:  # noqa: ARG001
    """The example itself, which is short in any run."""
    return setting()


CATCH_FLIGHTS = Experiment(
    id="catch-flights",
    settings={"light-ball": light_flight, "heavy-ball": heavy_flight, "heavy-arm": pursuit},
    measure=shown,
    deterministic=True,
)
