"""All joints of a robot that several chains pass: each has one set of unknowns, whoever passes it.

    T_base_tip = F_base^-1 F_tip

Base and tip part at some joint of the robot's tree. Both branches F lead from there away from the
root, as `kernels` has a chain: a joint's errors stand before its motion, on the side of the root,
wherever it is looked at from. So a chain read backwards is the inverse, with the same unknowns.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from handeye.arrays import Array, Integers
from handeye.calibration.arm.description import describe
from handeye.calibration.arm.kernels import (
    TWIST,
    SerialArm,
    joint_width,
    pose_many,
    pose_slopes_many,
)
from handeye.calibration.arm.sheet import ChosenTerms, CurveTerms
from handeye.calibration.hand_eye.turns import cross_matrix
from handeye.calibration.placement import Placement
from handeye.geometry import invert
from handeye.robots.stages import Stages
from handeye.robots.urdf import UrdfArm

OWN_FRAMES = 2 * TWIST
"""Unknowns of a kernel's own base and marker, which are not used: measurements have their own."""

_AT_ORIGIN = Placement(np.eye(4), np.eye(4))


class Seen(NamedTuple):
    """A chain through a robot, and its readings (N, m) in the rows that it was measured in."""

    arm: UrdfArm
    joints: Array


class JointTree:
    """The n joints of several chains, in the order in which the chains name them first.

    Beyond where joints were seen their curves keep the value of the edge.

    Args:
        seen: the chains.
        terms: how fine error curves may be.
        compliant: whether joints give way under gravity.
    """

    def __init__(
        self, seen: Sequence[Seen], terms: CurveTerms | ChosenTerms, *, compliant: bool
    ) -> None:
        self.names = tuple(dict.fromkeys(j for chain in seen for j in chain.arm.stage_names))
        n = len(self.names)
        slides, rates = np.zeros(n, np.bool_), np.ones(n)
        self.turns = np.empty((n, 3, 3))
        ends = np.array([[np.inf], [-np.inf]]) * np.ones(n)
        for arm, joints in seen:
            base, tip = arm.branches()
            own = [self.names.index(name) for name in arm.stage_names]
            slides[own] = arm.stages().slides
            self.turns[own] = np.concatenate([base.turns[::-1], tip.turns])
            rates[own] = np.where(slides[own], np.pi / arm.travel, 1.0)
            stood = arm.readings.positions(joints)
            ends[0, own] = np.minimum(ends[0, own], stood.min(axis=0, initial=np.inf))
            ends[1, own] = np.maximum(ends[1, own], stood.max(axis=0, initial=-np.inf))
        ends[:, ends[0] > ends[1]] = [[-np.inf], [np.inf]]
        low, high = ends if (given := terms.ends()) is None else given
        self.kernel = SerialArm(
            placements=np.tile(np.eye(4), (n + 1, 1, 1)), slides=slides, n_readings=0,
            of=np.zeros(n, np.int64), gains=np.ones(n), offsets=np.zeros(n), rates=rates,
            T_sensor_base=np.eye(4), T_flange_marker=np.eye(4), n_marker=TWIST,
            compliant=compliant, oriented=True, terms=terms.table(slides), low=low.copy(),
            high=high.copy(), turn_std=1.0, lever=1.0,
        )  # fmt: skip
        """All joints as if one were behind the other: the order of the unknowns."""


class TreeChain:
    """A chain between two links of the robot, with the errors of the joints that it passes.

    Joints that the tree lacks have none.
    """

    def __init__(self, arm: UrdfArm, tree: JointTree) -> None:
        self.arm = arm
        base, tip = arm.branches()
        n = len(base.slides)
        self._base = _Branch(arm, base, range(n - 1, -1, -1), tree)
        self._tip = _Branch(arm, tip, range(n, len(arm.stage_names)), tree)
        places = np.concatenate([self._base.places, self._tip.places])
        self._known = places >= 0
        self.places: Integers = places[self._known]
        """(c,) of the tree's unknowns, those that move the tip against the base."""

    def rows(self, joints: Array) -> Array:
        """What `poses` and `slopes` read of joints (N, m)."""
        if not self._tip.kernel.compliant:
            return joints
        return np.hstack([joints, self.arm.loads(joints)])

    def poses(self, x: Array, rows: Array) -> Array:
        """T_base_tip (N, 4, 4) with the errors x (n_x,) of the tree."""
        return invert(self._base.poses(x, rows)) @ self._tip.poses(x, rows)

    def slopes(self, x: Array, rows: Array) -> Array:
        """Derivative (N, 6, c) of the tip's pose by the unknowns at `places`.

        Shift of its origin [m], then turn about it [rad], in axes of the base.
        """
        (eye, own), (there, by) = self._base.slopes(x, rows), self._tip.slopes(x, rows)
        into = eye[:, :, :3].swapaxes(1, 2)
        # What turns the base carries the tip's origin the other way.
        apart = cross_matrix(there[:, :, 3] - eye[:, :, 3])
        shifts = np.concatenate([apart @ own[:, 3:] - own[:, :3], by[:, :3]], axis=2)
        turns = np.concatenate([-own[:, 3:], by[:, 3:]], axis=2)
        both = np.concatenate([into @ shifts, into @ turns], axis=1)
        return both if self._known.all() else both[:, :, self._known]


class _Branch:
    """Some stages of a chain, from the fork outwards, as a chain of its own."""

    def __init__(
        self, arm: UrdfArm, constants: Stages, stages: Sequence[int], tree: JointTree
    ) -> None:
        every = tree.kernel
        names = [arm.stage_names[i] for i in stages]
        joints = [tree.names.index(name) if name in tree.names else -1 for name in names]
        width, n = joint_width(every), len(every.slides)
        places = [j * width + i if j >= 0 else -1 for j in joints for i in range(width)]
        terms: list[tuple[int, int, int]] = []
        rows: list[list[int]] = every.terms.tolist()
        for k, (j, component, harmonic) in enumerate(rows):
            if j in joints:
                terms.append((joints.index(j), component, harmonic))
                places += [n * width + 2 * k, n * width + 2 * k + 1]
        self.places = np.array(places, np.int64)
        some = np.array(stages, np.int64)
        whole = describe(
            arm, _AT_ORIGIN, np.array(terms, np.int64), turn_std=1.0, compliant=every.compliant
        )
        held = np.array([*np.stack([every.low, every.high]).T, (-np.inf, np.inf)])[joints]
        self.kernel = whole._replace(
            placements=constants.upright().placements, slides=constants.slides, of=whole.of[some],
            gains=whole.gains[some], offsets=whole.offsets[some], rates=whole.rates[some],
            low=held[:, 0].copy(), high=held[:, 1].copy(),
        )  # fmt: skip
        readings = len(arm.readings.names)
        loads = readings + some if every.compliant else some[:0]
        self._columns = np.concatenate([np.arange(readings), loads])

    def poses(self, x: Array, rows: Array) -> Array:
        """T_fork_end (N, 4, 4)."""
        T = np.empty((len(rows), 3, 4))
        pose_many(self.kernel, self._own(x), self._read(rows), T)
        bottom = np.broadcast_to([[0.0, 0.0, 0.0, 1.0]], (len(rows), 1, 4))
        return np.concatenate([T, bottom], axis=1)

    def slopes(self, x: Array, rows: Array) -> tuple[Array, Array]:
        """T_fork_end (N, 3, 4), and its derivatives (N, 6, b) in axes of the fork."""
        own = self._own(x)
        T, slopes = np.empty((len(rows), 3, 4)), np.empty((len(rows), 6, len(own)))
        pose_slopes_many(self.kernel, own, self._read(rows), T, slopes)
        return T, slopes[:, :, OWN_FRAMES:]

    def _read(self, rows: Array) -> Array:
        # Indexing would turn its memory round, for which kernels would be compiled anew.
        return np.take(rows, self._columns, axis=1)

    def _own(self, x: Array) -> Array:
        return np.concatenate([np.zeros(OWN_FRAMES), np.append(x, 0.0)[self.places]])
