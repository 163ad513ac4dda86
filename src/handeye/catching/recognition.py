"""Which ball, which arm: a network with one output line for each identity (section 4.4.2)."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from handeye.arrays import Array, Integers
from handeye.catching.memory import ShortTermMemory
from handeye.catching.settings import Tuning
from handeye.catching.signals import Table, read
from handeye.catching.skills import Skill, samples

UNKNOWN = -1
"""The identity of what is not recognised."""


class Recogniser:
    """Learns to set an identity's line high; chooses the highest line if it is above a threshold.

    Args:
        table: inputs, one of the recognition nets of tables 4.1 and 4.2.
        tuning: scales and thresholds of the network; every line has its one output scale.
        threshold: activity that a line needs to be chosen.
        identities: how many there are.
    """

    def __init__(self, table: Table, tuning: Tuning, threshold: float, identities: int) -> None:
        self.skill = Skill(table, replace(tuning, output_scales=tuning.output_scales * identities))
        self.threshold = threshold

    def learn(self, identity: int, streams: Mapping[str, Array], delays: Mapping[str, int]) -> None:
        """Associate memory's traces of trials (T, N) with an identity."""
        inputs = samples(self.skill.table, streams, delays).inputs
        inputs = inputs[np.any(inputs, axis=1)]
        lines = np.zeros((len(inputs), self.skill.network.n_outputs))
        lines[:, identity] = 1.0
        self.skill.practise(inputs, lines)

    def choose(self, memory: ShortTermMemory, rows: Integers) -> Integers:
        """Identities of the trials `rows`; UNKNOWN where no line is high or memory is too short."""
        inputs = read(self.skill.table.inputs, memory)[rows]
        chosen = np.full(len(rows), UNKNOWN)
        reached = np.flatnonzero(~np.isnan(inputs).any(axis=1) & np.any(inputs, axis=1))
        if reached.size:
            lines = self.skill.answer(inputs[reached])
            high = lines.max(axis=1) > self.threshold
            chosen[reached] = np.where(high, lines.argmax(axis=1), UNKNOWN)
        return chosen
