"""Experiments: what is varied, how often, and what is measured. Records are all that is kept."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Generic, NamedTuple, TypeVar

from handeye.arrays import Array, count
from handeye.thesis.real_data import real_data

S = TypeVar("S")


class Curve(NamedTuple):
    """A quantity as it was after so many trials: at (M,), value (M,)."""

    at: Array
    value: Array


Quantities = Mapping[str, float | Curve]


@dataclass(frozen=True)
class Effort:
    """How much of an experiment's trials and tests to run: 1 is all of them, less a trial run."""

    fraction: float = 1.0

    def of(self, n: int, least: int = 2) -> int:
        """The part of n trials, tests or samples to run."""
        return max(count(least, "least"), round(self.fraction * n))


FULL = Effort()


@dataclass(frozen=True)
class Experiment(Generic[S]):
    """One question put to a simulated robot, or to measurements, under named settings.

    id             names it in records and claims
    settings       what is compared, by name
    measure        measure(setting, replicate, effort) gives named quantities. A pure function: what
                   is random comes from streams of the replicate, so that all settings meet the
                   same world. It must be a module's function to run in other processes.
    replicates     repetitions by default
    deterministic  nothing is random: one replicate is all there is
    needs          the folder of real measurements (`real_data`) without which it cannot run

    Quantities are in SI units. An experiment draws no figure and holds no result of the thesis.
    """

    id: str
    settings: Mapping[str, S]
    measure: Callable[[S, int, Effort], Quantities]
    replicates: int = 20
    deterministic: bool = False
    needs: str | None = None

    @property
    def can_run(self) -> bool:
        """Whether what it needs is there."""
        return self.needs is None or real_data(self.needs) is not None

    def repetitions(self, asked: int | None) -> int:
        """Replicates to run when so many are asked for, None for the default."""
        if self.deterministic:
            return 1
        return self.replicates if asked is None else count(asked, "replicates")
