"""Arms and what a tracker sees of them, for tests of placements."""

import numpy as np
from scipy.spatial.transform import Rotation

from handeye.calibration.placement import Placement
from handeye.geometry import make_pose, wxyz_from_matrix
from handeye.observations import PointObservation
from handeye.robots.urdf import load_arm

UR10 = load_arm("ur10")


class Planar:
    """A two-link arm in the plane z = 0."""

    name = "planar"
    joint_names = ("alpha", "beta")
    lower = np.full(2, -np.pi)
    upper = np.full(2, np.pi)
    reach = 0.55
    held = np.zeros(2, np.bool_)

    def poses(self, joints):
        alpha, both = joints[:, 0], joints.sum(axis=1)
        R = Rotation.from_rotvec(both[:, None] * [0.0, 0.0, 1.0]).as_matrix()
        x = 0.3 * np.cos(alpha) + 0.25 * np.cos(both)
        y = 0.3 * np.sin(alpha) + 0.25 * np.sin(both)
        return make_pose(R, np.stack([x, y, 0.0 * x], axis=1))

    def jacobians(self, joints):
        raise NotImplementedError


def random_pose(rng, size):
    return make_pose(Rotation.random(rng=rng).as_matrix(), size * rng.normal(size=3))


def sightings(arm, joints, rng, *, noise=0.0, oriented=True, marker=0.2):
    """A true placement, and what a tracker sees of it."""
    true = Placement(random_pose(rng, 2.0), random_pose(rng, marker))
    seen = true.T_sensor_base @ arm.poses(joints) @ true.T_flange_marker
    wobble = Rotation.from_rotvec(noise * rng.normal(size=(len(joints), 3))).as_matrix()
    return true, PointObservation(
        np.arange(float(len(joints))),
        joints,
        seen[:, :3, 3] + noise * rng.normal(size=(len(joints), 3)),
        wxyz_from_matrix(seen[:, :3, :3] @ wobble) if oriented else None,
    )


def random_joints(rng, n, joints=6):
    return rng.uniform(-2.5, 2.5, (n, joints))
