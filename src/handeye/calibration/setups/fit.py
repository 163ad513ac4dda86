"""An arm fitted to measurements of any kinds at once."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.linalg import solve_triangular

from handeye.arrays import Array, Integers
from handeye.calibration.arm.chain import arm_chain
from handeye.calibration.arm.corrected import CorrectedJoints
from handeye.calibration.arm.estimator import FINE
from handeye.calibration.arm.evidence import Posterior, solve
from handeye.calibration.arm.measurements import Instrument, seats
from handeye.calibration.arm.measurements.unknowns import Unknown
from handeye.calibration.arm.problem import ArmProblem
from handeye.calibration.arm.sheet import ArmSheet
from handeye.calibration.arm.student import FREEDOM
from handeye.calibration.arm.tree import OWN_FRAMES
from handeye.calibration.engine.chain import Group
from handeye.errors import InvalidInput
from handeye.robots.urdf import UrdfArm

# A row that counts less than this, where one as good as expected counts 1, is to be looked at.
_DOUBTFUL = 0.25


@dataclass(frozen=True, eq=False)
class MixedFit:
    """An arm as fitted.

    problem    its unknowns, and those of the measurements
    posterior  what is known of the unknowns
    sheet      how far the arm was said to be from nominal
    given      the measurements, with everything where it was placed before the fit
    """

    problem: ArmProblem
    posterior: Posterior
    sheet: ArmSheet
    given: tuple[Instrument, ...]

    @cached_property
    def measurements(self) -> tuple[Instrument, ...]:
        """With their frames, points and numbers where they were found."""
        x = self.posterior.x
        changes: Mapping[str, Array] = {n: x[at] for n, at in self.problem.places.items()}
        return tuple(one.moved(changes) for one in self.given)

    def flanges(self, joints: Array, link: str | None = None, base: str | None = None) -> Array:
        """T_base_link (N, 4, 4) of the arm with its errors, at joints (N, n) between the two.

        By default from the base to the flange of the arm.

        Raises:
            InvalidInput: links that are not there, or joints that are not those between them.
        """
        return self.problem.flanges(self.posterior.x, joints, link, base)

    def flanges_of(self, one: Instrument) -> Array:
        """The same at the rows of a measurement, between its links."""
        return self.flanges(one.joints, one.link, one.base)

    @property
    def noise(self) -> dict[str, float]:
        """Standard deviation of each channel beyond what was stated."""
        return dict(zip(self.problem.channels, self.posterior.noise.tolist(), strict=True))

    @property
    def unknowns(self) -> dict[str, Unknown]:
        """What was found beside the arm, by name."""
        return {u.name: u for one in self.measurements for u in one.unknowns if u.free.any()}

    @cached_property
    def covariance(self) -> Array:
        """Of all unknowns (n, n), those of the arm first."""
        root = self.posterior.root
        half = solve_triangular(root, np.diag(self.problem.tolerance), lower=True)
        return np.asarray(half.T @ half)

    def std(self, name: str) -> Array:
        """Standard deviations (m,) of the free components of what has this name.

        Raises:
            InvalidInput: nothing that was found is called so.
        """
        places = self.problem.places
        if name not in places:
            raise InvalidInput(f"{name} was not fitted; there are {', '.join(places)}")
        return np.sqrt(np.diag(self.covariance)[places[name]])

    @cached_property
    def corrected(self) -> CorrectedJoints:
        """The joints as fitted, but for their curves."""
        return CorrectedJoints.of_tree(self.problem.tree, self.posterior.x)

    def of_arm(self) -> tuple[tuple[str, ...], tuple[str, ...], tuple[bool, ...], list[Group]]:
        """Of the arm's unknowns names, units and which are of curves; and its parts."""
        tree = self.problem.tree
        chain = arm_chain(tree.kernel, tree.names, self.sheet)
        parts = [
            Group(part.words, tuple(place - OWN_FRAMES for place in part.places))
            for part in chain.groups
            if min(part.places) >= OWN_FRAMES
        ]
        curved = tuple(chain.curved[OWN_FRAMES:].tolist())
        return chain.names[OWN_FRAMES:], chain.units[OWN_FRAMES:], curved, parts

    def doubtful(self) -> tuple[Integers, ...]:
        """Rows of each measurement that fit so badly that they hardly count."""
        sizes = np.array([values_of(self.given, c) for c in self.problem.channels])
        weights = (FREEDOM + sizes) / (FREEDOM + np.nan_to_num(self.posterior.squares))
        bad = (weights < _DOUBTFUL).any(axis=1)
        ends = np.cumsum([len(one.joints) for one in self.given])[:-1]
        return tuple(np.flatnonzero(part) for part in np.split(bad, ends))


def fit_measurements(
    arm: UrdfArm,
    measurements: Sequence[Instrument],
    sheet: ArmSheet | None = None,
    after_each: Callable[[int, int], None] | None = None,
) -> MixedFit:
    """The arm and all else that is unknown, from measurements of any kinds that were placed.

    Measurements may be between different links of the robot (`Instrument.along`); a joint that
    several pass is the same. sheet: how far the arm may be from nominal; by default `ArmSheet` with
    curves `FINE`. Noise of each channel, and which errors the arm has at all, are found too
    (`evidence`).
    after_each(round, rounds) is called after each round.

    Raises:
        InvalidInput: as `ArmProblem` and `seats`.
    """
    seats(arm, measurements)
    sheet = sheet or replace(ArmSheet(), curves=FINE)
    problem = ArmProblem(arm, measurements, sheet, sheet.curves)
    return MixedFit(problem, solve(problem, after_each), sheet, tuple(measurements))


def residuals(one: Instrument, flanges: Array) -> dict[str, Array]:
    """Measured minus predicted (N, k) by channel, at T_base_flange (N, 4, 4)."""
    own = tuple(np.zeros(len(block.names)) for block in one.blocks)
    r = one.equations(flanges, own).residuals
    channels = np.array(one.channels)
    return {c: r[:, channels == c] for c in dict.fromkeys(one.channels)}


def values_of(measurements: Sequence[Instrument], channel: str) -> int:
    """How many values of a row are of a channel."""
    return max(one.channels.count(channel) for one in measurements)
