"""The thesis's stereo head on a pan axis: range and eccentricity of a point of the flange."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, shaped
from handeye.calibration.arm.measurement import Equations
from handeye.calibration.arm.measurements.seeing import PointInstrument
from handeye.calibration.arm.measurements.settling import linear, settled
from handeye.calibration.arm.measurements.sight import Sight
from handeye.calibration.arm.measurements.unknowns import Frame, Numbers, Points, Unknown
from handeye.errors import InvalidInput
from handeye.geometry import make_pose, nearest_rotation
from handeye.geometry.angles import wrap
from handeye.sensors.stereo import StereoHead

LABELS = (("eccentricity warp", "rad"), ("range warp", ""), ("range scale", ""))

TOLERANCE = np.array([0.1, 0.1, 0.1])
"""How far the optics may be from those of a head without distortion."""

_LEAST = 6

# A point this near to the pan axis has no direction from it [m].
_NEAREST = 1e-6


@dataclass(frozen=True, eq=False, kw_only=True)
class StereoSightings(PointInstrument):
    """Range [m] and eccentricity [rad] of a point, measured (N, 2), by a head that is turned.

        r' = sigma r + zeta (e + (r - 1)^2),   eps' = eps + e,   e = eta sin^2(eps) (r + 2)/(r + 1)

    (eq 3.39 and 3.40 of the thesis, note E1). The head's cameras see the plane that is square to
    its pan axis, z of its frame P: r = |(x, y)| and eps = atan2(y, x) - pointing of s = P^-1 A Q c.

    pointing  (N,) readings of the pan encoder [rad]; its offset is part of P
    optics    eta, zeta, sigma
    """

    pointing: Array
    optics: Numbers

    def __post_init__(self) -> None:
        super().__post_init__()
        pointing = shaped(self.pointing, (len(self.joints),), f"pointing of {self.what}")
        object.__setattr__(self, "pointing", pointing)

    @property
    def kinds(self) -> tuple[str, ...]:
        """Each errs for itself."""
        return "range", "eccentricity"

    @property
    def others(self) -> tuple[Unknown, ...]:
        """The optics."""
        return (self.optics,)

    def equations(self, flanges: Array, own: tuple[Array, ...]) -> Equations:
        """Measured minus predicted, eccentricities the short way round."""
        parts = super().equations(flanges, own)
        parts.residuals[:, 1] = wrap(parts.residuals[:, 1])
        return parts

    def values(self, s: Array, others: list[Array]) -> tuple[Array, Array, list[Array]]:
        """r' and eps'."""
        eta, zeta, sigma = self.optics.reference + others[0]
        x, y = s[:, 0], s[:, 1]
        r = np.maximum(np.hypot(x, y), _NEAREST)
        eps = wrap(np.arctan2(y, x) - self.pointing)
        head = StereoHead(eccentricity_warp=eta, range_warp=zeta)
        e = head.eccentricity_error(r, eps)
        shape = np.sin(eps) ** 2 * (r + 2.0) / (r + 1.0)
        e_r = -eta * np.sin(eps) ** 2 / (r + 1.0) ** 2
        e_eps = eta * np.sin(2.0 * eps) * (r + 2.0) / (r + 1.0)
        values = np.stack([sigma * r + head.range_error(r, eps), eps + e], axis=-1)
        by_polar = np.empty((len(s), 2, 2))
        by_polar[:, 0, 0] = sigma + zeta * (e_r + 2.0 * (r - 1.0))
        by_polar[:, 0, 1], by_polar[:, 1, 0] = zeta * e_eps, e_r
        by_polar[:, 1, 1] = 1.0 + e_eps
        polar_by_s = np.zeros((len(s), 2, 3))
        polar_by_s[:, 0, 0], polar_by_s[:, 0, 1] = x / r, y / r
        polar_by_s[:, 1, 0], polar_by_s[:, 1, 1] = -y / r**2, x / r**2
        by_optics = np.zeros((len(s), 2, 3))
        by_optics[:, 0, 0], by_optics[:, 1, 0] = zeta * shape, shape
        by_optics[:, 0, 1], by_optics[:, 0, 2] = e + (r - 1.0) ** 2, r
        return values, by_polar @ polar_by_s, [by_optics]

    @classmethod
    def start(
        cls,
        joints: ArrayLike,
        flanges: Array,
        measured: ArrayLike,
        pointing: ArrayLike,
        *,
        head: StereoHead | None = None,
        target: Points | None = None,
        name: str = "",
        std: ArrayLike | None = None,
        sensor: str = "head",
    ) -> Self:
        """From N >= 6 sightings (N, 2) and nominal flanges T_base_flange (N, 4, 4).

        head: its noise, range scale and warps as stated, by default the thesis's; what of the
        optics is unknown is always found. std: of range [m] and eccentricity [rad], instead of the
        head's. target: the point of the flange, by default within 0.1 m of its origin.
        r (cos, sin)(pointing + eps) = R p + t in two of three coordinates is linear in two rows of
        R, which are then made square; then `settled`. Where the head stands along its pan axis no
        sighting tells.

        Raises:
            InvalidInput: for too few rows, or arrays that do not fit together.
        """
        head = head or StereoHead()
        target = target or Points.near("marker")
        seen, pan = shaped(measured, (None, 2), "measured"), shaped(pointing, (None,), "pointing")
        if not len(seen) == len(pan) == len(flanges) >= _LEAST:
            raise InvalidInput(
                f"{sensor} needs at least {_LEAST} sightings to be placed, one for each pose of "
                f"the flange, got {len(seen)} with {len(pan)} pointings for {len(flanges)} poses"
            )
        scale = float(np.asarray(head.range_scale))
        p = flanges[:, :3, :3] @ target.reference[0] + flanges[:, :3, 3]
        theta, r = pan + seen[:, 1], seen[:, 0] / scale
        plane = r[:, np.newaxis] * np.stack([np.cos(theta), np.sin(theta)], axis=-1)
        middle, centre = p.mean(axis=0), plane.mean(axis=0)
        across, upright = (linear(p - middle, one) for one in (plane - centre).T)
        R = nearest_rotation(np.stack([across, upright, np.cross(across, upright)], axis=1))
        at = middle - R @ np.append(centre, 0.0)
        if std is None:
            std = np.stack([head.range_std(*seen.T), head.eccentricity_std(seen[:, 1])], axis=-1)
        optics = np.array([head.eccentricity_warp, head.range_warp, scale])
        rough = cls(
            joints=np.asarray(joints), measured=seen, pointing=pan, name=name,
            std=np.asarray(std),
            sight=Sight(
                "eye_to_hand", Frame.near(sensor, make_pose(R, at)), Frame.known(), target,
                np.zeros(len(seen), np.int64),
            ),
            optics=Numbers(f"{sensor} optics", TOLERANCE, optics, LABELS),
        )  # fmt: skip
        return settled(rough, flanges)[0]
