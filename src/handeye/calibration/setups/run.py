"""From a description of a set-up to a calibrated arm and how good it is."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from handeye.arrays import Booleans, Integers
from handeye.calibration.arm.measurements import seats
from handeye.calibration.results import Parameter, PartChange
from handeye.calibration.setups.description import Description
from handeye.calibration.setups.fit import MixedFit, fit_measurements
from handeye.calibration.setups.knowledge import beside_arm, of_arm, parts_of, undetermined_of
from handeye.calibration.setups.left_out import FOLDS, ChannelErrors, fitted, left_out

Status = Literal["improved", "unchanged", "worse"]

_UNCHANGED = 0.05


@dataclass(frozen=True, eq=False)
class SetupResult:
    """One run over a described set-up.

    described     what the file says
    fit           to all rows
    errors        by channel, on rows held out or, if there are none, on those that were fitted
    held_out      whether rows were
    of_arm, beside, parts, undetermined  what was found (`setups.knowledge`)
    doubtful      of each measurement, which of its rows hardly count
    """

    described: Description
    fit: MixedFit
    errors: Mapping[str, ChannelErrors]
    held_out: bool
    of_arm: tuple[Parameter, ...]
    beside: Mapping[str, tuple[Parameter, ...]]
    parts: tuple[PartChange, ...]
    undetermined: tuple[str, ...]
    doubtful: tuple[Integers, ...]

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """Of the arm, then of all that was found beside it."""
        return (*self.of_arm, *(one for some in self.beside.values() for one in some))

    @property
    def status(self) -> Status:
        """By the geometric mean, over the channels, of median errors after over before."""
        pairs = [errors.medians() for errors in self.errors.values()]
        ratios = [after / before for before, after in pairs if before > 0.0]
        change = float(np.exp(np.mean(np.log(np.maximum(ratios, 1e-9))))) if ratios else 1.0
        if change < 1.0 - _UNCHANGED:
            return "improved"
        return "unchanged" if change <= 1.0 + _UNCHANGED else "worse"

    def doubts(self, channel: str) -> Booleans:
        """(N,) which rows of a channel's errors hardly count in the fit to all rows."""
        errors = self.errors[channel]
        pairs = zip(errors.measurement.tolist(), errors.row.tolist(), strict=True)
        bad = [set(rows.tolist()) for rows in self.doubtful]
        return np.array([row in bad[one] for one, row in pairs], np.bool_)

    def worst(self, most: int) -> list[tuple[str, int]]:
        """Channels, and rows of their errors, that fit least, worst first."""
        every = [
            (float(times), channel, k)
            for channel, errors in self.errors.items()
            for k, times in enumerate(errors.times)
        ]
        every.sort(key=lambda one: -one[0])
        return [(channel, k) for _, channel, k in every[:most]]

    def source(self, channel: str, k: int) -> tuple[str, int]:
        """The table, and the number of its row there, of row k of a channel's errors."""
        errors = self.errors[channel]
        table = self.described.sources[int(errors.measurement[k])]
        return table.file, int(table.rows[errors.row[k]])

    @cached_property
    def ends(self) -> tuple[str, ...]:
        """Of each measurement, in words, between which links it is."""
        arm = self.described.arm
        chains = [arm.between(one.link, one.base) for one in self.fit.given]
        return tuple(f"{chain.tip} from {chain.base}" for chain in chains)

    @cached_property
    def carried_by(self) -> Mapping[str, str]:
        """Of each frame and unknown point the link, or the frame, in which it is."""
        return seats(self.described.arm, self.fit.given)

    def titled(self, name: str) -> str:
        """A frame or point by its name, and where it is if that is not the same for all."""
        seat = self.carried_by.get(name)
        return f"{name}, on {seat}" if seat and len(set(self.ends)) > 1 else name

    def joints_of(self, errors: ChannelErrors) -> dict[tuple[str, ...], list[int]]:
        """Measurements that a channel has rows of, by the joints that they depend on."""
        out: dict[tuple[str, ...], list[int]] = {}
        used: list[int] = np.unique(errors.measurement).tolist()
        for i in used:
            one = self.fit.given[i]
            names = self.fit.problem.chain(one.link, one.base).arm.joint_names
            out.setdefault(names, []).append(i)
        return out

    @cached_property
    def sliding(self) -> frozenset[str]:
        """Joints that slide: their readings are in metres."""
        tree = self.fit.problem.tree
        return frozenset(np.array(tree.names)[tree.kernel.slides].tolist())

    @property
    def rejected(self) -> tuple[str, ...]:
        """Rows of tables that were left out, and why."""
        return tuple(line for source in self.described.sources for line in source.rejected)

    @property
    def n_rows(self) -> int:
        """Of all measurements."""
        return sum(len(source.rows) for source in self.described.sources)


def calibrate_setup(
    described: Description,
    *,
    validate: bool = True,
    progress: Callable[[int, int], None] | None = None,
) -> SetupResult:
    """Fit arm and set-up to all rows, and judge that by leaving out blocks of rows in turn.

    validate: whether to judge; without it errors are those of the rows that were fitted.
    progress(done, of) is called as the fits get on.

    Raises:
        InvalidInput: as `fit_measurements` and `left_out`.
    """
    arm, measurements, sheet = described.arm, described.measurements, described.sheet
    fits = 1 + FOLDS * validate
    say = progress or _quiet
    fit = fit_measurements(arm, measurements, sheet)
    say(1, fits)
    if validate:
        errors = left_out(
            arm, measurements, sheet, placed=described.placed,
            after_each=lambda done, _: say(1 + done, fits),
        )  # fmt: skip
    else:
        errors = fitted(fit, described.placed)
    return SetupResult(
        described, fit, errors, validate, of_arm(fit), beside_arm(fit, described.stated),
        parts_of(fit), undetermined_of(fit), fit.doubtful(),
    )  # fmt: skip


def _quiet(done: int, of: int) -> None:
    """Shows nothing."""
