"""The constants of a serial chain: fixed placements with one moving joint between each two."""

from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from scipy.spatial.transform import Rotation

from handeye.arrays import Array, Booleans, shaped
from handeye.errors import InvalidInput
from handeye.geometry import invert
from handeye.robots.ways import Way

_Z = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class Stages:
    """A chain of n joints: T_base_flange(q) = P_0 J_0(q_0) P_1 J_1(q_1) ... J_n-1(q_n-1) P_n.

    placements  P (n + 1, 4, 4)
    axes        (n, 3) unit vectors in the frame in which the joint moves: J turns about it by q
                [rad], or slides along it by q [m]
    slides      (n,) whether it slides
    upwards     so many of the first joints lead towards the root of the robot's tree: they move
                what is before them, so that their placements stand inverted and their axes reversed

    Raises InvalidInput for shapes that do not fit, and axes that are no unit vectors.
    """

    placements: Array
    axes: Array
    slides: Booleans
    upwards: int = 0

    def __post_init__(self) -> None:
        n = len(self.slides)
        shaped(self.placements, (n + 1, 4, 4), "placements")
        lengths = np.linalg.norm(shaped(self.axes, (n, 3), "axes"), axis=1)
        if not np.allclose(lengths, 1.0, atol=1e-9):
            raise InvalidInput(f"the axis of a joint must have length 1, got {lengths}")

    @classmethod
    def of(cls, model: Any, way: Way, eye: Array, tip: Array) -> Self:
        """Of the joints on a way through a pinocchio model.

        eye, tip (4, 4): the ends of the chain in the frames of the joints that carry them.
        """
        chain = way.joints
        axes, slides = np.empty((len(chain), 3)), np.empty(len(chain), np.bool_)
        placements: list[Array] = []
        here = invert(eye)
        for i, number in enumerate(chain):
            joint, place = model.joints[number], model.jointPlacements[number].homogeneous
            data = joint.createData()
            joint.calc(data, np.eye(joint.nq)[0])
            motion = np.asarray(data.S).reshape(6)
            slides[i] = bool(np.any(motion[:3]))
            axes[i] = motion[:3] if slides[i] else motion[3:]
            up = i < len(way.up)
            placements.append(here if up else here @ place)
            here = invert(place) if up else np.eye(4)
            axes[i] *= -1.0 if up else 1.0
        return cls(np.array([*placements, here @ tip]), axes, slides, len(way.up))

    @property
    def turns(self) -> Array:
        """Rotations A (n, 3, 3) that take the z axis to each joint's axis."""
        out = np.empty((len(self.slides), 3, 3))
        for turn, axis in zip(out, self.axes, strict=True):
            across = np.cross(_Z, axis)
            size = float(np.linalg.norm(across))
            across = across / size if size > 1e-12 else np.array([1.0, 0.0, 0.0])
            turn[:] = Rotation.from_rotvec(np.arctan2(size, axis[2]) * across).as_matrix()
        return out

    def upright(self) -> "Stages":
        """The same chain with every joint's axis along z of the frame in which it moves.

        With A_j the `turns`, J_j = A_j Z_j A_j^T, so that P_j becomes A_j-1^T P_j A_j.
        """
        n = len(self.slides)
        ways, turns = self.placements.copy(), self.turns
        for j in range(n):
            ways[j, :3, :3] = ways[j, :3, :3] @ turns[j]
            ways[j + 1, :3] = turns[j].T @ ways[j + 1, :3]
        return Stages(ways, np.tile(_Z, (n, 1)), self.slides, self.upwards)

    def poses(self, joints: Array) -> Array:
        """T_base_flange (N, 4, 4) at joints (N, n)."""
        q = shaped(joints, (None, len(self.slides)), "joints")
        out = np.tile(self.placements[0], (len(q), 1, 1))
        for j, slides in enumerate(self.slides):
            moved = np.tile(np.eye(4), (len(q), 1, 1))
            along = q[:, j : j + 1] * self.axes[j]
            if slides:
                moved[:, :3, 3] = along
            else:
                moved[:, :3, :3] = Rotation.from_rotvec(along).as_matrix()
            out = out @ moved @ self.placements[j + 1]
        return out

    def departures(self, found: "Stages") -> Array:
        """D (n, 4, 4): how far each joint of `found` stands from here, in its own frame.

            T_parent_joint (found) = T_parent_joint (here) D_j

        With E_i = P_i^-1 P_i' of the stages, D_j = E_j where the chain leads away from the root.
        Where it leads to the root, joint j's own placement is the inverse of P_j+1, and
        D_j = P_j+1 E_j+1^-1 P_j+1^-1. Of the two joints below the fork the one that leads away
        has the error between them. E_0 of a chain that starts upwards, and the last stage, are
        not of any joint.
        """
        n = len(self.slides)
        E: Array = invert(self.placements) @ found.placements
        out = E[:n].copy()
        if self.upwards:
            inner = slice(1, self.upwards)
            P = self.placements[inner]
            out[: self.upwards - 1] = P @ invert(E[inner]) @ invert(P)
            out[self.upwards - 1] = np.eye(4)
        return out
