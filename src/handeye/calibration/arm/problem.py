"""An arm with errors in every stage, and measurements of any kind, as one system of equations."""

from collections.abc import Iterator, Sequence

import numpy as np

from handeye.arrays import Array
from handeye.calibration.arm.description import describe
from handeye.calibration.arm.groups import prior_groups, shown_by
from handeye.calibration.arm.kernels import TWIST, pose_many, pose_slopes_many
from handeye.calibration.arm.measurement import Block, Measurement
from handeye.calibration.arm.sheet import ArmSheet, ChosenTerms, CurveTerms
from handeye.calibration.arm.system import Rows
from handeye.calibration.placement import Placement
from handeye.errors import InvalidInput
from handeye.robots.urdf import UrdfArm

_CHUNK = 256
_AT_ORIGIN = Placement(np.eye(4), np.eye(4))
# The kernel's own base and marker are not used: measurements bring their frames as blocks.
_OWN_FRAMES = 2 * TWIST


class ArmProblem:
    """A `System`: unknowns are those of the arm, then the blocks of the measurements.

    Args:
        arm: nominal kinematics.
        measurements: of any kinds; those that share a block's name share its unknowns.
        sheet: how far the arm may be from nominal.
        terms: how fine its error curves may be.

    Raises:
        InvalidInput: for no rows, joints that are not the arm's, or two blocks of one name that
            differ.
    """

    def __init__(
        self,
        arm: UrdfArm,
        measurements: Sequence[Measurement],
        sheet: ArmSheet,
        terms: CurveTerms | ChosenTerms,
    ) -> None:
        self.arm, self.measurements = arm, tuple(measurements)
        self.n_rows = sum(len(m.joints) for m in self.measurements)
        for m in self.measurements:
            if m.joints.shape[1:] != (len(arm.joint_names),):
                raise InvalidInput(
                    f"{arm.name} has {len(arm.joint_names)} joints; a measurement has joints of "
                    f"shape {m.joints.shape}"
                )
        if self.n_rows == 0:
            raise InvalidInput("no measurements: nothing can be learned of the arm")
        self.kernel = describe(
            arm, _AT_ORIGIN, terms.table(arm.stages().slides), turn_std=1.0,
            compliant=sheet.compliance > 0.0,
        )  # fmt: skip
        of_arm = sheet.tolerances(self.kernel)[_OWN_FRAMES:]
        self.n_arm = len(of_arm)
        self.blocks = _blocks(self.measurements)
        self.places: dict[str, slice] = {}
        at = self.n_arm
        for name, block in self.blocks.items():
            self.places[name] = slice(at, at + len(block.names))
            at += len(block.names)
        self.tolerance = np.concatenate([of_arm, *(b.tolerance for b in self.blocks.values())])
        self.groups = np.full(at, -1, np.int64)
        self.groups[: self.n_arm] = prior_groups(self.kernel)
        self.shown = np.ones(at, np.bool_)
        numbers = sum(m.std.size for m in self.measurements)
        self.shown[: self.n_arm] = shown_by(self.kernel, numbers)
        self.channels = tuple(dict.fromkeys(c for m in self.measurements for c in m.channels))
        self.n_channels = len(self.channels)
        self._seen = [self._rows_of(m.joints) for m in self.measurements]

    def own(self, measurement: Measurement, x: Array) -> tuple[Array, ...]:
        """The values of a measurement's blocks in x (n,)."""
        return tuple(x[self.places[block.name]] for block in measurement.blocks)

    def flanges(self, x: Array, joints: Array) -> Array:
        """T_base_flange (N, 4, 4) with the errors x (n,) at joints (N, n_joints)."""
        return self._flanges(x, self._rows_of(joints))

    def slopes(self, x: Array, joints: Array) -> Array:
        """Derivative (N, 6, n_arm) of the flange's pose by the unknowns of the arm.

        Shift of its origin [m], then turn about it [rad], in axes of the base.
        """
        return self._slopes(x, self._rows_of(joints))

    def rows(self, x: Array, *, slopes: bool = True) -> Iterator[Rows]:
        """All equations at x (n,), linearised there unless without `slopes`."""
        first = 0
        for measurement, seen in zip(self.measurements, self._seen, strict=True):
            parts = measurement.equations(self._flanges(x, seen), self.own(measurement, x))
            channels = np.array([self.channels.index(c) for c in measurement.channels])
            for start in range(0, len(seen), _CHUNK):
                some = slice(start, start + _CHUNK)
                by_all = np.zeros((*parts.residuals[some].shape, len(x) if slopes else 0))
                if slopes:
                    by_all[:, :, : self.n_arm] = parts.by_flange[some] @ self._slopes(x, seen[some])
                    for block, by_block in zip(measurement.blocks, parts.by_blocks, strict=True):
                        by_all[:, :, self.places[block.name]] += by_block[some]
                std = measurement.std[some]
                yield Rows(parts.residuals[some], by_all, std, channels, first + start)
            first += len(seen)

    def _rows_of(self, joints: Array) -> Array:
        if not self.kernel.compliant:
            return joints
        return np.hstack([joints, self.arm.loads(joints)])

    def _flanges(self, x: Array, seen: Array) -> Array:
        T = np.empty((len(seen), 3, 4))
        pose_many(self.kernel, self._of_kernel(x), seen, T)
        bottom = np.broadcast_to([[0.0, 0.0, 0.0, 1.0]], (len(seen), 1, 4))
        return np.concatenate([T, bottom], axis=1)

    def _slopes(self, x: Array, seen: Array) -> Array:
        all_x = self._of_kernel(x)
        T, slopes = np.empty((len(seen), 3, 4)), np.empty((len(seen), 6, len(all_x)))
        pose_slopes_many(self.kernel, all_x, seen, T, slopes)
        return slopes[:, :, _OWN_FRAMES:]

    def _of_kernel(self, x: Array) -> Array:
        return np.concatenate([np.zeros(_OWN_FRAMES), x[: self.n_arm]])


def _blocks(measurements: Sequence[Measurement]) -> dict[str, Block]:
    found: dict[str, Block] = {}
    for measurement in measurements:
        for block in measurement.blocks:
            same = found.setdefault(block.name, block)
            if same.names != block.names or not np.array_equal(same.tolerance, block.tolerance):
                raise InvalidInput(
                    f"two measurements describe {block.name} differently: give them the same block"
                )
    return found
