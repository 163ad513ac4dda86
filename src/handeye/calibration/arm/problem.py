"""An arm with errors in every stage, and measurements of any kind, as one system of equations."""

from collections.abc import Iterator, Sequence

import numpy as np

from handeye.arrays import Array, Integers
from handeye.calibration.arm.groups import prior_groups, shown_of
from handeye.calibration.arm.measurement import Block, Measurement
from handeye.calibration.arm.sheet import ArmSheet, ChosenTerms, CurveTerms
from handeye.calibration.arm.system import Rows
from handeye.calibration.arm.tree import OWN_FRAMES, JointTree, Seen, TreeChain
from handeye.errors import InvalidInput
from handeye.robots.urdf import UrdfArm

_CHUNK = 256


class ArmProblem:
    """A `System`: unknowns are those of the arm, then the blocks of the measurements.

    Measurements may be of any links of the robot: between what each names as `base` and `link`.
    The arm's unknowns are those of all joints between some of these, once for each joint.

    Args:
        arm: nominal kinematics; its ends are those of measurements that name none.
        measurements: of any kinds; those that share a block's name share its unknowns.
        sheet: how far the arm may be from nominal.
        terms: how fine its error curves may be.

    Raises:
        InvalidInput: for no rows, joints that are not those between the links, links that are not
            there or do not move against each other, or two blocks of one name that differ.
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
        chains = [_between(arm, m) for m in self.measurements]
        if self.n_rows == 0:
            raise InvalidInput("no measurements: nothing can be learned of the arm")
        seen = [Seen(c, m.joints) for c, m in zip(chains, self.measurements, strict=True)]
        self.tree = JointTree(seen, terms, compliant=sheet.compliance > 0.0)
        self._chains: dict[tuple[str, str], TreeChain] = {}
        kernel = self.tree.kernel
        of_arm = sheet.tolerances(kernel)[OWN_FRAMES:]
        self.n_arm = len(of_arm)
        self.blocks = _blocks(self.measurements)
        self.places: dict[str, slice] = {}
        at = self.n_arm
        for name, block in self.blocks.items():
            self.places[name] = slice(at, at + len(block.names))
            at += len(block.names)
        self.tolerance = np.concatenate([of_arm, *(b.tolerance for b in self.blocks.values())])
        self.groups = np.full(at, -1, np.int64)
        self.groups[: self.n_arm] = prior_groups(kernel)
        self.shown = np.ones(at, np.bool_)
        numbers = np.zeros(len(self.tree.names))
        for chain, m in zip(chains, self.measurements, strict=True):
            joints = [self.tree.names.index(name) for name in chain.stage_names]
            numbers[joints] += m.std.size / len(joints)
        self.shown[: self.n_arm] = shown_of(kernel, numbers)
        self.channels = tuple(dict.fromkeys(c for m in self.measurements for c in m.channels))
        self.n_channels = len(self.channels)
        self._rows = [self.chain(m.link, m.base).rows(m.joints) for m in self.measurements]

    def own(self, measurement: Measurement, x: Array) -> tuple[Array, ...]:
        """The values of a measurement's blocks in x (n,)."""
        return tuple(x[self.places[block.name]] for block in measurement.blocks)

    def chain(self, link: str | None = None, base: str | None = None) -> TreeChain:
        """From the link `base` to the link `link`, by default those of the arm.

        Raises:
            InvalidInput: links that are not there, or that no joint moves against each other.
        """
        ends = link or self.arm.tip, base or self.arm.base
        if ends not in self._chains:
            self._chains[ends] = TreeChain(self.arm.between(*ends), self.tree)
        return self._chains[ends]

    def flanges(
        self, x: Array, joints: Array, link: str | None = None, base: str | None = None
    ) -> Array:
        """T_base_link (N, 4, 4) with the errors x (n,) at joints (N, n_joints) between them."""
        chain = self.chain(link, base)
        return chain.poses(x[: self.n_arm], chain.rows(joints))

    def slopes(
        self, x: Array, joints: Array, link: str | None = None, base: str | None = None
    ) -> Array:
        """Derivative (N, 6, n_arm) of the same poses by the unknowns of the arm.

        Shift of the link's origin [m], then turn about it [rad], in axes of the base.
        """
        chain = self.chain(link, base)
        out = np.zeros((len(joints), 6, self.n_arm))
        out[:, :, chain.places] = chain.slopes(x[: self.n_arm], chain.rows(joints))
        return out

    def rows(self, x: Array, *, slopes: bool = True) -> Iterator[Rows]:
        """All equations at x (n,), linearised there unless without `slopes`."""
        first, of_arm = 0, x[: self.n_arm]
        for measurement, seen in zip(self.measurements, self._rows, strict=True):
            chain = self.chain(measurement.link, measurement.base)
            parts = measurement.equations(chain.poses(of_arm, seen), self.own(measurement, x))
            channels = np.array([self.channels.index(c) for c in measurement.channels])
            for start in range(0, len(seen), _CHUNK):
                some = slice(start, start + _CHUNK)
                by_all = np.zeros((*parts.residuals[some].shape, len(x) if slopes else 0))
                if slopes:
                    by_arm = parts.by_flange[some] @ chain.slopes(of_arm, seen[some])
                    by_all[:, :, self._where(chain)] = by_arm
                    for block, by_block in zip(measurement.blocks, parts.by_blocks, strict=True):
                        by_all[:, :, self.places[block.name]] += by_block[some]
                std = measurement.std[some]
                yield Rows(parts.residuals[some], by_all, std, channels, first + start)
            first += len(seen)

    def _where(self, chain: TreeChain) -> Integers | slice:
        """Columns of the unknowns that a chain has; as a slice, which is quicker, if it has all."""
        every = np.array_equal(chain.places, np.arange(self.n_arm))
        return slice(0, self.n_arm) if every else chain.places


def _between(arm: UrdfArm, measurement: Measurement) -> UrdfArm:
    """The chain between a measurement's links, whose joints it has."""
    chain, shape = arm.between(measurement.link, measurement.base), measurement.joints.shape
    if shape[1:] != (len(chain.joint_names),):
        raise InvalidInput(
            f"{arm.name} has {len(chain.joint_names)} joints from {chain.base} to {chain.tip} "
            f"({', '.join(chain.joint_names)}); a measurement has joints of shape {shape}"
        )
    return chain


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
