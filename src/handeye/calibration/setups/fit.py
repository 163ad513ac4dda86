"""An arm fitted to measurements of any kinds at once, and how well it does on rows left out."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.linalg import solve_triangular

from handeye.arrays import Array, Integers, count
from handeye.calibration.arm.estimator import FINE
from handeye.calibration.arm.evidence import FREEDOM, Posterior, solve
from handeye.calibration.arm.measurements import Instrument
from handeye.calibration.arm.measurements.unknowns import Unknown
from handeye.calibration.arm.problem import ArmProblem
from handeye.calibration.arm.sheet import ArmSheet
from handeye.errors import InvalidInput
from handeye.robots.urdf import UrdfArm

# A row that counts less than this, where one as good as expected counts 1, is to be looked at.
_DOUBTFUL = 0.25


@dataclass(frozen=True, eq=False)
class MixedFit:
    """An arm as fitted.

    problem       its unknowns, and those of the measurements
    posterior     what is known of them
    measurements  with their frames, points and numbers where they were found
    """

    problem: ArmProblem
    posterior: Posterior
    measurements: tuple[Instrument, ...]

    def flanges(self, joints: Array) -> Array:
        """T_base_flange (N, 4, 4) of the arm with its errors, at joints (N, n)."""
        return self.problem.flanges(self.posterior.x, joints)

    @property
    def noise(self) -> dict[str, float]:
        """Standard deviation of each channel beyond what was stated."""
        return dict(zip(self.problem.channels, self.posterior.noise.tolist(), strict=True))

    @property
    def unknowns(self) -> dict[str, Unknown]:
        """What was found beside the arm, by name."""
        return {u.name: u for one in self.measurements for u in one.unknowns if u.free.any()}

    def std(self, name: str) -> Array:
        """Standard deviations (m,) of the free components of what has this name.

        Raises:
            InvalidInput: nothing that was found is called so.
        """
        places = self.problem.places
        if name not in places:
            raise InvalidInput(f"{name} was not fitted; there are {', '.join(places)}")
        root = self.posterior.root
        half = solve_triangular(root, np.eye(len(root)), lower=True)
        std = np.linalg.norm(half, axis=0) * self.problem.tolerance
        return std[places[name]]

    def doubtful(self) -> tuple[Integers, ...]:
        """Rows of each measurement that fit so badly that they hardly count."""
        sizes = np.array([_values(self.measurements, c) for c in self.problem.channels])
        weights = (FREEDOM + sizes) / (FREEDOM + np.nan_to_num(self.posterior.squares))
        bad = (weights < _DOUBTFUL).any(axis=1)
        ends = np.cumsum([len(one.joints) for one in self.measurements])[:-1]
        return tuple(np.flatnonzero(part) for part in np.split(bad, ends))


class LeftOut(NamedTuple):
    """Sizes (N,) of what a channel's values are off on rows that were left out, in its unit.

    before   of the arm as its model says
    after    of the arm as fitted to the other rows
    """

    before: Array
    after: Array


def fit_measurements(
    arm: UrdfArm, measurements: Sequence[Instrument], sheet: ArmSheet | None = None
) -> MixedFit:
    """The arm and all else that is unknown, from measurements of any kinds that were placed.

    sheet: how far the arm may be from nominal; by default `ArmSheet` with curves `FINE`. Noise of
    each channel, and which errors the arm has at all, are found too (`evidence`).

    Raises:
        InvalidInput: as `ArmProblem`.
    """
    sheet = sheet or replace(ArmSheet(), curves=FINE)
    problem = ArmProblem(arm, measurements, sheet, sheet.curves)
    found = solve(problem)
    return MixedFit(problem, found, _at(measurements, problem, found.x))


def left_out(
    arm: UrdfArm,
    measurements: Sequence[Instrument],
    sheet: ArmSheet | None = None,
    folds: int = 5,
) -> dict[str, LeftOut]:
    """By channel, errors on each of several blocks of rows when the others are fitted.

    Frames and points of a nominal arm are where the measurements have them, placed by all rows.

    Raises:
        InvalidInput: fewer than two folds, or so few rows that one is empty.
    """
    n = count(folds, "folds", least=2)
    numbers = [one.folds(n) for one in measurements]
    if any(set(number.tolist()) != set(range(n)) for number in numbers):
        raise InvalidInput(f"every measurement needs rows in each of {n} blocks: ask for fewer")
    errors: dict[str, list[LeftOut]] = {}
    for fold in range(n):
        kept, held = (
            [one.only(np.flatnonzero(keep)) for one, keep in zip(measurements, which, strict=True)]
            for which in ([k != fold for k in numbers], [k == fold for k in numbers])
        )
        fit = fit_measurements(arm, kept, sheet)
        placed = _at(held, fit.problem, fit.posterior.x)
        for one, there in zip(held, placed, strict=True):
            before = _sizes(one, arm.poses(one.joints))
            after = _sizes(there, fit.flanges(one.joints))
            for channel in before:
                errors.setdefault(channel, []).append(LeftOut(before[channel], after[channel]))
    return {
        channel: LeftOut(*(np.concatenate(part) for part in zip(*parts, strict=True)))
        for channel, parts in errors.items()
    }


def _at(
    measurements: Sequence[Instrument], problem: ArmProblem, x: Array
) -> tuple[Instrument, ...]:
    changes: Mapping[str, Array] = {name: x[place] for name, place in problem.places.items()}
    return tuple(one.moved(changes) for one in measurements)


def _sizes(one: Instrument, flanges: Array) -> dict[str, Array]:
    """By channel, the length (N,) of a row's residuals."""
    own = tuple(np.zeros(len(block.names)) for block in one.blocks)
    r = one.equations(flanges, own).residuals
    channels = np.array(one.channels)
    return {c: np.linalg.norm(r[:, channels == c], axis=1) for c in dict.fromkeys(one.channels)}


def _values(measurements: Sequence[Instrument], channel: str) -> int:
    return max(one.channels.count(channel) for one in measurements)
