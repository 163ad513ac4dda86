"""An arm as learned, but for its curves: constants that a URDF file can state."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from scipy.spatial.transform import Rotation

from handeye.arrays import Array
from handeye.calibration.arm.kernels import TWIST, SerialArm, joint_at, joint_width
from handeye.calibration.arm.tree import JointTree
from handeye.calibration.placement import Placement
from handeye.geometry import invert, make_pose
from handeye.robots.stages import Stages


@dataclass(frozen=True, eq=False)
class CorrectedArm:
    """Constants of an arm that was calibrated.

    stages       the chain with corrected placements, and axes as in the nominal one
    placement    base and marker
    scales       (n,) what each reading is multiplied by
    compliances  (n,) what each joint gives way under a load [rad/Nm] or [m/N]
    """

    stages: Stages
    placement: Placement
    scales: Array
    compliances: Array


@dataclass(frozen=True, eq=False)
class CorrectedJoints:
    """Constants of joints that were calibrated, wherever in the robot's tree they are.

    names        of the n joints
    departures   D (n, 4, 4): how far each stands from where it was, in its own frame,
                 T_parent_joint (found) = T_parent_joint (nominal) D
    scales       (n,) what each reading is multiplied by
    compliances  (n,) what each joint gives way under a load [rad/Nm] or [m/N]
    """

    names: tuple[str, ...]
    departures: Array
    scales: Array
    compliances: Array

    @classmethod
    def of_arm(cls, names: tuple[str, ...], nominal: Stages, found: CorrectedArm) -> Self:
        """Of a chain of joints."""
        departures = nominal.departures(found.stages)
        return cls(names, departures, found.scales, found.compliances)

    @classmethod
    def of_tree(cls, tree: JointTree, x: Array) -> Self:
        """Of the joints of a tree with unknowns x (n_x,); D = A E(xi) A^T as in `corrected`."""
        kernel = tree.kernel
        every = x[: len(kernel.slides) * joint_width(kernel)].reshape(len(kernel.slides), -1)
        D = np.array([
            _shifted(turn @ own[:3], turn @ own[3:TWIST])
            for turn, own in zip(tree.turns, every, strict=True)
        ])  # fmt: skip
        give = every[:, TWIST + 1] if kernel.compliant else np.zeros(len(every))
        return cls(tree.names, D, 1.0 + every[:, TWIST], give)


def corrected(kernel: SerialArm, stages: Stages, x: Array) -> CorrectedArm:
    """The arm with constants of unknowns x (n_x,); stages are the nominal ones.

    A twist is stated in the upright frame of its joint, turned by A from the frame of the URDF
    file: there it is A E(xi) A^T. Where the chain starts upwards in the tree, what is before the
    first joint is no joint's placement: there the sensor is mounted elsewhere on its link.
    """
    n = len(kernel.slides)
    ways, turns = stages.placements.copy(), stages.turns
    scales, compliances = np.ones(n), np.zeros(n)
    for j in range(n):
        at = joint_at(kernel, j)
        shift, turn = x[at : at + 3] @ turns[j].T, x[at + 3 : at + TWIST] @ turns[j].T
        ways[j] = ways[j] @ _shifted(shift, turn)
        scales[j] += x[at + TWIST]
        if kernel.compliant:
            compliances[j] = x[at + TWIST + 1]
    marker = np.zeros(TWIST)
    marker[: kernel.n_marker] = x[TWIST : TWIST + kernel.n_marker]
    T_sensor_base = kernel.T_sensor_base @ _shifted(x[:3], x[3:TWIST])
    if stages.upwards:
        T_sensor_base = T_sensor_base @ ways[0] @ invert(stages.placements[0])
        ways[0] = stages.placements[0]
    T_flange_marker = _shifted(marker[:3], marker[3:]) @ kernel.T_flange_marker
    return CorrectedArm(
        Stages(ways, stages.axes, stages.slides, stages.upwards),
        Placement(T_sensor_base, T_flange_marker),
        scales,
        compliances,
    )


def _shifted(shift: Array, turn: Array) -> Array:
    """E(t, r): the pose that shifts by t and turns by exp([r]x)."""
    return make_pose(Rotation.from_rotvec(turn).as_matrix(), shift)
