"""How well does the thesis's learner know its arms and balls, and how well does it catch?

Sections 4.3 to 4.7, figures 4.7, 4.8, 4.11 to 4.16. One learner goes through all of it.
"""

from functools import partial

import numpy as np

from handeye.arrays import Array
from handeye.catching.learner import Learner, last_known
from handeye.catching.play import Recording, play
from handeye.catching.practice import train
from handeye.catching.world import World
from handeye.thesis.catching import (
    BALLS,
    HEAVY,
    LIGHT,
    School,
    ThrowSet,
    example,
    over,
    performance,
    pursue,
    summary,
    throws_for,
)
from handeye.thesis.experiment import Curve, Effort, Experiment, Quantities
from handeye.thesis.watching import TICKS, collisions, flights, noticed

NETWORKS = {
    "ball_recogniser": "ball_recognition",
    "arm_recogniser": "arm_recognition",
    **{
        f"{ours}.{identity}": f"{name}_{kind}"
        for name, identity in BALLS.items()
        for ours, kind in {
            "ball_states": "ball_state",
            "crossings": "crossing",
            "arm_states": "arm_state",
            "motors": "motor",
            "corrections": "correction",
        }.items()
    },
}
"""Names of the networks in records, by the learner's own."""


def school(setting: School, replicate: int, effort: Effort) -> Quantities:
    """All that is asked of a learner, in the order in which it learns.

    fresh_voltage, fresh_travel
                        largest command and movement before it has learned anything [V], [m]
    what `flights`, `collisions` and `pursue` measure
    mentored_<quantity> what `performance` measures after the mentor's throws of the heavy ball
    what `beliefs` measures, after as many throws of the light ball
    <network>_neurons   in the end
    """
    world, learner = World(), Learner(setting.settings)
    tests = throws_for(HEAVY, HEAVY, replicate, effort)
    measured = dict(before_learning(world, learner, tests))
    practise = partial(train, learner, world, replicate, tosses=0, pursuits=0, mentored=0)
    practise(tosses=effort.of(setting.tosses))
    measured |= flights(learner, replicate, effort)
    measured |= collisions(learner, replicate, effort)
    light, mentored = effort.of(setting.light), effort.of(setting.mentored)
    practise(pursuits=(light, 0))
    measured |= pursue(setting, learner, tests, replicate, effort, light=light)
    practise(mentored=mentored, mentored_arms=(HEAVY,), mentored_balls=(HEAVY,))
    known = performance(world, tests, learner.catcher(arm=HEAVY, ball=HEAVY))
    measured |= {f"mentored_{name}": value for name, value in known.items()}
    if replicate == 0:
        measured |= example("mentored", world, learner, tests)
    practise(mentored=2 * mentored, mentored_arms=(HEAVY,), mentored_balls=(LIGHT,))
    measured |= beliefs(world, learner, replicate, effort)
    neurons = {f"{NETWORKS[name]}_neurons": float(n) for name, n in learner.neurons.items()}
    return {**measured, **neurons}


def before_learning(world: World, learner: Learner, tests: ThrowSet) -> Quantities:
    """The first two quantities of `school`."""
    played = play(world, tests.throws, learner.catcher(arm=HEAVY, ball=HEAVY))
    moved = np.abs(played.final.arm_x - tests.throws.arm_x)
    return {
        "fresh_voltage": float(np.nanmax(np.abs(played.voltage))),
        "fresh_travel": float(moved.max()),
    }


def beliefs(world: World, learner: Learner, replicate: int, effort: Effort) -> Quantities:
    """Catching with wrong or missing beliefs at the start.

    <belief>_<ball>_<quantity>
                        what `performance` measures, with the heavy arm: belief is unknown, or other
                        where each ball is taken for the other one
    disbelief_<quantity>
                        means of caught and rms, and the same with _20, over these four
    wrong_arm_<quantity>
                        with heavy arm and ball, the arm taken for the light one
    <arm>_arm_recognised_20, <arm>_arm_recognised, arm_recognised_20
                        share of throws of the heavy ball in which an arm that is taken for the
                        other is recognised: whom the learner names last counts; the last is of
                        both arms
    <arm>_arm_named     share of the fresh ones in which it is named at some tick
    changed_arm_noticed share of heavy arms taken for the light one that surprise within each of
                        TICKS after the first command
    """
    measured: dict[str, float | Curve] = {}
    for name, ball in BALLS.items():
        tests = throws_for(ball, HEAVY, replicate, effort)
        for belief, taken_for in (("unknown", None), ("other", 1 - ball)):
            found = performance(world, tests, learner.catcher(arm=HEAVY, ball=taken_for))
            measured |= {f"{belief}_{name}_{key}": value for key, value in found.items()}
    conditions = [f"{belief}_{name}" for belief in ("unknown", "other") for name in BALLS]
    for quantity in ("caught_20", "rms_20", "caught", "rms"):
        of_all = [f"{one}_{quantity}" for one in conditions]
        measured[f"disbelief_{quantity}"] = over(measured, of_all)
    for name, arm in BALLS.items():
        tests = throws_for(HEAVY, arm, replicate, effort)
        played = play(world, tests.throws, learner.catcher(arm=1 - arm, ball=HEAVY))
        named = played.traces["arm"]
        right, once = last_known(named) == arm, np.any(named == arm, axis=0)
        measured[f"{name}_arm_recognised_20"] = float(right[: tests.sequence].mean())
        measured[f"{name}_arm_recognised"] = float(right[tests.sequence :].mean())
        measured[f"{name}_arm_named"] = float(once[tests.sequence :].mean())
        if arm == HEAVY:
            found = summary(played, tests.sequence)
            measured |= {f"wrong_arm_{key}": value for key, value in found.items()}
            measured["changed_arm_noticed"] = Curve(TICKS.astype(float), changed_arm(played))
    both = [f"{name}_arm_recognised_20" for name in BALLS]
    return {**measured, "arm_recognised_20": over(measured, both)}


def changed_arm(played: Recording) -> Array:
    """What `noticed` says of the throws in which the wrong arm is commanded for long enough."""
    time, moving = played.sensed.time, np.abs(np.nan_to_num(played.voltage)) > 0.0
    start = np.where(moving, time, np.inf).min(axis=0)
    enough = (time > start).sum(axis=0) >= TICKS[-1] // 2
    surprised = played.traces["arm_surprise"] >= 1.0
    return noticed(time[:, enough], start[enough], surprised[:, enough])


CATCHING = Experiment(id="catching", settings={"thesis": School()}, measure=school, replicates=10)
