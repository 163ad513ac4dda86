"""What a camera can see of a marker."""

from dataclasses import dataclass

import numpy as np

from handeye.arrays import Array, Booleans, scalar
from handeye.calibration.placed_arm import PlacedArm
from handeye.errors import InvalidInput
from handeye.randomness import stream

# Poses of the working range that say which side of the marker is its front.
_LOOKED = 2000


@dataclass(frozen=True)
class View:
    """Where a sensor sees a marker. The sensor looks along the z axis of its frame.

    half_angle  from that axis to the edge of what it sees [rad]
    near, far   distances at which it sees the marker [m]
    facing      how far the marker may be turned away from the line of sight: the angle of the z
                axis of its frame, to whichever side was seen where the robot worked [rad]

    Raises InvalidInput for angles beyond half a turn, or distances that leave nothing.
    """

    half_angle: float = np.pi
    near: float = 0.0
    far: float = np.inf
    facing: float = np.pi

    def __post_init__(self) -> None:
        for name in ("half_angle", "facing"):
            angle = scalar(getattr(self, name), f"view: {name}", above=0.0)
            if angle > np.pi:
                raise InvalidInput(f"view: {name} must be at most half a turn, got {angle:.4g} rad")
        scalar(self.near, "view: near", least=0.0)
        if not self.far > self.near:
            raise InvalidInput(f"view: far must exceed near, got {self.far} and {self.near} m")

    def sees(self, model: PlacedArm, joints: Array) -> Booleans:
        """At which joints (N, n) the marker is in view, (N,), by the nominal arm as it is placed.

        Raises:
            InvalidInput: `facing` is asked for, but which way the marker faces was never measured.
        """
        base, marker = model.placement.T_sensor_base, model.placement.T_flange_marker
        poses = base @ model.arm.poses(joints) @ marker
        seen = self.within(poses[:, :3, 3])
        if self.facing < np.pi:
            seen &= turned_away(poses, self._front(model)) <= self.facing
        return seen

    def within(self, places: Array) -> Booleans:
        """Which places (..., 3) in the sensor's frame are near enough, and not too far aside."""
        distance = np.linalg.norm(places, axis=-1)
        seen = (distance >= self.near) & (distance <= self.far)
        if self.half_angle < np.pi:
            seen &= places[..., 2] >= np.cos(self.half_angle) * distance
        return seen

    def _front(self, model: PlacedArm) -> float:
        """Which side of the marker is its front: 1, or -1."""
        if model.turn_std is None:
            raise InvalidInput(
                "which way the marker faces is not known, for no orientations were measured: leave "
                "out facing, or calibrate from a log with orientations"
            )
        low, high = np.maximum(model.low, model.arm.lower), np.minimum(model.high, model.arm.upper)
        joints = stream("view: front", len(low)).uniform(low, high, (_LOOKED, len(low)))
        base, marker = model.placement.T_sensor_base, model.placement.T_flange_marker
        away = turned_away(base @ model.arm.poses(joints) @ marker, 1.0)
        return 1.0 if np.median(away) <= 0.5 * np.pi else -1.0


def turned_away(poses: Array, front: float) -> Array:
    """Angles (N,) between the z axis of poses (N, 4, 4) in a sensor's frame and the way to it."""
    distance = np.linalg.norm(poses[:, :3, 3], axis=1)
    along = -front * np.sum(poses[:, :3, 2] * poses[:, :3, 3], axis=1)
    return np.arccos(np.clip(along / np.maximum(distance, 1e-12), -1.0, 1.0))
