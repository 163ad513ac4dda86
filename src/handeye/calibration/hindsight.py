"""Which parts of an arm changed during a log: with hindsight, from all of its rows at once.

An arm without error curves is fitted to all rows (`hindsight_fit`). The part and the row that would
gain most are tried in a fit of their own, whose likelihood decides; then the next is looked for.
What no single change explains may drift: a part that moves in several equal strides.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

from handeye.calibration.arm.log_system import Jump, LogSystem
from handeye.calibration.arm.robot import ArmRobot
from handeye.calibration.arm.sheet import ArmSheet, CurveTerms
from handeye.calibration.engine.chain import Chain, Group
from handeye.calibration.engine.events import Event
from handeye.calibration.hindsight_fit import SIDE, Change, Look
from handeye.calibration.placed_arm import PlacedArm
from handeye.observations import PointObservation

_MOST = 8
# Measured numbers for each unknown of a change, at least; rows that are looked at, at most.
_NUMBERS, _ROWS = 6, 1000
# Steps in which a drift is tried, and how many make one.
_STAIRS, _DRIFT = 5, 3


class Hindsight(NamedTuple):
    """Parts that were others before a row, in the order of time, and the same for a person."""

    jumps: tuple[Jump, ...]
    events: tuple[Event, ...]


def look_back(model: PlacedArm, seen: PointObservation) -> Hindsight:
    """What changed of an arm while N rows were observed, in the order of time."""
    every = -(-len(seen) // _ROWS)
    robot = ArmRobot(model, replace(ArmSheet(), curves=CurveTerms(0, 0)))
    chain, rows = robot.chain, robot.seen_rows(seen)[::every]

    def looked(changes: Sequence[Change]) -> Look:
        jumps = [Jump(at, group.places) for at, group in changes]
        return Look(LogSystem(robot.kernel, chain.tolerance, rows, jumps))

    found: list[Change] = []
    look = looked(found)

    def best_of(many: Sequence[list[Change]]) -> tuple[list[Change], Look] | None:
        best, gain = None, 0.0
        for new in many:
            tried = sorted([*found, *new], key=lambda change: change[0])
            if sum(len(group.places) for _, group in tried) * _NUMBERS > look.r.size:
                continue
            trial = looked(tried)
            gained = trial.gain(look, [tried.index(one) for one in new])
            if gained > gain:
                best, gain = (tried, trial), gained
        return best

    while len(found) < _MOST and len(rows) > 2 * SIDE:
        candidates = look.candidates(chain.changes)
        better = best_of([[one] for one in candidates])
        if better is None and not found:
            better = best_of([_stairs(group, len(rows)) for _, group in candidates])
        if better is None:
            break
        found, look = better
    events = _events(look, chain, found)
    return Hindsight(
        tuple(Jump(at * every, group.places) for at, group in found),
        tuple(replace(event, observation=event.observation * every) for event in events),
    )


def _stairs(group: Group, rows: int) -> list[Change]:
    """A part that moves on all the time, in steps."""
    return [(rows * step // (_STAIRS + 1), group) for step in range(1, _STAIRS + 1)]


def _events(look: Look, chain: Chain, found: Sequence[Change]) -> list[Event]:
    """For a person: what changes in steps again and again drifts."""
    steps: dict[Group, list[int]] = {}
    for number, (_, group) in enumerate(found):
        steps.setdefault(group, []).append(number)
    out: list[Event] = []
    for group, numbers in steps.items():
        if len(numbers) >= _DRIFT:
            told = look.event(chain, group, numbers)
            done = f"followed in {len(numbers)} steps, the latest here; its last place counts"
            out.append(replace(told, kind="drift", done=done))
        else:
            out += [look.event(chain, group, [number]) for number in numbers]
    return sorted(out, key=lambda event: event.observation)
