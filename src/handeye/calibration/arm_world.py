"""A simulated arm that is not quite as its URDF file says, seen by a tracker or camera."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from scipy.spatial.transform import Rotation

from handeye.arrays import Array, scalar
from handeye.calibration.placement import Placement
from handeye.geometry import make_pose
from handeye.io.urdf_origins import corrected_urdf
from handeye.observations import PointObservation
from handeye.randomness import stream
from handeye.robots.urdf import UrdfArm

# Errors of an ordinary industrial arm, as standard deviations.
_SHIFT, _TURN, _ZERO, _WAVE = 0.4e-3, 0.6e-3, 3e-3, 3e-4
# How far joints without limits swing [rad], and how much of their way those with limits.
_SWING, _SHARE = 1.5, 0.45


@dataclass(frozen=True, eq=False)
class ArmWorld:
    """An arm that nobody tells the calibrator.

    nominal    as the URDF file has it
    actual     with joints that stand a little elsewhere
    waves      (n, 2) a periodic error of each encoder, once a turn: sine and cosine [rad]
    placement  of sensor and marker
    noise      standard deviation of each component of a measured position [m]
    """

    nominal: UrdfArm
    actual: UrdfArm
    waves: Array
    placement: Placement
    noise: float = 1e-4

    @classmethod
    def of(cls, arm: UrdfArm, *, noise: float = 1e-4, replicate: int = 0) -> Self:
        """An arm with random errors of ordinary size: 0.4 mm, 0.03 degrees, zeros 0.2 degrees."""
        n, rng = len(arm.stage_names), stream("arm world", replicate)
        turns = rng.normal(size=(n, 3)) * _TURN
        turns += rng.normal(size=(n, 1)) * _ZERO * arm.stages().axes
        D = make_pose(Rotation.from_rotvec(turns).as_matrix(), rng.normal(size=(n, 3)) * _SHIFT)
        urdf = corrected_urdf(arm.urdf, arm.stage_names, D)
        actual = UrdfArm.from_text(urdf, arm.tip, arm.name, arm.eye)
        far = 1.5 * arm.reach
        base = make_pose(Rotation.random(rng=rng).as_matrix(), [0.2 * far, -0.1 * far, far])
        marker = make_pose(Rotation.random(rng=rng).as_matrix(), [0.03, 0.02, 0.08])
        waves = rng.normal(size=(len(arm.joint_names), 2)) * _WAVE
        return cls(arm, actual, waves, Placement(base, marker), scalar(noise, "noise", least=0.0))

    def positions(self, joints: Array) -> Array:
        """Where the marker really is, in the sensor's frame (N, 3) [m], at readings (N, n)."""
        waves = self.waves[:, 0] * np.sin(joints) + self.waves[:, 1] * np.cos(joints)
        return self.placement.predict(self.actual, joints + waves)

    def observe(self, times: Array, joints: Array, rng: np.random.Generator) -> PointObservation:
        """What the sensor sees of the marker at readings (N, n)."""
        places = self.positions(joints)
        return PointObservation(times, joints, places + self.noise * rng.normal(size=places.shape))

    def motion(self, times: Array) -> Array:
        """Joints (N, n) of an arm that swings through its working range, at times (N,) [s].

        Every joint in its own rhythm, so that the postures do not repeat.
        """
        arm = self.nominal
        limited = np.isfinite(arm.lower) & np.isfinite(arm.upper)
        low, high = np.where(limited, arm.lower, 0.0), np.where(limited, arm.upper, 0.0)
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        swing = np.where(limited, np.minimum(_SHARE * half, _SWING), _SWING)
        rates = 0.11 * np.sqrt(np.array([2, 3, 5, 7, 11, 13, 17, 19, 23, 29], dtype=np.float64))
        beats = np.outer(times, np.resize(rates, len(middle)))
        return middle + swing * np.sin(beats + np.arange(len(middle)))
