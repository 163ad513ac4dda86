"""What experiments measured, row by row, and how verdicts and figures look it up."""

from collections.abc import Iterable
from difflib import get_close_matches
from functools import cached_property
from typing import NamedTuple

import numpy as np

from handeye.arrays import Array
from handeye.errors import InvalidInput
from handeye.thesis.experiment import Curve, Quantities


class Record(NamedTuple):
    """One measured number; `at` is None, or the trials behind a point of a curve."""

    experiment: str
    setting: str
    replicate: int
    quantity: str
    at: float | None
    value: float


def flatten(experiment: str, setting: str, replicate: int, measured: Quantities) -> list[Record]:
    """One record for each number and each point of a curve."""
    rows: list[Record] = []
    for name, quantity in measured.items():
        if isinstance(quantity, Curve):
            points = zip(quantity.at.tolist(), quantity.value.tolist(), strict=True)
        else:
            points = [(None, float(quantity))]
        rows += [Record(experiment, setting, replicate, name, at, value) for at, value in points]
    return rows


class Records:
    """Rows, found by paths `experiment/setting/quantity`."""

    def __init__(self, rows: Iterable[Record]) -> None:
        self.rows = tuple(rows)

    @cached_property
    def _by_path(self) -> dict[str, dict[int, list[tuple[float | None, float]]]]:
        found: dict[str, dict[int, list[tuple[float | None, float]]]] = {}
        for row in self.rows:
            path = f"{row.experiment}/{row.setting}/{row.quantity}"
            points = found.setdefault(path, {}).setdefault(row.replicate, [])
            points.append((row.at, row.value))
        return found

    def settings(self, experiment: str) -> tuple[str, ...]:
        """The settings that an experiment was run with, in order."""
        return tuple(dict.fromkeys(r.setting for r in self.rows if r.experiment == experiment))

    def curve(self, path: str) -> tuple[Array, Array]:
        """Trials (M,) of a curve and its values in every replicate, (replicates, M)."""
        points = self._find(path)
        at = [p[0] for p in points[0]]
        if None in at or any([p[0] for p in one] != at for one in points):
            raise InvalidInput(f"{path} is not one curve with the same trials in every replicate")
        return np.array(at, np.float64), np.array([[p[1] for p in one] for one in points])

    def values(self, path: str) -> Array:
        """A number or the end of a curve in every replicate, (replicates,).

        `path@1000` is the curve's point after 1000 trials.
        """
        name, _, at = path.partition("@")
        points = self._find(name)
        if not at:
            return np.array([one[-1][1] for one in points])
        picked = [[value for trials, value in one if trials == float(at)] for one in points]
        if not all(picked):
            raise InvalidInput(f"{name} was not measured after {at} trials")
        return np.array([one[0] for one in picked])

    def _find(self, path: str) -> list[list[tuple[float | None, float]]]:
        if path not in self._by_path:
            near = get_close_matches(path, self._by_path, n=3)
            hint = f"; did you mean {' or '.join(near)}?" if near else ""
            raise InvalidInput(f"no records of {path}{hint}")
        return list(self._by_path[path].values())
