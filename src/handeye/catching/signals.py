"""Tables 4.1 and 4.2: what each network hears and says, as data.

A signal is written as in the tables: `a_x(0) - a_x(-6)` is a_x(t) - a_x(t - 6 Dt), t the present
tick. What is known only at a trial's end (crossing, stop) is a stream too: after a trial it holds
what was observed, during one what is predicted, so that one table serves training and execution.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from handeye.arrays import Array
from handeye.catching.memory import ShortTermMemory


class Signal(NamedTuple):
    """A stream at one tick, from which another may be subtracted; ticks count from t."""

    stream: str
    ticks: int = 0
    less: tuple[str, int] | None = None

    def __sub__(self, other: "Signal") -> "Signal":
        return Signal(self.stream, self.ticks, (other.stream, other.ticks))

    def read(self, memory: ShortTermMemory, now: int = 0) -> Array:
        """Its values (N,) when t is the tick `now` ticks ago; NaN where memory does not reach."""
        value = memory.at(self.stream, now - self.ticks)
        if self.less is None:
            return value
        stream, ticks = self.less
        return value - memory.at(stream, now - ticks)


@dataclass(frozen=True)
class Stream:
    """A named stream of the memory; `b_x(-2)` is its signal two ticks before t."""

    name: str

    def __call__(self, ticks: int = 0) -> Signal:
        """Its signal so many ticks after t."""
        return Signal(self.name, ticks)


t = Stream("time")
u = Stream("command")
"""Voltage issued at t and held until t + Dt."""
V = Stream("voltage")
"""The same as memory holds it beside the senses: as late as they are, if they are late."""
a_x, a_v, f = Stream("arm_x"), Stream("arm_v"), Stream("arm_force")
b_x, b_z = Stream("ball_x"), Stream("ball_z")
b_vx, b_vz = Stream("ball_vx"), Stream("ball_vz")
b_xc, t_c, b_vc = Stream("crossing_x"), Stream("crossing_time"), Stream("crossing_vx")
a_xs, t_s = Stream("stop_x"), Stream("stop_time")
p_x, p_u = Stream("profile_x"), Stream("profile_amplitude")
"""Target and amplitude of the profile that begins at t."""
dx, dt = Stream("correction_x"), Stream("correction_time")

SENSES = tuple(s.name for s in (t, a_x, a_v, f, b_x, b_z, b_vx, b_vz))
"""What eye and arm report."""
GOALS = tuple(s.name for s in (b_xc, t_c, b_vc, a_xs, t_s, dx, dt))
"""What is known only when a trial is over, and predicted before."""


class Table(NamedTuple):
    """Inputs and outputs of one network."""

    inputs: tuple[Signal, ...]
    outputs: tuple[Signal, ...]

    @property
    def ahead(self) -> int:
        """Ticks after t until the outputs have been observed."""
        return max((s.ticks for s in self.outputs), default=0)

    @property
    def reach(self) -> int:
        """Ticks before t that it looks back."""
        signals = (*self.inputs, *self.outputs)
        lagging = [s.less[1] for s in signals if s.less is not None]
        return -min([s.ticks for s in signals] + lagging + [0])

    @property
    def streams(self) -> set[str]:
        """Names of all streams it speaks of."""
        signals = (*self.inputs, *self.outputs)
        return {s.stream for s in signals} | {s.less[0] for s in signals if s.less is not None}


# Table 4.1. The recognition nets' outputs are one line per identity (recognition.py).
ARM_RECOGNITION = Table(
    (V(-1), V(-6), a_v(0), a_v(-5), a_x(0) - a_x(-1), a_x(0) - a_x(-6), f(0), f(-6)), ()
)
ARM_STATE = Table((V(0), a_v(0)), (a_x(1) - a_x(0), a_v(1), f(1)))
# The table calls the output V(t + Dt), the command for the next time step: here u(0), since a
# command is filed under the tick that issues it, as the state net's V(t) has it too.
MOTOR_COMMAND = Table((a_v(0), a_xs(0) - a_x(0), t_s(0) - t(0)), (u(0),))
# Not in the thesis, but its recommendation (conclusion 3 of 5.1.2): what begins a whole pursuit.
PROFILE = Table((a_xs(0) - a_x(0), t_s(0) - t(0)), (p_x(0) - a_x(0), p_u(0)))
CATCH_CORRECTION = Table((a_v(0), b_xc(0) - a_x(0), t_c(0) - t(0)), (dx(0), dt(0)))

# Table 4.2.
BALL_RECOGNITION = Table(
    (b_vx(0), b_vz(0), b_x(0) - b_x(-1), b_z(0) - b_z(-1), b_x(0) - b_x(-3), b_z(0) - b_z(-3),
     b_x(0) - b_x(-5), b_z(0) - b_z(-5)), ()
)  # fmt: skip
BALL_STATE = Table(
    (b_vx(0), b_vz(0), b_x(0) - b_x(-2), b_z(0) - b_z(-2)),
    (b_x(1) - b_x(0), b_z(1) - b_z(0), b_vx(1), b_vz(1)),
)
BALL_CROSSING = Table(
    (b_vx(0), b_vz(0), b_x(0) - b_x(-2), b_z(0) - b_z(-2), b_z(0)),
    (b_vc(0), t_c(0) - t(0), b_xc(0) - b_x(0)),
)


def read(signals: tuple[Signal, ...], memory: ShortTermMemory, now: int = 0) -> Array:
    """Their values (N, d) when t is the tick `now` ticks ago; NaN where memory does not reach."""
    values = np.empty((memory.n, len(signals)))
    for column, signal in enumerate(signals):
        values[:, column] = signal.read(memory, now)
    return values
