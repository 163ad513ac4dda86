"""N throws at once against one controller, and what came of it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol, Self

import numpy as np

from handeye.arrays import Array, Booleans, Integers, scalar
from handeye.catching.state import CAUGHT, State
from handeye.catching.throws import Throws
from handeye.catching.world import Sensed, World
from handeye.errors import InvalidInput


class Controller(Protocol):
    """What moves the arms of N trials, one tick after another."""

    def begin(self, n: int) -> None:
        """Forget the past: n trials start."""
        ...

    def act(self, sensed: Sensed) -> Array:
        """Command voltages V_c (N,), held until the next tick; of trials that are over, any."""
        ...

    def traces(self) -> dict[str, Array]:
        """What it thought at the last act, each (N,); the same names at every tick."""
        ...


@dataclass(frozen=True, eq=False)
class Recording:
    """N trials over T ticks; `recording[i]` with a slice, mask or index array picks trials.

    sensed          fields (T, N); NaN where a trial had stopped
    voltage         V_c issued at each tick (T, N), NaN likewise [V]
    final           sensed at the exact end of each trial, each (N,)
    caught          (N,)
    outcome         (N,): CAUGHT, MISSED or KNOCKED_OUT of `handeye.catching.state`
    position_error  arm minus crossing_x at the undisturbed crossing time (N,) [m]
    contact_time    first contact with the cup (N,), inf if there was none [s]
    traces          of the controller, each (T, N)
    """

    throws: Throws
    sensed: Sensed
    voltage: Array
    final: Sensed
    caught: Booleans
    outcome: Integers
    position_error: Array
    contact_time: Array
    traces: dict[str, Array]

    def __len__(self) -> int:
        return len(self.throws)

    def __getitem__(self, index: Any) -> Self:
        return type(self)(
            throws=self.throws[index],
            sensed=_each(lambda field: field[:, index], self.sensed),
            voltage=self.voltage[:, index],
            final=_each(lambda field: field[index], self.final),
            caught=self.caught[index],
            outcome=self.outcome[index],
            position_error=self.position_error[index],
            contact_time=self.contact_time[index],
            traces={name: trace[:, index] for name, trace in self.traces.items()},
        )


def play(world: World, throws: Throws, controller: Controller, *, after: float = 0.0) -> Recording:
    """Throw, sense and act at every tick until every trial is over, and `after` seconds more.

    At a tick the controller sees what is sensed then, and its command is held until the next tick.
    When a trial is over its motor gets no voltage.

    Raises InvalidInput if a controller commands what is not a finite number, or not (N,).
    """
    scalar(after, "after", least=0.0)
    state = world.start(throws)
    controller.begin(len(throws))
    seen: list[Sensed] = []
    commands: list[Array] = []
    thoughts: list[dict[str, Array]] = []
    while True:
        running = state.time < state.end_time + after
        if not running.any():
            break
        sensed = world.sense(state)
        command = np.asarray(controller.act(sensed), np.float64)
        if command.shape != running.shape or not np.isfinite(command[sensed.active]).all():
            raise InvalidInput(
                f"{type(controller).__name__} must command one finite voltage for each of "
                f"{len(throws)} trials"
            )
        command = np.where(sensed.active, command, 0.0)
        numbers = [np.where(running, field, np.nan) for field in sensed[:-1]]
        seen.append(Sensed._make([*numbers, sensed.active]))
        commands.append(np.where(running, command, np.nan))
        thoughts.append({name: trace.copy() for name, trace in controller.traces().items()})
        state = world.step(state, command, after=after)
    return _recording(world, throws, state, seen, commands, thoughts)


def _each(change: Callable[[Any], Any], sensed: Sensed) -> Sensed:
    return Sensed(*(change(field) for field in sensed))


def _recording(
    world: World,
    throws: Throws,
    state: State,
    seen: list[Sensed],
    commands: list[Array],
    thoughts: list[dict[str, Array]],
) -> Recording:
    shape = (len(seen), len(throws))
    stacked: list[Any] = [
        np.array([getattr(each, name) for each in seen]).reshape(shape) for name in Sensed._fields
    ]
    return Recording(
        throws=throws,
        sensed=Sensed(*stacked),
        voltage=np.array(commands).reshape(shape),
        final=world.final(state),
        caught=state.outcome == CAUGHT,
        outcome=state.outcome,
        position_error=state.arm_at_crossing - throws.crossing_x,
        contact_time=state.contact_time,
        traces={name: np.array([each[name] for each in thoughts]) for name in thoughts[0]}
        if thoughts
        else {},
    )
