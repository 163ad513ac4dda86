"""Whole poses of a target: a tag, a board that a camera has located, a 6-D probe."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, finite, shaped
from handeye.calibration.arm.measurement import Equations
from handeye.calibration.arm.measurements.seeing import Instrument
from handeye.calibration.arm.measurements.sight import Sight, carriers
from handeye.calibration.arm.measurements.unknowns import Frame, Points, free_of, wholes_of
from handeye.calibration.hand_eye.samples import Setup
from handeye.calibration.hand_eye.solution import solve
from handeye.calibration.hand_eye.turns import inverse_right_jacobian, turned_by
from handeye.geometry import invert, wxyz_from_matrix


@dataclass(frozen=True, eq=False, kw_only=True)
class PoseSightings(Instrument):
    """The target's pose in the sensor's frame, S = P^-1 G Q (`sight`).

    Values are its position [m] and, as the rotation vector from the predicted to the measured
    orientation, its turn [rad], both in the sensor's axes.

    measured  S (N, 4, 4)

    Raises InvalidInput also for matrices that are no poses.
    """

    measured: Array

    def __post_init__(self) -> None:
        super().__post_init__()
        S = shaped(self.measured, (len(self.joints), 4, 4), f"measured of {self.what}")
        wxyz_from_matrix(S[:, :3, :3])
        object.__setattr__(self, "measured", S)

    @property
    def kinds(self) -> tuple[str, ...]:
        """Position, then orientation."""
        return ("position",) * 3 + ("orientation",) * 3

    def poses(self, flanges: Array, own: tuple[Array, ...]) -> Array:
        """Predicted T_sensor_target (N, 4, 4) at T_base_flange (N, 4, 4) and the blocks' values."""
        sensor, target, _ = wholes_of(self.unknowns, own)
        sight = self.sight
        G = carriers(sight.setup, flanges)
        return invert(sight.sensor.pose(sensor)) @ G @ sight.target.pose(target)

    def equations(self, flanges: Array, own: tuple[Array, ...]) -> Equations:
        """Measured minus predicted at T_base_flange (N, 4, 4) and values of the blocks."""
        sensor, target, origin = wholes_of(self.unknowns, own)
        seen = self.sight.look(flanges, sensor, target, origin)
        turned = self.poses(flanges, own)[:, :3, :3]
        r = np.empty((len(flanges), 6))
        r[:, :3] = self.measured[:, :3, 3] - seen.s
        r[:, 3:] = turned_by(self.measured[:, :3, :3] @ turned.swapaxes(1, 2))
        K = inverse_right_jacobian(r[:, 3:])
        shifts = (seen.by_flange, seen.by_sensor, seen.by_target)
        by_flange, *by_own = (
            -np.concatenate([shift, K @ turn], axis=1)
            for shift, turn in zip(shifts, self.sight.turns(flanges, sensor, target), strict=True)
        )
        nothing = np.zeros((len(r), 6, len(origin)))
        return Equations(r, by_flange, free_of(self.unknowns, [*by_own, nothing]))

    @classmethod
    def start(
        cls,
        joints: ArrayLike,
        flanges: Array,
        measured: ArrayLike,
        *,
        setup: Setup = "eye_in_hand",
        name: str = "",
        std: ArrayLike = 0.0,
        sensor: str = "camera",
        target: str = "target",
    ) -> Self:
        """From N >= 3 poses T_sensor_target (N, 4, 4); nominal flanges T_base_flange (N, 4, 4).

        Both frames are those of `calibration.hand_eye.solve`.

        Raises:
            InvalidInput: for arrays that are no poses, do not pair up, or are fewer than three.
        """
        S = finite(measured, "measured")
        fit = solve(flanges, S, setup=setup)
        on_flange, on_base = (sensor, target) if setup == "eye_in_hand" else (target, sensor)
        frames = {on_flange: fit.X, on_base: fit.Z}
        sight = Sight(
            setup, Frame.near(sensor, frames[sensor]), Frame.near(target, frames[target]),
            Points.known(), np.zeros(len(S), np.int64),
        )  # fmt: skip
        return cls(
            joints=np.asarray(joints), measured=S, std=np.asarray(std), name=name, sight=sight
        )
