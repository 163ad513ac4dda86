"""The planar two-link arm (section 3.4.1)."""

from dataclasses import dataclass

import numpy as np

from handeye.arrays import Array, finite, shaped
from handeye.errors import InvalidInput
from handeye.geometry.angles import wrap


@dataclass(frozen=True)
class TwoLinkArm:
    """Links a and b [m]; alpha is the angle of a from the x-axis, beta of b from a [rad].

    A length may be an array (N,), one for each of N trials of an arm that expands.
    Implements `handeye.robots.arm.Arm` in the plane z = 0.
    """

    a: float | Array = 1.0
    b: float | Array = 1.0

    name = "planar"
    joint_names = ("alpha", "beta")
    lower = np.full(2, -np.pi)
    upper = np.full(2, np.pi)
    held = np.zeros(2, np.bool_)

    def __post_init__(self) -> None:
        for name in ("a", "b"):
            length = getattr(self, name)
            if not np.all(finite(length, name) > 0.0):
                raise InvalidInput(f"link {name} must have a positive length [m], got {length}")

    @property
    def reach(self) -> float:
        """Largest distance of the tip from the base [m]."""
        return float(np.max(self.a + self.b))

    def tips(self, joints: Array) -> Array:
        """Tip positions (..., 2) [m] at angles (..., 2) (eq 3.6, 3.7)."""
        alpha, beta = joints[..., 0], joints[..., 1]
        x = self.a * np.cos(alpha) + self.b * np.cos(alpha + beta)
        y = self.a * np.sin(alpha) + self.b * np.sin(alpha + beta)
        return np.stack([x, y], axis=-1)

    def inverse(self, tips: Array, elbow: Array) -> Array:
        """Angles (..., 2) in (-pi, pi] that bring the tip to (..., 2), beta with the sign of elbow.

        Eq 3.13 to 3.17. A tip out of reach is answered with the arm stretched towards it or
        folded, since noise may put a hand that is there beyond nominal reach.
        """
        squared = np.sum(tips**2, axis=-1)
        distance = np.sqrt(squared)
        cos_beta = (squared - self.a**2 - self.b**2) / (2.0 * self.a * self.b)
        beta = np.sign(elbow) * np.arccos(np.clip(cos_beta, -1.0, 1.0))
        # At the base itself every direction serves; phi = pi / 2 is its limit for equal links.
        far = np.where(distance > 0.0, distance, 1.0)
        cos_phi = (squared + self.a**2 - self.b**2) / (2.0 * self.a * far)
        phi = np.arccos(np.clip(cos_phi, -1.0, 1.0))
        zeta = np.arctan2(tips[..., 1], tips[..., 0])
        return np.stack([wrap(zeta - np.sign(elbow) * phi), beta], axis=-1)

    def poses(self, joints: Array) -> Array:
        """T_base_tip (N, 4, 4) at angles (N, 2): x along the second link, z out of the plane.

        Raises InvalidInput for joints of another shape, as `jacobians` does.
        """
        joints = shaped(joints, (None, 2), "joints")
        heading = joints[:, 0] + joints[:, 1]
        out = np.zeros((len(joints), 4, 4))
        out[:, 0, 0] = out[:, 1, 1] = np.cos(heading)
        out[:, 1, 0] = np.sin(heading)
        out[:, 0, 1] = -out[:, 1, 0]
        out[:, 2, 2] = out[:, 3, 3] = 1.0
        out[:, :2, 3] = self.tips(joints)
        return out

    def jacobians(self, joints: Array) -> Array:
        """Tip velocity by joint velocity (N, 6, 2), linear rows first, in base axes."""
        joints = shaped(joints, (None, 2), "joints")
        tips = self.tips(joints)
        elbow = np.stack([np.cos(joints[:, 0]), np.sin(joints[:, 0])], axis=-1)
        second = tips - np.asarray(self.a)[..., np.newaxis] * elbow
        out = np.zeros((len(joints), 6, 2))
        for column, arm in enumerate((tips, second)):
            out[:, 0, column] = -arm[:, 1]
            out[:, 1, column] = arm[:, 0]
            out[:, 5, column] = 1.0
        return out
