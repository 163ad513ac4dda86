"""How well does the conventional controller follow the two balls, and go to where they cross?

Section 4.8.3. Always the heavy arm with a linear amplifier (footnote 14).
"""

from dataclasses import dataclass, replace

import numpy as np

from handeye.arrays import Array, Booleans
from handeye.catching.arm import HEAVY_ARM, LIGHT_ARM
from handeye.catching.linear_loop import track
from handeye.catching.pid import PIDController, Reference, linear_amplifier
from handeye.catching.play import play
from handeye.catching.throws import Throws
from handeye.catching.world import World
from handeye.thesis.catching import BALLS, HEAVY, throws_for
from handeye.thesis.experiment import Effort, Experiment, Quantities

LAMBDAS: dict[Reference, tuple[float, ...]] = {"ball": (0.6, 0.1, 0.018), "crossing": (0.018,)}

LOST = 10.0
"""The largest error that is told [m]."""


@dataclass(frozen=True)
class Tracked:
    """A controller at work.

    reference  what it follows
    slow       lambda, the closed loop's time constant [s]
    exact      the arm moves as in the world, with collisions; else by Euler's method as in section
               4.8.2, and a ball that comes down between the walls of the cup is caught
    mistuned   the gains are those of the light arm, and the arm starts below the ball: of what we
               tried, the reading that comes closest to the stated numbers (note E13)
    """

    reference: Reference
    slow: float
    exact: bool = False
    mistuned: bool = False


WAYS = {
    "": Tracked("ball", 1.0),
    "exact-": Tracked("ball", 1.0, exact=True),
    "mistuned-": Tracked("ball", 1.0, mistuned=True),
}
"""Beginnings of the settings' names, and what they mean."""


def tracking(setting: Tracked, replicate: int, effort: Effort) -> Quantities:
    """Share caught, mean and rms position error at the crossing [m], of both sets of throws.

    <ball>_caught_20, <ball>_mean_20, <ball>_rms_20
                 of the thesis's sequence; without `_20` of fresh throws
    caught_20, caught
                 over both balls

    An error of more than `LOST` counts as that: of a loop that is unstable only this is known.
    """
    measured: dict[str, float] = {}
    for name, ball in BALLS.items():
        tests = throws_for(ball, HEAVY, replicate, effort)
        caught, error = _tracked(setting, tests.throws)
        first, fresh = slice(None, tests.sequence), slice(tests.sequence, None)
        for suffix, part in (("_20", first), ("", fresh)):
            known = np.clip(error[part], -LOST, LOST)
            measured |= {
                f"{name}_caught{suffix}": float(caught[part].mean()),
                f"{name}_mean{suffix}": float(known.mean()),
                f"{name}_rms{suffix}": float(np.sqrt(np.mean(known**2))),
            }
    both = {
        f"caught{suffix}": float(np.mean([measured[f"{n}_caught{suffix}"] for n in BALLS]))
        for suffix in ("_20", "")
    }
    return {**measured, **both}


def _tracked(setting: Tracked, throws: Throws) -> tuple[Booleans, Array]:
    """What is caught (N,), and the errors at the crossing (N,) [m]."""
    arm = linear_amplifier(HEAVY_ARM)
    tuned_for = LIGHT_ARM if setting.mistuned else HEAVY_ARM
    if setting.mistuned:
        throws = replace(throws, arm_x=throws.x)
    controller = PIDController(tuned_for, setting.slow, reference=setting.reference, throws=throws)
    if setting.exact:
        played = play(World(arms=(linear_amplifier(LIGHT_ARM), arm)), throws, controller)
        return played.caught, played.position_error
    tracked = track(controller, throws, arm)
    return tracked.caught(), tracked.position_error


CATCH_PID = Experiment(
    id="catch-pid",
    settings={
        f"{way}{reference}-{slow}": replace(how, reference=reference, slow=slow)
        for way, how in WAYS.items()
        for reference, lambdas in LAMBDAS.items()
        for slow in lambdas
    },
    measure=tracking,
    replicates=10,
)
