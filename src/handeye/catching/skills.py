"""A skill: a network and the rows of tables 4.1 and 4.2 that say what it is about."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from handeye.arrays import Array, Integers, shaped
from handeye.catching.memory import ShortTermMemory
from handeye.catching.settings import Tuning
from handeye.catching.signals import Table, read
from handeye.errors import InvalidInput
from handeye.networks import InputSpace, ResourceAllocatingNetwork
from handeye.randomness import stream


class Samples(NamedTuple):
    """Inputs (S, d) and outputs (S, m) for a network, trial after trial in the order of time."""

    inputs: Array
    outputs: Array


class Skill:
    """Learns the outputs of a table from its inputs; both scaled as the tuning says.

    With `tuning.replays` it keeps all its samples, and after each practice it learns them anew
    from nothing, several times over in random order: what it knows then depends on the samples
    alone, not on how they were portioned. Without, it learns each sample once, as it comes.

    Args:
        table: its inputs and outputs.
        tuning: scales, thresholds and width of the network.
    """

    def __init__(self, table: Table, tuning: Tuning) -> None:
        self.table = table
        self.tuning = tuning
        self.network = self._fresh()
        self.experience = Samples(
            np.empty((0, len(tuning.input_scales))), np.empty((0, len(tuning.output_scales)))
        )
        """What is replayed; empty without replays."""
        self._scales = np.asarray(tuning.output_scales)

    def answer(self, inputs: Array) -> Array:
        """Outputs (S, m) at inputs (S, d), both in their own units; zero before any learning."""
        return self.network.predict_many(inputs) * self._scales

    def novelty(self, inputs: Array) -> Array:
        """Distance (S,) of inputs (S, d) to the nearest experience, in scales; inf if none."""
        return self.network.nearest_many(inputs)

    def practise(self, inputs: Array, outputs: Array) -> None:
        """Learn samples (S, d), (S, m) in order, or all that were ever seen if it replays."""
        if self.tuning.replays == 0:
            self.network.learn_many(inputs, outputs / self._scales)
            return
        seen = (
            np.concatenate(part) for part in zip(self.experience, (inputs, outputs), strict=True)
        )
        self.experience = Samples(*seen)
        self.network = self._fresh()
        order = stream("replay")
        for _ in range(self.tuning.replays):
            chosen = order.permutation(len(self.experience.inputs))
            x, y = (part[chosen] for part in self.experience)
            self.network.learn_many(x, y / self._scales)

    def take_over(self, network: ResourceAllocatingNetwork, experience: Samples) -> None:
        """Go on with what another skill of the same kind has learned.

        Raises InvalidInput if it does not fit the table; nothing has changed then.
        """
        d, m = len(self.tuning.input_scales), len(self.tuning.output_scales)
        if (network.n_inputs, network.n_outputs) != (d, m):
            raise InvalidInput(f"the network must have {d} inputs and {m} outputs")
        number = len(experience.inputs)
        inputs = shaped(experience.inputs, (number, d), "inputs")
        outputs = shaped(experience.outputs, (number, m), "outputs")
        self.network, self.experience = network, Samples(inputs, outputs)

    def _fresh(self) -> ResourceAllocatingNetwork:
        tuning = self.tuning
        return ResourceAllocatingNetwork(
            len(tuning.input_scales),
            len(tuning.output_scales),
            inputs=InputSpace.scaled(tuning.input_scales),
            half_max_fraction=tuning.half_max_fraction,
            error_threshold=tuning.threshold,
            learning_threshold=tuning.threshold,
        )


def ask(skills: Sequence[Skill], which: Integers, memory: ShortTermMemory) -> Array:
    """Each trial asks the skill of its own identity: outputs (N, m).

    NaN where the identity `which` (N,) is unknown (-1) or the memory does not reach back enough.
    """
    return answers(skills, which, read(skills[0].table.inputs, memory))


def answers(skills: Sequence[Skill], which: Integers, inputs: Array) -> Array:
    """The same at given inputs (N, d); NaN where one of them is NaN."""
    out = np.full((len(inputs), len(skills[0].table.outputs)), np.nan)
    reached = ~np.isnan(inputs).any(axis=1)
    for identity, skill in enumerate(skills):
        rows = np.flatnonzero(reached & (which == identity))
        if rows.size:
            out[rows] = skill.answer(inputs[rows])
    return out


def novelties(skills: Sequence[Skill], which: Integers, inputs: Array) -> Array:
    """How far inputs (N, d) are from the experience of each trial's own skill, (N,) in scales.

    Infinite where the identity `which` (N,) is unknown or an input is NaN.
    """
    out = np.full(len(inputs), np.inf)
    for identity, skill in enumerate(skills):
        rows = np.flatnonzero((which == identity) & ~np.isnan(inputs).any(axis=1))
        if rows.size:
            out[rows] = skill.novelty(inputs[rows])
    return out


def samples(table: Table, streams: Mapping[str, Array], delays: Mapping[str, int]) -> Samples:
    """What the memory's traces of N trials teach a network.

    The trials are played once more through a short-term memory, and each tick at which every
    signal of the table is known gives a sample.

    Args:
        table: inputs and outputs.
        streams: name -> (T, N), NaN once a trial is over; what is constant over a trial is (N,);
            others than those of the table are not looked at.
        delays: ticks by which streams lag.
    """
    traces = {name: streams[name] for name in sorted(table.streams)}
    lags = {name: ticks for name, ticks in delays.items() if name in traces}
    ticks, n = next(trace.shape for trace in traces.values() if trace.ndim == 2)
    memory = ShortTermMemory(traces, 1 + table.ahead + table.reach, n, lags)
    inputs: list[Array] = []
    outputs: list[Array] = []
    for tick in range(ticks + max(lags.values(), default=0)):
        memory.tick()
        for name, values in traces.items():
            if values.ndim == 1:
                memory.record(name, values)
            elif tick < ticks:
                memory.record(name, values[tick])
        inputs.append(read(table.inputs, memory, table.ahead))
        outputs.append(read(table.outputs, memory, table.ahead))
    x, y = (
        np.stack(part, axis=1).reshape(n * len(part), part[0].shape[1])
        for part in (inputs, outputs)
    )
    known = np.isfinite(np.hstack([x, y])).all(axis=1)
    return Samples(x[known], y[known])
