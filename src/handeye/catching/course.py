"""A course of practice that can be left at any point and gone on with later."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, replace
from time import process_time
from typing import Literal, NamedTuple

import numpy as np

from handeye.arrays import Integers, count
from handeye.catching.learner import Learner
from handeye.catching.play import Recording
from handeye.catching.practice import test, train
from handeye.catching.results import Mark, Take, scores_of
from handeye.catching.throws import Throws, draw_throws
from handeye.catching.world import World
from handeye.errors import InvalidInput
from handeye.randomness import stream

Beginning = Literal["known", "unknown", "wrong"]
"""What a learner believes of ball and arm when a throw begins."""

MARKS = (0, 10, 30, 100, 300, 1000, 3000)
"""Pursuits with each arm after which catching is tested."""

_PORTION = 100
_MENTORED_PORTION = 10
_SHOWN = 8
_AFTERWARDS, _A_LITTLE = 0.35, 0.1


@dataclass(frozen=True)
class Plan:
    """How much is practised, with what.

    pursuits     with each arm
    tosses       of each ball
    mentored     throws with the mentor, over all arms and balls; none for a learner whose settings
                 take no advice
    arms, balls  identities
    mark_throws  of each ball to each arm at every test during training
    replicate    another number, other movements, tosses and throws
    """

    pursuits: int = 300
    tosses: int = 100
    mentored: int = 50
    arms: tuple[int, ...] = (0, 1)
    balls: tuple[int, ...] = (0, 1)
    mark_throws: int = 50
    replicate: int = 0

    def __post_init__(self) -> None:
        for name in ("pursuits", "tosses", "mentored", "replicate"):
            count(getattr(self, name), name, least=0)
        count(self.mark_throws, "mark_throws")
        for name in ("arms", "balls"):
            chosen = getattr(self, name)
            if not chosen or len(set(chosen)) != len(chosen):
                raise InvalidInput(f"{name} must be one or more identities, got {chosen}")


class Practice(NamedTuple):
    """A portion of practice, up to so many trials in all; `identity` of a ball or an arm."""

    kind: Literal["tosses", "pursuits", "mentored"]
    identity: int
    upto: int


class Exam(NamedTuple):
    """A test of catching after so much practice."""

    pursuits: int
    mentored: int


Step = Practice | Exam


class Course:
    """A learner on its way through a plan.

    Each step depends only on what was done before it, so a course that is saved after any step and
    loaded later ends with the same learner, the same marks and the same takes;
    `handeye.catching.course_file` saves and loads it.

    Args:
        learner: a new one, or one that was on its way with the same replicate.
        world: where.
        plan: where to.
    """

    def __init__(self, learner: Learner, world: World, plan: Plan) -> None:
        self.learner = learner
        self.world = world
        self.plan = plan
        self.marks: list[Mark] = []
        """Tests so far, with the identities known."""
        self.takes: list[Take] = []
        """A few throws at every mark, to look at."""
        self.cpu_seconds = 0.0
        """Processor time of all practice so far, tests left out."""

    @property
    def trials_left(self) -> int:
        """Tosses, pursuits and mentored throws that the plan still asks for."""
        plan, learner = self._asked, self.learner
        lacking = [plan.tosses - learner.tosses[ball] for ball in plan.balls]
        lacking += [plan.pursuits - learner.pursuits[arm] for arm in plan.arms]
        return sum(max(number, 0) for number in (*lacking, plan.mentored - learner.mentored))

    @property
    def has_begun(self) -> bool:
        """Whether the learner has learned anything."""
        learner = self.learner
        return any((*learner.tosses, *learner.pursuits, learner.mentored))

    def run(self, before_each: Callable[[Step], bool] = lambda step: True) -> bool:  # noqa: ARG005
        """Do what remains. `before_each` is called before every step; where it says False, stop.

        Returns whether the course went to its end.
        """
        for step in steps(self._asked):
            if not self._due(step):
                continue
            if not before_each(step):
                return False
            if isinstance(step, Exam):
                self._mark()
            else:
                started = process_time()
                self._practise(step)
                self.cpu_seconds += process_time() - started
        return True

    def test(self, n: int, beginning: Beginning) -> Recording:
        """n fresh throws of every ball to every arm of the plan; nothing is learned."""
        return self._played("test throws", n, beginning, _A_LITTLE)

    def surprise(self) -> Recording:
        """A few throws at which it believes in the wrong ball and the wrong arm."""
        return self._played("throws with wrong beliefs", _SHOWN, "wrong", _AFTERWARDS)

    @property
    def _asked(self) -> Plan:
        """The plan, without a mentor for a learner that takes no advice."""
        heeded = self.learner.settings.takes_advice
        return self.plan if heeded else replace(self.plan, mentored=0)

    def _played(self, name: str, n: int, beginning: Beginning, after: float = 0.0) -> Recording:
        throws = self._draw(name, n)
        arm, ball = (_believed(beginning, which) for which in (throws.arm, throws.ball))
        return test(self.learner, self.world, throws, arm=arm, ball=ball, after=after)

    def _draw(self, name: str, n: int) -> Throws:
        """n throws of every ball to every arm, the pairs taking turns."""
        pairs = [(ball, arm) for ball in self.plan.balls for arm in self.plan.arms]
        parts = [
            draw_throws(
                n,
                stream(f"catching: {name} of ball {ball} to arm {arm}", self.plan.replicate),
                layout=self.world.layout,
                balls=(ball,),
                arms=(arm,),
            )
            for ball, arm in pairs
        ]
        turns = np.arange(n * len(pairs)).reshape(len(pairs), n).T.ravel()
        return Throws(
            **{f.name: np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(Throws)}
        )[turns]

    def _mark(self) -> None:
        mark = self._now()
        tested = self._played("throws at marks", self.plan.mark_throws, "known")
        self.marks.append(Mark(*mark, scores_of(tested)))
        each = max(_SHOWN // (len(self.plan.balls) * len(self.plan.arms)), 1)
        shown = self._played("throws to show", each, "known", _AFTERWARDS)
        self.takes.append(Take(_title(*mark), shown))

    def _practise(self, step: Practice) -> None:
        learner, plan = self.learner, self.plan
        upto = {"tosses": list(learner.tosses), "pursuits": list(learner.pursuits)}
        if step.kind != "mentored":
            upto[step.kind][step.identity] = step.upto
        train(
            learner,
            self.world,
            plan.replicate,
            tosses=upto["tosses"],
            pursuits=upto["pursuits"],
            mentored=step.upto if step.kind == "mentored" else learner.mentored,
            mentored_arms=plan.arms,
            mentored_balls=plan.balls,
        )

    def _now(self) -> Exam:
        return Exam(
            min(self.learner.pursuits[arm] for arm in self.plan.arms), self.learner.mentored
        )

    def _due(self, step: Step) -> bool:
        """A test is due only at its own moment, which may have gone by in an earlier plan."""
        learner = self.learner
        if isinstance(step, Exam):
            made = {(mark.pursuits, mark.mentored) for mark in self.marks}
            return step == self._now() and step not in made
        if step.kind == "mentored":
            return learner.mentored < step.upto
        return getattr(learner, step.kind)[step.identity] < step.upto


def steps(plan: Plan) -> Iterator[Step]:
    """All of a plan, in order: balls are watched, arms are moved, the mentor helps.

    Portions end at round numbers and at marks, whatever the plan's totals.
    """
    for ball in plan.balls:
        yield from (Practice("tosses", ball, n) for n in _portions(plan.tosses, _PORTION))
    yield Exam(0, 0)
    marks = [mark for mark in MARKS if mark < plan.pursuits]
    for upto in sorted({*_portions(plan.pursuits, _PORTION), *marks} - {0}):
        yield from (Practice("pursuits", arm, upto) for arm in plan.arms)
        if upto in MARKS or upto == plan.pursuits:
            yield Exam(upto, 0)
    for upto in _portions(plan.mentored, _MENTORED_PORTION):
        yield Practice("mentored", -1, upto)
    yield Exam(plan.pursuits, plan.mentored)


def _portions(total: int, size: int) -> list[int]:
    return [*range(size, total, size), total] if total else []


def _title(pursuits: int, mentored: int) -> str:
    practised = f"{pursuits:,} pursuits" if pursuits else "no pursuit"
    return f"{practised} + mentor" if mentored else practised


def _believed(beginning: Beginning, identities: Integers) -> Integers | None:
    """What is believed of throws with these identities, 0 or 1."""
    if beginning == "unknown":
        return None
    return identities if beginning == "known" else 1 - identities
