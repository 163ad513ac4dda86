"""Practice: the four modes as functions over a world, and a schedule of them (section 4.4.2).

Stable for callers: `practise_arm`, `watch_tosses`, `coach`, `test` and `train`.
"""

from collections.abc import Callable, Sequence
from dataclasses import fields, replace
from typing import TypeVar

import numpy as np

from handeye.arrays import Array, Integers, count
from handeye.catching.learner import Learner
from handeye.catching.movements import Pulses, draw_pursuits, execute
from handeye.catching.play import Recording, play
from handeye.catching.throws import Throws, draw_throws
from handeye.catching.world import Sensed, World
from handeye.errors import InvalidInput
from handeye.randomness import stream

Drawn = TypeVar("Drawn", Throws, Pulses)
Progress = Callable[[str, int, int], None]
"""Called with what is practised, how much of it is done, and how much there is to do."""

_BLOCK = 10


def ignore(what: str, done: int, total: int) -> None:
    """Shows nothing."""


def practise_arm(
    learner: Learner, world: World, arm: int, n: int, rng: np.random.Generator
) -> None:
    """Arm learning mode: make n random pursuits with an arm and learn from them."""
    pulses = _pursuits(learner, world, arm, n, rng)
    learner.learn_arm(arm, execute(world.arms[arm], pulses, layout=world.layout))


def watch_tosses(
    learner: Learner, world: World, ball: int, n: int, rng: np.random.Generator
) -> None:
    """Ball learning mode: watch n tosses of a ball, the arm out of the way, and learn from them."""
    throws = draw_throws(n, rng, layout=world.layout, balls=(ball,))
    learner.learn_ball(ball, _watched(world, throws))


def coach(learner: Learner, world: World, throws: Throws, progress: Progress = ignore) -> None:
    """Catch training mode: throws one at a time, each followed by the mentor's advice.

    The learner is told which ball and which arm it has, as in the other learning modes.
    """
    for i in range(len(throws)):
        one = throws[i : i + 1]
        learner.learn_catch(play(world, one, learner.catcher(one.arm, one.ball)))
        progress("mentored throws", i + 1, len(throws))


def test(
    learner: Learner,
    world: World,
    throws: Throws,
    *,
    arm: int | Integers | None = None,  # noqa: PT028 (not a test of pytest)
    ball: int | Integers | None = None,  # noqa: PT028
    repeated: bool | None = None,  # noqa: PT028
    after: float = 0.0,  # noqa: PT028
) -> Recording:
    """Catching mode: play throws, all at once, without learning.

    Args:
        learner: who.
        world: where.
        throws: what.
        arm: identities believed at the start, for all or (N,); None: unknown.
        ball: the same of balls.
        repeated: pursuits may follow each other; None: as the learner's settings say.
        after: seconds to go on after the end of each throw, for pictures.
    """
    return play(world, throws, learner.catcher(arm, ball, repeated=repeated), after=after)


def train(
    learner: Learner,
    world: World,
    replicate: int,
    *,
    pursuits: int | Sequence[int] = 300,
    tosses: int | Sequence[int] = 100,
    mentored: int = 50,
    mentored_arms: Sequence[int] = (0, 1),
    mentored_balls: Sequence[int] = (0, 1),
    progress: Progress = ignore,
) -> None:
    """Bring a learner up to so much practice in all, from where it is.

    What is practised comes from streams named after it and the replicate, so a learner that was
    saved halfway and loaded learns the same as one that was not, and learners that are compared
    meet the same movements, tosses and throws.

    Args:
        learner: a new one, or one that `train` has trained before with the same replicate.
        world: where.
        replicate: number of the repetition.
        pursuits: with each arm.
        tosses: of each ball.
        mentored: throws with the mentor.
        mentored_arms: arms in those throws.
        mentored_balls: balls in them.
        progress: called after each portion.
    """
    layout = world.layout
    for ball, total in enumerate(_each(tosses, learner.n_balls, "tosses")):
        throws = _portion(
            lambda rng, ball=ball: draw_throws(_BLOCK, rng, layout=layout, balls=(ball,)),
            f"tosses of ball {ball}", replicate, learner.tosses[ball], total,
        )  # fmt: skip
        if throws is not None:
            learner.learn_ball(ball, _watched(world, throws))
            progress(f"tosses of ball {ball}", total, total)
    for arm, total in enumerate(_each(pursuits, learner.n_arms, "pursuits")):
        pulses = _portion(
            lambda rng, arm=arm: _pursuits(learner, world, arm, _BLOCK, rng),
            f"pursuits of arm {arm}", replicate, learner.pursuits[arm], total,
        )  # fmt: skip
        if pulses is not None:
            learner.learn_arm(arm, execute(world.arms[arm], pulses, layout=layout))
            progress(f"pursuits of arm {arm}", total, total)
    throws = _portion(
        lambda rng: draw_throws(
            _BLOCK, rng, layout=layout, arms=mentored_arms, balls=mentored_balls
        ),
        "mentored throws", replicate, learner.mentored, count(mentored, "mentored", least=0),
    )  # fmt: skip
    if throws is not None:
        coach(learner, world, throws, progress)


def _pursuits(learner: Learner, world: World, arm: int, n: int, rng: np.random.Generator) -> Pulses:
    """Movements that the learner makes up to exercise an arm."""
    least = learner.settings.least_amplitude
    pulses = draw_pursuits(n, rng, world.arms[arm], layout=world.layout, epsilon=least)
    if not learner.settings.gentle:
        return pulses
    return replace(pulses, amplitude=least ** ((1.0 - pulses.amplitude) / (1.0 - least)))


class _Still:
    """Leaves the arm alone."""

    def begin(self, n: int) -> None:
        self._nothing = np.zeros(n)

    def act(self, sensed: Sensed) -> Array:  # noqa: ARG002
        return self._nothing

    def traces(self) -> dict[str, Array]:
        return {}


def _watched(world: World, throws: Throws) -> Recording:
    """Throws that nobody touches."""
    apart = World(
        world.layout, arms=world.arms, balls=world.balls, retina=world.retina, collisions=False
    )
    return play(apart, throws, _Still())


def _each(number: int | Sequence[int], identities: int, name: str) -> list[int]:
    """One number for every identity."""
    numbers = [number] * identities if isinstance(number, int) else list(number)
    if len(numbers) != identities:
        raise InvalidInput(f"{name} must be one number or {identities}, got {number}")
    return [count(each, name, least=0) for each in numbers]


def _portion(
    draw: Callable[[np.random.Generator], Drawn],
    name: str,
    replicate: int,
    done: int,
    total: int,
) -> Drawn | None:
    """Items `done` to `total` of an endless series, or None if there are none to come.

    Every ten items have a stream of their own, so an item does not depend on how many are asked
    for at once.
    """
    if total <= done:
        return None
    parts = [
        draw(stream(f"catching: {name}, block {block}", replicate))
        for block in range(done // _BLOCK, -(-total // _BLOCK))
    ]
    first = done // _BLOCK * _BLOCK
    joined = replace(
        parts[0],
        **{f.name: np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(parts[0])},
    )
    return joined[done - first : total - first]
