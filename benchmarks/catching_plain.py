"""Contestants of benchmarks/catching.py without rewards: handeye's learner, and PID controllers."""

import time
from collections.abc import Callable

import numpy as np

from handeye.catching.learner import Learner
from handeye.catching.pid import PIDController, Reference
from handeye.catching.play import Controller, play
from handeye.catching.practice import test, train
from handeye.catching.settings import IMPROVED, CatcherSettings
from handeye.catching.throws import Throws, draw_throws
from handeye.catching.world import World
from handeye.randomness import stream

STAGES = (
    *((n, n, 0) for n in (10, 20, 30, 40, 50, 70, 100)),
    (200, 100, 0),
    (300, 100, 0),
    (300, 100, 50),
)
"""Pursuits with each arm, tosses of each ball, and mentored throws, all in all at each test."""

LAMBDAS = (0.03, 0.04, 0.06, 0.08, 0.1, 0.13, 0.17, 0.22, 0.3, 0.6)
"""What is tried for a PID controller [s]."""


def practise(
    settings: CatcherSettings,
    seed: int,
    throws: Throws,
    told: Callable[[int, int, int, np.ndarray, float], None],
) -> None:
    """Train a learner stage by stage; tested with identities unknown at the start.

    `told` is called with pursuits, tosses and mentored throws in all, which test throws were
    caught, and the CPU seconds of training.
    """
    world, learner, spent = World(), Learner(settings), 0.0
    for pursuits, tosses, mentored in STAGES:
        begun = time.process_time()
        train(learner, world, seed, pursuits=pursuits, tosses=tosses, mentored=mentored)
        spent += time.process_time() - begun
        caught = test(learner, world, throws).caught
        told(2 * pursuits, 2 * tosses, mentored, caught, spent)


def warm_up(settings: CatcherSettings) -> None:
    """Have everything compiled before the clock runs."""
    world, learner = World(), Learner(settings)
    train(learner, world, 0, pursuits=2, tosses=2, mentored=1)
    test(learner, world, draw_throws(2, np.random.default_rng(0)))


def pid_shares(seed: int, throws: Throws) -> dict[str, float]:
    """Shares that PID controllers catch in the world, by what they follow.

    They are told the masses. Which ball it is, and where it will come down, they are told or they
    ask a learner that has watched 100 tosses of each. For each arm and ball they use the lambda
    that catches most of some 200 other throws, when told.
    """
    world, learner = World(), Learner(IMPROVED)
    train(learner, world, seed, pursuits=0, tosses=100, mentored=0)
    tuning = draw_throws(800, stream("benchmark catching: tuning", seed))
    references: dict[str, Reference] = {"the ball": "ball", "the crossing": "crossing"}
    shares: dict[str, float] = {}
    for name, reference in references.items():
        told, asked = np.zeros(len(throws), np.bool_), np.zeros(len(throws), np.bool_)
        for arm in range(len(world.arms)):
            mine = throws.arm == arm
            best = _tuned(world, tuning[tuning.arm == arm], reference)
            told[mine] = _caught(world, throws[mine], reference, best)
            asked[mine] = _caught(world, throws[mine], reference, best, learner.catcher())
        shares |= {f"{name}, told": told.mean(), f"{name}, asking a learner": asked.mean()}
    return {name: float(share) for name, share in shares.items()}


def _tuned(world: World, throws: Throws, reference: Reference) -> tuple[float, ...]:
    """The best lambda for each ball."""
    hits = np.array([_caught(world, throws, reference, (slow, slow)) for slow in LAMBDAS])
    return tuple(
        LAMBDAS[int(hits[:, throws.ball == ball].mean(axis=1).argmax())] for ball in (0, 1)
    )


def _caught(
    world: World,
    throws: Throws,
    reference: Reference,
    lambdas: tuple[float, ...],
    observer: Controller | None = None,
) -> np.ndarray:
    """Of throws of one arm."""
    controller = PIDController(
        world.arms[int(throws.arm[0])],
        lambdas,
        reference=reference,
        throws=throws if observer is None else None,
        observer=observer,
    )
    return play(world, throws, controller).caught
